"""Conformance checks that plug-in authors run on their own plug-ins."""
