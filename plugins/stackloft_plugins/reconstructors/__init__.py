"""Built-in reconstructors."""
