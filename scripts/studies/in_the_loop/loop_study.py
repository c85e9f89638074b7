"""The compiled C controller as a process of its own in the closed loop, against the same in the simulator.

Every table runs over the same passes twice: with rule and estimator in the simulator, and with each decision, and each
estimate if the table has an estimator, asked from the process through a pipe.
"""

from __future__ import annotations

import tempfile
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from scripts.studies.in_the_loop.books import Tuned, tuned_book
from scripts.studies.in_the_loop.controller_process import BuildError, build_controller
from scripts.studies.in_the_loop.software_in_the_loop import PipeLine, closed_loop_with_process
from scripts.studies.markdown_table import MarkdownTable, table
from scripts.studies.options import option
from scripts.studies.study import Findings, Method, Tell
from synth.frame.input_error import InputError
from synth.simulation.exit_statistics import exit_statistics
from synth.simulation.random_passes import random_passes


@dataclass(frozen=True)
class Options:
    """How many passes, and how it is compiled."""

    config: Path | None = option(None, "configuration; the built-in default book without it")
    masses_t: tuple[float, ...] = option((), "only cuts of these masses, t")
    passes: int = option(500, "passes of each table", (1, 10**6))
    seed: int = option(1, "of the passes", (0, 2**31))
    compiler: str = option("gcc", "compiler")
    level: str = option("-O2", "its level of optimisation")


@dataclass(frozen=True)
class Row:
    """One table; `differing`: passes of which exit speed, time, stall or number of switchings differ in any bit."""

    id: str
    estimator: bool
    passes: int
    differing: int
    rms_m_s: float


@dataclass(frozen=True)
class InTheLoop(Findings):
    """All tables, without estimators and with them."""

    config_sha256: tuple[str, str]
    seed: int
    compiled_by: str
    rows: tuple[Row, ...]

    def tables(self) -> Mapping[str, MarkdownTable]:
        """`passes`: a row a table."""
        heads = ("table", "estimator", "passes", "differ", "rms, m/s")
        rows = [
            (row.id, "yes" if row.estimator else "no", str(row.passes), str(row.differing), f"{row.rms_m_s:.4f}")
            for row in self.rows
        ]
        return {"passes": table("Passes by a process of its own", heads, rows)}

    def sentences(self) -> tuple[str, ...]:
        """All passes together."""
        return (
            f"{self.differing} of {sum(row.passes for row in self.rows)} passes differ ({self.compiled_by}), "
            f"seed {self.seed}",
        )

    @property
    def differing(self) -> int:
        """Passes that differ, of all tables."""
        return sum(row.differing for row in self.rows)

    def faults(self) -> tuple[str, ...]:
        """No pass may differ."""
        return (f"{self.differing} passes differ",) if self.differing else ()


def run(options: Options, tell: Tell) -> InTheLoop:
    """Tune both books, compile, run."""
    books = [tuned_book(options.config, estimator, options.masses_t, tell) for estimator in (False, True)]
    line = PipeLine()
    rows = [row for tuned in books for row in rows_of(tuned, options, line)]
    tell(f"{len(rows)} tables run")
    return InTheLoop(
        config_sha256=(books[0].config_sha256, books[1].config_sha256),
        seed=options.seed,
        compiled_by=f"{options.compiler} {options.level}",
        rows=tuple(rows),
    )


def rows_of(tuned: Tuned, options: Options, line: PipeLine) -> Iterator[Row]:
    """Every table of a book. Raises `InputError` where the compiler is not there."""
    passes = random_passes(options.seed, 0, options.passes)
    with tempfile.TemporaryDirectory() as directory:
        try:
            controller = build_controller(tuned.book, Path(directory), options.compiler, (options.level,))
        except (BuildError, FileNotFoundError) as fault:
            raise InputError(f"study: {options.compiler} {options.level} makes no controller: {fault}") from None
        for number, (each, plant) in enumerate(zip(tuned.book.tables, tuned.plants, strict=True)):
            found = closed_loop_with_process(plant, each, number, controller, passes, line)
            rms = exit_statistics(found.process, each.target_speed_m_s).rms_m_s
            yield Row(each.id, each.estimator is not None, len(passes), found.differing, rms)


METHOD = Method(Options, Options(masses_t=(52.0,), passes=120), InTheLoop, run)
