"""Questions about figures rather than figures: regression, convergence, accuracy.

Above `pipeline` and `testing`, which do not know each other: a study runs methods on many sources, phantoms
among them, and says how good the figures are. What it finds is drawn by `report` and shown by `cli`.
"""
