"""What every test may use."""

import datetime as dt
import os
from importlib.metadata import version
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]


@pytest.fixture
def proof():
    """Write a table of measured figures to docs/proof/ when ``make prove`` asks for it."""

    def write(name, claim, header, rows):
        if not os.environ.get("STACKLOFT_PROOF"):
            return
        stamp = dt.datetime.now(tz=dt.UTC).strftime("%Y-%m-%d")
        used = ", ".join(f"{package} {version(package)}" for package in ("stackloft", "numpy", "scipy"))
        lines = [f"# {claim}", "", f"{stamp}; {used}; printed by `make prove`.", ""]
        lines += ["| " + " | ".join(header) + " |", "|" + "---|" * len(header)]
        lines += ["| " + " | ".join(map(str, row)) + " |" for row in rows]
        folder = ROOT / "docs" / "proof"
        folder.mkdir(parents=True, exist_ok=True)
        (folder / f"{name}.md").write_text("\n".join(lines) + "\n", encoding="utf-8")

    return write
