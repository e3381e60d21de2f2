"""Values that flow through stackloft: frozen, in millimetres, over read-only arrays."""
