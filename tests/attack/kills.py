"""Kill every command at random moments: `python -m tests.attack.kills FOLDER --kills 20`.

What is killed leaves each of its files whole or not at all; the same command then makes the same bytes as one that
nobody disturbed. The inputs are what the golden commands leave in a folder, where they are run once.
"""

from __future__ import annotations

import argparse
import os
import random
import shutil
import signal
import sys
import tempfile
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from synth.frame.own_files import LOCK, MARKER
from synth.frame.results_directory import LEFTOVER, SUMMARY
from tests.attack.forks import Ended, Limits, Stroke, contents, forked, prepared, warmed
from tests.golden.orders import ORDERS, Order
from tests.golden.record import SURROUNDINGS

STORED: Final = ("batches/", "sweep/")
"""Folders of files that grow, or that a command goes on from."""

SIGNALS: Final = {"kill": signal.SIGKILL, "interrupt": signal.SIGINT, "terminate": signal.SIGTERM}
FULL: Final = "full"
"""In place of a signal: no file may become longer than some bytes, as on a disk that is full."""

ENDS: Final = {"kill": (0, 1, -9), "interrupt": (0, 1, 130), "terminate": (0, 1, 130, -15), FULL: (0, 1, 74)}
"""Exit codes with which a command may end, by how it was disturbed."""


@dataclass(frozen=True)
class Series:
    """The kills of one command: what is wrong, how many landed before its end."""

    order: Order
    faults: tuple[str, ...]
    landed: int


def main(arguments: Sequence[str] | None = None) -> int:
    """Print a line for each command; 1 if there is a fault."""
    asked = parser().parse_args(arguments)
    os.environ |= SURROUNDINGS
    prepared(asked.inputs)
    chosen = [
        each for each in ORDERS if each.output and any(each.words.startswith(word) for word in asked.only or ("",))
    ]
    counts: Counter[str] = Counter()
    for order in chosen:
        found = series(order, asked)
        counts.update(kills=found.landed, faults=len(found.faults), commands=1)
        print(f"{found.landed:4} landed, {len(found.faults)} faults: {order.line}", flush=True)
        for fault in found.faults:
            print(f"       {fault}", flush=True)
    print(dict(counts))
    return 1 if counts["faults"] else 0


def parser() -> argparse.ArgumentParser:
    """What may be asked for."""
    asked = argparse.ArgumentParser(prog="python -m tests.attack.kills", description=__doc__)
    asked.add_argument("inputs", type=Path, help="a folder that keeps what the golden commands leave")
    asked.add_argument("--only", action="append", default=None, help="commands that begin so; may be given repeatedly")
    asked.add_argument("--kills", type=int, default=20, help="of each command")
    asked.add_argument("--by", choices=tuple(ENDS), default="kill", help="how each is disturbed")
    asked.add_argument("--seed", type=int, default=0)
    return asked


def series(order: Order, asked: argparse.Namespace) -> Series:
    """Kill `order` again and again, each time in what the last one left; then let it end."""
    folder = Path(tempfile.mkdtemp())  # no TemporaryDirectory: a fork that ends in order would remove that, too
    try:
        for each in asked.inputs.iterdir():
            (folder / each.name).symlink_to(each.resolve())
        return series_in(folder, order, asked)
    finally:
        shutil.rmtree(folder)


def series_in(folder: Path, order: Order, asked: argparse.Namespace) -> Series:
    """The same in a folder that holds the inputs."""
    dice, words, output = random.Random(f"{order.line} {asked.seed}"), order.line.split(), folder / order.output
    shutil.rmtree(output, ignore_errors=True)
    output.unlink(missing_ok=True)
    code = warmed(words, folder)
    whole = contents(output)
    shutil.rmtree(output)
    first = forked(words, folder)
    faults, landed = [f"undisturbed: {fault}" for fault in unlike(output, whole, first, code)], 0
    shutil.rmtree(output)
    for _ in range(asked.kills):
        if dice.random() < 0.2:
            shutil.rmtree(output, ignore_errors=True)
        if asked.by == FULL:
            ended = forked(words, folder, limits=Limits(file_bytes=int(10.0 ** dice.uniform(1.0, 5.5))))
        else:
            after_s = dice.uniform(0.0, 1.05) * first.seconds
            ended = forked(words, folder, Stroke(after_s, SIGNALS[asked.by]))
        landed += ended.code not in (0, 1)
        faults += judged(output, ended, whole, asked.by)
    last = forked(words, folder)
    faults += [f"at the end: {fault}" for fault in unlike(output, whole, last, code)]
    return Series(order, tuple(faults), landed)


def judged(output: Path, ended: Ended, whole: Mapping[str, bytes], by: str) -> Iterator[str]:
    """What is wrong after a kill."""
    if ended.code not in ENDS[by]:
        yield f"it ended with {ended.code}: {ended.err[-300:]}"
    is_whole = ended.err.endswith("\n")  # it is a file, too, which the disk may have been too full for
    if ended.code == 74 and is_whole and ": " not in ended.err.splitlines()[-1].removeprefix("retarder-synth: "):
        yield f"no file is named: {ended.err[-300:]!r}"
    if ended.code == 130 and "interrupted" not in (ended.err.splitlines() or [""])[-1]:
        yield f"its last line is {ended.err[-300:]!r}"
    if "Traceback" in ended.err:
        yield ended.err[-600:]
    left = contents(output) if output.exists() else {}
    for name, content in left.items():
        base = name.rpartition("/")[2]
        if base in (MARKER, LOCK) or LEFTOVER.fullmatch(base) or name.startswith(STORED):
            continue
        if name not in whole:
            yield f"{name} is no file of this command"
        elif content != whole[name]:
            yield f"{name} is not whole: {len(content)} bytes of {len(whole[name])}"
    if SUMMARY in left and (missing := whole.keys() - left.keys() - {LOCK}):
        yield f"there is a summary, but {', '.join(sorted(missing))} are missing"


def unlike(output: Path, whole: Mapping[str, bytes], last: Ended, code: int) -> Iterator[str]:
    """How what is there in the end differs from what nobody disturbed."""
    if last.code != code:
        yield f"it ended with {last.code}, not {code}: {last.err[-300:]}"
    left = contents(output)
    for name in sorted((left.keys() ^ whole.keys()) - {MARKER}):
        yield f"{name} is {'left over' if name in left else 'missing'}"
    for name in sorted(left.keys() & whole.keys() - {MARKER}):
        if left[name] != whole[name] and not name.endswith("ledger.jsonl"):
            yield f"{name} has other bytes"


if __name__ == "__main__":
    sys.exit(main())
