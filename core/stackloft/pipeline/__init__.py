"""Orchestration: recipe, run, study."""
