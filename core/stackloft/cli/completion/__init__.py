"""Shell completion: what may come next on a half-written command line, told without importing a plug-in."""
