"""``stackloft plugins doctor``: what works here, what does not, and what to install."""
