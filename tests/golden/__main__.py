"""Golden runs: what every command leaves in its smallest form, kept and compared.

    python -m tests.golden record RUN.json [BEGINNING …]     run the orders that begin so, all without; some minutes
    python -m tests.golden compare BEFORE.json NOW.json [RENAMED.json]     exit code 1 where they differ

RENAMED.json: {"beginning of a place before": "beginning now"}. Many orders need what others leave: name those too.
"""

from __future__ import annotations

import json
import sys
import tempfile
import time
from pathlib import Path

from tests.golden.orders import ORDERS
from tests.golden.record import differences, document_of, recorded, records_of, write_inputs


def record(target: Path, beginnings: list[str]) -> int:
    """Run the orders, and write what they leave to `target`."""
    found = {}
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        write_inputs(folder)
        for order in ORDERS:
            if not beginnings or any(order.words.startswith(each) for each in beginnings):
                started = time.monotonic()
                found[order.line] = recorded(order, folder)
                print(f"{found[order.line].code} {time.monotonic() - started:6.1f} s  {order.line}", flush=True)
                target.write_bytes(document_of(found))  # what a run that ends early has found is there
    return 0


def compare(before: Path, now: Path, renamed: Path | None) -> int:
    """Print what differs."""
    names = {} if renamed is None else json.loads(renamed.read_bytes())
    found = list(differences(records_of(before.read_bytes()), records_of(now.read_bytes()), names))
    print(*found, f"{len(found)} differences", sep="\n")
    return 1 if found else 0


def main(words: list[str]) -> int:
    """By the first word."""
    match words:
        case ["record", target, *beginnings]:
            return record(Path(target), beginnings)
        case ["compare", before, now, *renamed] if len(renamed) < 2:
            return compare(Path(before), Path(now), Path(renamed[0]) if renamed else None)
    print(__doc__, file=sys.stderr)
    return 2


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
