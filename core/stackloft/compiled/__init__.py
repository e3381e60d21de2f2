"""Kernels in C where NumPy is slow: a scan's small slices. Optional; NumPy is reference and fallback."""
