"""Meshers: closed solids filled with tetrahedra."""
