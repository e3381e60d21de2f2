"""Finds plug-ins by entry point, builds them from options, quarantines broken ones."""
