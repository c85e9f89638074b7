"""How long whole commands take, as processes: with an empty kernel cache, with a full one, and without numba's inside.

Every command runs once a round, in turns, so that a slow moment of the machine meets them all; with the program of
another checkout, that one runs beside it in the same round.
"""

from __future__ import annotations

import os
import subprocess
import sys
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory, TemporaryFile

from scripts.studies.study import ABSENT, Findings, MarkdownTable, Method, Tell, option, table
from scripts.studies.timing import Machine, this_machine, three_digits
from synth.kernels.plain import VARIABLE

PROGRAM = (sys.executable, "-c", "import sys; from synth.cli import main; sys.exit(main(sys.argv[1:]))")

KIB = 1024
"""Linux tells memory in these."""

FILES: Mapping[str, str] = {
    "any-time.toml": '[regulator]\ncommands = "any_time"\n',
    "small.toml": '[[cut]]\ncar = "gondola-4"\nmass_t = 22.0\n[targets]\nexit_speeds_m_s = [2.0]\n[grid]\n'
    "path_step_m = 1.0\nspeed_step_m_s = 0.06\n[validation]\npasses = 1000\n[output]\nplots = false\nreport = false\n",
}
"""What the commands read beside the defaults."""


@dataclass(frozen=True)
class Order:
    """A command, timed under `name`: its words, and whether the cache is empty or numba's inside is left alone."""

    name: str
    words: tuple[str, ...]
    cold: bool = False
    plain: bool = False


ORDERS = (
    Order("tune, first run", ("tune",), cold=True),
    Order("tune", ("tune",)),
    Order("tune, plain kernels", ("tune",), plain=True),
    Order("aim", ("aim",)),
    Order("hump simulate large, 1000 trains", ("hump", "simulate", "large", "--trains", "1000")),
    Order("sensors", ("sensors",)),
    Order("hardware", ("hardware",)),
    Order("tune, commands at any time", ("tune", "any-time.toml")),
    Order("computer", ("computer",)),
    Order("tune, one coarse case", ("tune", "small.toml")),
)


@dataclass(frozen=True)
class Options:
    """What is timed."""

    rounds: int = option(3, "turns", (1, 100))
    commands: tuple[str, ...] = option((), "only these of the rows, by name")
    before: Path | None = option(None, "Python of another checkout, timed beside this one")


@dataclass(frozen=True)
class Taken:
    """What one run took: seconds of the clock, seconds of the processors with those of its children, and the most
    memory that one of its processes held, bytes."""

    wall_s: float
    processor_s: float
    memory_bytes: int


@dataclass(frozen=True)
class Row:
    """All rounds of one command; `before`: those of the other checkout."""

    name: str
    now: tuple[Taken, ...]
    before: tuple[Taken, ...]


@dataclass(frozen=True)
class CommandTimes(Findings):
    """A row a command."""

    machine: Machine
    rows: tuple[Row, ...]

    def tables(self) -> Mapping[str, MarkdownTable]:
        """`times`: medians with extremes; the ratio to before is taken round by round."""
        heads = ("command", "clock, s", "processors, s", "memory, MB", "before: clock, s", "clock / before")
        rows = [
            (
                each.name,
                spread([taken.wall_s for taken in each.now]),
                spread([taken.processor_s for taken in each.now]),
                f"{max(taken.memory_bytes for taken in each.now) / 1e6:.0f}",
                spread([taken.wall_s for taken in each.before]),
                spread([now.wall_s / before.wall_s for now, before in zip(each.now, each.before, strict=False)]),
            )
            for each in self.rows
        ]
        return {"times": table("Whole commands, as processes", heads, rows)}

    def sentences(self) -> tuple[str, ...]:
        """The machine."""
        return (self.machine.sentence,)


def spread(seconds: Sequence[float]) -> str:
    """'8.2 (8.1 to 8.3, n = 3)'."""
    if not seconds:
        return ABSENT
    low, middle, high = (three_digits(each) for each in (min(seconds), median(seconds), max(seconds)))
    return f"{middle} ({low} to {high}, n = {len(seconds)})"


def run(options: Options, tell: Tell) -> CommandTimes:
    """Fill the caches by one round that counts for nothing, then time the rounds."""
    machine = this_machine()
    chosen = [each for each in ORDERS if not options.commands or each.name in options.commands]
    programs = {"now": PROGRAM} | ({"before": (str(options.before), *PROGRAM[1:])} if options.before else {})
    found: dict[tuple[str, str], list[Taken]] = {
        (which, each.name): [] for which in ("now", "before") for each in chosen
    }
    with TemporaryDirectory() as folder:
        for name, text in FILES.items():
            Path(folder, name).write_text(text, encoding="utf-8")
        for turn in range(options.rounds + 1):
            for order in chosen:
                for which, program in programs.items():
                    if turn == 0 and order.cold:
                        continue
                    taken = timed(program, order, Path(folder), which)
                    tell(f"round {turn}, {which}: {order.name}: {taken.wall_s:.1f} s")
                    found[which, order.name] += [taken] * (turn > 0)
    rows = (
        Row(each.name, tuple(found["now", each.name]), tuple(found.get(("before", each.name), ()))) for each in chosen
    )
    return CommandTimes(machine, tuple(rows))


def timed(program: tuple[str, ...], order: Order, folder: Path, which: str) -> Taken:
    """One run; `RuntimeError` where it is refused."""
    with TemporaryDirectory(dir=folder) as fresh, TemporaryFile() as said:
        cache = Path(fresh if order.cold else folder, f"cache-{which}")
        environment = {name: value for name, value in os.environ.items() if name != "NUMBA_CACHE_DIR"}
        environment |= {"RETARDER_SYNTH_CACHE": str(cache), VARIABLE: "1" if order.plain else "0"}
        began = time.monotonic()
        ran = subprocess.Popen(
            [*program, *order.words, "-o", str(Path(fresh, "out"))],
            cwd=folder, env=environment, stdout=subprocess.DEVNULL, stderr=said,
        )  # fmt: skip
        _, status, used = os.wait4(ran.pid, 0)  # tells of this run alone what it and its children used
        taken = Taken(time.monotonic() - began, used.ru_utime + used.ru_stime, used.ru_maxrss * KIB)
        ran.returncode = os.waitstatus_to_exitcode(status)
        if ran.returncode not in (0, 1):
            said.seek(0)
            raise RuntimeError(f"{order.name} ended with {ran.returncode}: {said.read().decode()}")
    return taken


METHOD = Method(Options, Options(rounds=1, commands=("tune, one coarse case",)), CommandTimes, run)
