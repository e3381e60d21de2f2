"""Phantoms with exact answers and the conformance checks that plug-in authors run."""
