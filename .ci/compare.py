"""Compare a measurement with the exact answer of the phantom it was made from; leave with 1 when it differs.

Usage: compare.py PHANTOM_FOLDER MEASUREMENT.json
"""

import json
import sys
from pathlib import Path

TOLERANCES = {"volume": 0.0015, "area": 0.0025}
"""What noise-free photographs at 0.3 mm must meet."""

answer = json.loads((Path(sys.argv[1]) / "answer.json").read_text(encoding="utf-8"))
measured = json.loads(Path(sys.argv[2]).read_text(encoding="utf-8"))["objects"][0]
failed = False
for quantity, tolerance in TOLERANCES.items():
    exact, value = answer[quantity]["value"], measured[quantity]["value"]
    error = value / exact - 1
    failed |= not abs(error) <= tolerance
    verdict = "ok" if abs(error) <= tolerance else "TOO FAR"
    print(f"{quantity}: {value:.6g}, exact {exact:.6g}, error {error:+.4%}, allowed {tolerance:.2%}: {verdict}")
sys.exit(failed)
