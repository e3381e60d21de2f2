"""From segmented slices to nested sub-pixel loops, equal-point curves, seams and links."""
