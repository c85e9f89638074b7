"""Every command with every kind of file: `python -m tests.attack.matrix FOLDER`; golden commands are run there once.

Wrong kinds are refused in one sentence, and no command takes for right what is none: a run that ends well is listed.
"""

from __future__ import annotations

import argparse
import os
import random
import sys
import tempfile
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Final

from tests.attack.forks import Ended, Limits, forked, prepared
from tests.attack.processes import LONGEST
from tests.golden.record import SURROUNDINGS

FILE: Final = "{}"
CONFIG: Final = "--config park.toml"
COMMANDS: Final = (
    *("tune {}", "sensors {}", "sensitivity {}", "hardware {}", "sweep run {}", "sweep status {}", "sweep failed {}"),
    *("aim {}", "computer {}", "hump make {}", "hump check {}", "hump routes {}", "hump draw {}", "hump speed {}"),
    *("hump export {} --format railml", "hump simulate {}", "hump capacity {}", "hump design {}"),
    *("hump compare {} humped-short", "hump compare humped {}", "hump simulate trial.toml --list {}"),
    *(f"inspect {FILE}", f"inspect {FILE} {CONFIG}", f"verify {FILE} --passes 50", f"validate {FILE} {CONFIG}"),
    *(f"loop {FILE} {CONFIG}", f"explore {FILE} {CONFIG}", f"sensitivity measured.toml --table {FILE} --points 50"),
    *(f"export {FILE} --format {form}" for form in ("c", "csv", "st", "fmu")),
    *(f"{word} {FILE} {CONFIG}" for word in ("identify", "watch", "retune", "replay --table park/book.h5")),
    *(f"{word} validated/log.h5 --config {FILE}" for word in ("identify", "watch")),
    *(f"watch validated/log.h5 {CONFIG} {option} {FILE}" for option in ("--mapping", "--reference")),
    *(f"replay validated/log.h5 {CONFIG} --table {FILE}", f"retune validated/log.h5 {CONFIG} --table {FILE}"),
    *("validate park/book.h5 --config {}", "inspect park/book.h5 --config {}", "explore park/book.h5 --config {}"),
    *("init --for {}", "init point-sensors {}", "init configuration {}", "init hump {}"),
)
"""As they are typed; `-o` follows where they take one. The file takes the place of `FILE`."""

WITHOUT_OUTPUT: Final = ("sweep status", "sweep failed", "hump check", "hump routes")

GOLDEN: Final = (
    *("park.toml", "sensors.toml", "sweep.toml", "aim.toml", "short.toml", "trial.toml", "computer.toml"),
    *("park", "park/book.h5", "park/summary.json", "park/report.html", "validated/log.h5", "validated", "swept"),
    *("swept/sweep/ledger.jsonl", "passages", "passages/book.h5", "aimed", "made", "humped", "humped/trains.npz"),
    *("humped/inputs/hump.toml", "hump-railml/hump.railml", "hump-railml", "compared", "capacity", "export-c"),
    *("export-fmu", "export-split", "computed", "identified", "identified/config.toml", "drawn"),
)
"""Of what the golden commands read and leave; what is not there is passed over."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Print every fault, and each run that ended well; 1 if there is a fault."""
    asked = parser().parse_args(arguments)
    os.environ |= SURROUNDINGS
    prepared(asked.inputs)
    counts: Counter[str] = Counter()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for each in asked.inputs.iterdir():
            (folder / each.name).symlink_to(each.resolve())
        files = [*nonsense(folder), *golden(folder)]
        chosen = random.Random(asked.seed).sample(
            pairs := [(words, file) for words in COMMANDS for file in files], min(asked.number, len(pairs))
        )
        for number, (words, file) in enumerate(chosen):
            typed = [word if word != FILE else file for word in words.split(" ")]
            typed += [] if words.startswith(WITHOUT_OUTPUT) else ["-o", f"out-{number}"]
            ended = forked(typed, folder, limits=Limits(memory_bytes=4 * 2**30))
            counts[outcome(ended)] += 1
            faults = [*faults_of(ended)]
            counts["faults"] += len(faults)
            if faults or ended.code in (0, 1):
                print(f"{ended.code} {words} <- {file[:80]!r} {'; '.join(faults)[:600]}", flush=True)
    print(dict(counts))
    return 1 if counts["faults"] else 0


def parser() -> argparse.ArgumentParser:
    """What may be asked for."""
    asked = argparse.ArgumentParser(prog="python -m tests.attack.matrix", description=__doc__)
    asked.add_argument("inputs", type=Path, help="a folder that keeps what the golden commands leave")
    asked.add_argument("--number", type=int, default=10_000, help="of pairs, drawn at random; all unless given")
    asked.add_argument("--seed", type=int, default=0)
    return asked


def golden(folder: Path) -> Iterator[str]:
    """The files and folders of the golden commands that are there."""
    yield from (name for name in GOLDEN if (folder / name).exists())


def nonsense(folder: Path) -> Iterator[str]:
    """Files and names that are no input of any command; they are made."""
    utf16 = 'title = "é"\n'.encode("utf-16")
    contents: Mapping[str, bytes] = {
        **{f"empty{ending}": b"" for ending in ("", ".toml", ".h5", ".json", ".csv")},
        **{"utf16.toml": utf16, "utf16.csv": utf16, "zero.toml": bytes(5000), "random.h5": b"\x89HDF\r\n"},
        **{"random": random.Random(1).randbytes(3000), "zip.npz": b"PK\x05\x06" + bytes(18), "x.railml": b"<a/>"},
        **{"Стрелка 1.toml": b"[grid]\npath_step_m = 1.0\n", "a\nb.toml": b"x = 1\n", "one.csv": b"a,b\n1,2\n"},
        **{"list.json": b"[]", "a.json": b"{}", "deep.json": b"[" * 100_000, "deep.toml": b"a = " + b"[" * 100_000},
        "no-table.toml": b"[sweep]\n[position]\n",
    }
    for name, content in contents.items():
        (folder / name).write_bytes(content)
        yield name
    for name in ("huge.toml", "huge.h5", "huge.json", "huge.csv"):
        with (folder / name).open("wb") as file:
            file.truncate(3 * 2**30)
        yield name
    (folder / "loop.toml").symlink_to("loop.toml")
    (folder / "dangling.toml").symlink_to("nowhere.toml")
    (folder / "nothing").mkdir()
    (folder / "around").mkdir()
    (folder / "around" / "back").symlink_to("..")
    os.mkfifo(folder / "pipe.toml")
    yield from ("loop.toml", "dangling.toml", "nothing", "around/back", "pipe.toml", "/dev/null", "/dev/zero", "/", ".")
    yield from (
        "",
        " ",
        "-",
        "--",
        "missing.toml",
        "park.toml/x",
        "x" * 300,
        "x/" * 3000,
        "a\u202eb",
        "\udcff",
        "~",
        "a\x01b",
    )


def outcome(ended: Ended) -> str:
    """A word for the count."""
    return {0: "ran", 1: "ran, 1", 2: "refused", 3: "damaged"}.get(ended.code, f"exit {ended.code}")


def faults_of(ended: Ended) -> Iterator[str]:
    """What is wrong with how it ended."""
    if ended.code not in (0, 1, 2, 3):
        yield f"it ended with {ended.code} after {ended.seconds:.0f} s: {ended.err[-LONGEST:]}"
    if "Traceback" in ended.err or "Warning:" in ended.err:
        yield ended.err[-3 * LONGEST :]
    if ended.code in (2, 3):
        lines = ended.err.splitlines()
        if not lines or not lines[-1].startswith("retarder-synth: "):
            yield f"refused without a sentence: {ended.err[-LONGEST:]!r}"
        for line in lines:
            if not line.isprintable() or len(line) > LONGEST:
                yield f"{len(line)} letters: {line[:LONGEST]!r}"


if __name__ == "__main__":
    sys.exit(main())
