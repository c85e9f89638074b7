"""What the benchmark has found."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from scripts.studies.benchmark.work import SweepWork
from scripts.studies.markdown_table import ABSENT, MarkdownTable, table
from scripts.studies.study import Findings
from scripts.studies.timing.machine import Machine
from scripts.studies.timing.turns import Times, speed_against, three_digits

LANES = 16
ROUNDING = 1e-9
"""Values and lines of both recursions in float64 differ by less."""


@dataclass(frozen=True)
class Way:
    """One way of solving, for so many targets at once."""

    name: str
    targets: int
    times: Times


@dataclass(frozen=True)
class Limit:
    """A loop that does one thing only: `operations` on vectors of sixteen float32; the sweep needs `needed` of them."""

    name: str
    operations: int
    needed: int
    times: Times

    @property
    def per_s(self) -> float:
        """Operations a second at best."""
        return self.operations / min(self.times.processor_s)

    @property
    def sweep(self) -> Times:
        """Processor time that the sweep would take by it, by round."""
        taken = tuple(self.needed / self.operations * seconds for seconds in self.times.processor_s)
        return Times(taken, taken)


@dataclass(frozen=True)
class Benchmark(Findings):
    """All ways, in turns with the loops of the machine's limits; each is one thread, so ratios are of processor times.

    `ways`: the first is what a tune does, the last is numpy. `largest_value_difference` over the largest value and
    `largest_line_difference_m_s`: kernels against numpy, both in float64.
    """

    config_sha256: str
    machine: Machine
    label: str
    size: str
    work: SweepWork
    largest_value_difference: float
    largest_line_difference_m_s: float
    ways: tuple[Way, ...]
    limits: tuple[Limit, ...]

    def tables(self) -> Mapping[str, MarkdownTable]:
        """`speed`: a row a way of solving; `limit`: a row a limit of the machine."""
        first, last = self.ways[0], self.ways[-1]
        rows = [
            (way.name, way.times.of_processor.milliseconds, three_digits(1e3 * way.times.median_s),
             f"{self.rate(way):.2e}", self.against(last, way))
            for way in self.ways
        ]  # fmt: skip
        heads = ("", "processor ms", "wall ms", "transitions a second", "speed against numpy")
        found = [
            (each.name, f"{each.per_s:.2e}", f"{each.needed:.2e}", three_digits(1e3 * each.sweep.median_s),
             speed_against(first.times.of_processor, each.sweep).cell)
            for each in self.limits
        ]  # fmt: skip
        limits = ("on one core", "a second", "needed", "takes at least, ms", f"{first.name}: times that")
        return {
            "speed": table(f"A backward sweep of {self.label}, one core", heads, rows),
            "limit": table(f"The limit of the machine, vectors of {LANES} float32", limits, found),
        }

    def against(self, base: Way, way: Way) -> str:
        """The speed of `way` against `base`, where both do the same work."""
        if way is base or way.targets != base.targets:
            return "1" if way is base else ABSENT
        return speed_against(base.times.of_processor, way.times.of_processor).cell

    def rate(self, way: Way) -> float:
        """Transitions a second of processor time."""
        return self.work.transitions * way.targets / way.times.median_processor_s

    def sentences(self) -> tuple[str, ...]:
        """The problem, the machine, the agreement."""
        work = self.work
        return (
            f"{self.label}: {self.size}; {work.states:,} states and {work.transitions:,} transitions a target",
            self.machine.sentence,
            f"kernels and numpy, both in float64: values within {self.largest_value_difference:.0e} of the largest, "
            f"lines within {self.largest_line_difference_m_s:.0e} m/s",
        )

    def faults(self) -> tuple[str, ...]:
        """The two recursions must be one."""
        worst = max(self.largest_value_difference, self.largest_line_difference_m_s)
        return () if worst < ROUNDING else (f"kernels and numpy differ by {worst:.1e} in float64",)
