"""The built-in plug-ins, one algorithm per file."""
