"""``python -m stackloft.cli``."""

from stackloft.cli import main

main()
