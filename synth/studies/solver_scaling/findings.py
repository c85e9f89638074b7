"""What the study of the solver's cost has found."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from synth.studies.markdown_table import MarkdownTable, table
from synth.studies.solver_scaling.value_types import Changes, TwoTypes
from synth.studies.solver_scaling.whole_book import BookTimes
from synth.studies.study import Findings
from synth.studies.timing.machine import Machine
from synth.studies.timing.turns import Times, speed_against, three_digits

TARGETS = "targets"


@dataclass(frozen=True)
class Growth:
    """Sizes of one kind, ascending, and the processor time of one solve of each, the least of all rounds."""

    name: str
    size: tuple[int, ...]
    processor_s: tuple[float, ...]

    @property
    def slope(self) -> float:
        """Of a straight line through the logarithms: 1 for a cost in proportion."""
        return float(np.polyfit(np.log(self.size), np.log(self.processor_s), 1)[0])

    @property
    def extra_over_first(self) -> float:
        """What one more costs, over the cost of the first; for sizes that begin with 1."""
        first, last = self.processor_s[0], self.processor_s[-1]
        return (last - first) / (self.size[-1] - 1) / first

    @property
    def note(self) -> str:
        """What is told of it."""
        if self.name == TARGETS:
            return f"an extra one costs {100.0 * self.extra_over_first:.0f} % of the first"
        return f"slope {self.slope:.2f}"


@dataclass(frozen=True)
class Prediction:
    """Processor time of one prediction on the check grid, the least of all rounds."""

    label: str
    processor_s: float


@dataclass(frozen=True)
class SolverScaling(Findings):
    """All that was timed."""

    config_sha256: str
    machine: Machine
    label: str
    grid: str
    growths: tuple[Growth, ...]
    book: BookTimes
    types: tuple[TwoTypes, ...]
    changes: Changes
    predictions: tuple[Prediction, ...]

    def tables(self) -> Mapping[str, MarkdownTable]:
        """`sizes`, `book`, `types`, `predictions`."""
        sizes = [
            (f"{g.name} {', '.join(map(str, g.size))}",
             f"{', '.join(three_digits(1e3 * s) for s in g.processor_s)} ms", g.note)
            for g in self.growths
        ]  # fmt: skip
        types = [
            (str(t.targets), least_ms(t.single), least_ms(t.double), speed_against(t.single, t.double).cell)
            for t in self.types
        ]
        book = [(name, times.milliseconds) for name, times in (("1", self.book.one), ("2", self.book.two))]
        predictions = [(p.label, three_digits(1e3 * p.processor_s)) for p in self.predictions]
        return {
            "sizes": table("One solve", ("size", "processor time", "on logarithmic axes"), sizes),
            "book": table(self.book_title, ("threads", "wall time, ms"), book),
            "types": table(
                "One solve, processor time", ("targets", "float32, ms", "float64, ms", "float32 over float64, wall"),
                types,
            ),
            "predictions": table("One prediction", ("class", "processor time, ms"), predictions),
        }  # fmt: skip

    @property
    def book_title(self) -> str:
        """What the book is."""
        book = self.book
        return f"{book.classes} classes × {book.targets} targets × {book.friction_scenarios} friction scenarios"

    def sentences(self) -> tuple[str, ...]:
        """The machine, and what float32 changes."""
        change = self.changes
        return (
            f"{self.machine.sentence}; {self.label}, {self.grid}",
            f"float32 changes values by at most {change.values:.0e} of the largest, lines by {change.lines_m_s:.0e} "
            f"m/s, the exact cost of the solver's lines by {change.cost:.0e} and of the polished by "
            f"{change.polished_cost:.0e} of it",
        )

    def faults(self) -> tuple[str, ...]:
        """Threads must not be seen in the bytes."""
        return () if self.book.same_bytes else ("the bytes of the solutions depend on the number of threads",)


def least_ms(times: Times) -> str:
    """Least processor time."""
    return three_digits(1e3 * min(times.processor_s))
