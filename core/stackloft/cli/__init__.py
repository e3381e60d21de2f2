"""The `stackloft` command."""
