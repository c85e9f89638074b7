"""Attack the readers of all kinds of input: `python -m tests.attack --mutants 2000 --workers 2`."""

from __future__ import annotations

import argparse
import sys
from collections import Counter
from collections.abc import Iterable, Sequence
from pathlib import Path

from tests.attack.kinds import KINDS
from tests.attack.processes import Attempt, Kind, Outcome, attempts


def main(arguments: Sequence[str] | None = None) -> int:
    """Print a table of kinds and outcomes, store every fault; 1 if there is one."""
    asked = parser().parse_args(arguments)
    print(row("kind", [*Outcome, "slowest s"]))
    faults = 0
    for name in asked.kind or KINDS:
        kind = KINDS[name]()
        number = max(asked.mutants, len(kind.first))
        found = list(attempts(kind, range(number), asked.seed, asked.workers))
        counts = Counter(each.outcome for each in found)
        slowest_s = max(each.seconds for each in found)
        print(row(name, [*(counts[each] for each in Outcome), f"{slowest_s:.2f}"]), flush=True)
        faults += store(kind, asked.seed, found, asked.output / name)
    print(f"{faults} faults" + (f"; each is in {asked.output}" if faults else ""))
    return 1 if faults else 0


def parser() -> argparse.ArgumentParser:
    """What may be asked for."""
    asked = argparse.ArgumentParser(prog="python -m tests.attack", description=__doc__)
    asked.add_argument("--mutants", type=int, default=2000, help="of each kind; at least those that are listed")
    asked.add_argument("--kind", action="append", choices=tuple(KINDS), help="only this one; may be given repeatedly")
    asked.add_argument("--seed", type=int, default=0)
    asked.add_argument("--workers", type=int, default=2)
    asked.add_argument("-o", "--output", type=Path, default=Path("out/attack"), help="where faults are stored")
    return asked


def row(name: str, cells: Iterable[object]) -> str:
    """A line of the table."""
    return f"{name:<17}" + "".join(f"{cell!s:>11}" for cell in cells)


def store(kind: Kind, seed: int, found: Iterable[Attempt], output: Path) -> int:
    """Write each file that shows a fault into a folder of its own, with what it shows; how many."""
    faults = [each for each in found if each.outcome not in (Outcome.REFUSED, Outcome.ACCEPTED)]
    for each in faults:
        folder = output / f"{each.outcome.replace(' ', '-')}-{seed}-{each.number}"
        kind.put_into(folder, kind.changed(seed, each.number).content)
        (folder / "fault.txt").write_text(f"{each.outcome}: {each.detail}\n", encoding="utf-8")
    return len(faults)


if __name__ == "__main__":
    sys.exit(main())
