"""What the benchmark has found, what a sweep cannot do without, counted on the chain itself, and what one core can
do at most now.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from scripts.studies.benchmark.by_numpy import Swept
from scripts.studies.benchmark.kernels.roofline import loads, loads_a_turn, multiply_adds
from scripts.studies.study import ABSENT, Findings, MarkdownTable, table
from scripts.studies.timing import Call, Machine, Times, speed_against, three_digits
from synth.kernels.vector.packs import SIXTEEN
from synth.solver.chain.chain import Chain


@dataclass(frozen=True)
class SweepWork:
    """Work for one target.

    `states`: scenario, path node, resting mode, noise level, energy (stalls left out). `transitions`: a state, a
    command, an outcome: a landing of a change (a noise level and a side of the law of the friction met), or a noise
    level of a quantum rolled at a held stage on the way to the next sample. `products`: multiply-adds of values that
    interpolating and mixing take; where landings lie, gains and lines are not counted. `value_floats`: the values of
    one scenario that a node reads from, at a sample and before the noise level changes.
    """

    states: int
    transitions: int
    products: int
    value_floats: int


def sweep_work(chain: Chain, swept: Swept) -> SweepWork:
    """Count; `swept` knows how many landings were no stalls."""
    levels, reach = len(chain.path_noise.levels), len(chain.entry)
    rows = len(chain.actuator.mode_stage) * levels
    points, nodes = len(chain.grid.speed_m_s), len(chain.drive_m_s2)
    states = nodes * len(chain.scenarios.factor) * rows * (points - 1)
    rolled = states * (reach - 1)
    ring = chain.transient_noise.probability.shape[1] + 3
    return SweepWork(
        states=states,
        transitions=swept.landings + rolled * levels,
        products=4 * swept.groups + rolled * (levels + 4) + states * levels,
        value_floats=2 * ring * rows * points,
    )


SUMS_A_TURN = 12
WORK = 2_500_000
"""Operations of one loop: about a millisecond."""

NEAREST_FLOATS = 4096
"""16 KB: less than the first-level cache of any processor that this runs on."""

CACHE_LINE_BYTES = 64


@dataclass(frozen=True)
class Loop:
    """A call, and how many operations on vectors of sixteen it makes."""

    call: Call
    operations: int


def multiply_add_loop() -> Loop:
    """Sums of products in registers."""
    turns = WORK // SUMS_A_TURN
    return Loop(partial(multiply_adds, turns, filled(SIXTEEN, 0.5), filled(SIXTEEN, 0.0)), SUMS_A_TURN * turns)


def load_loop(floats: int = NEAREST_FLOATS) -> Loop:
    """Loads from so many floats over and over."""
    a_turn = int(loads_a_turn(floats))
    turns = max(1, WORK // a_turn)
    return Loop(partial(loads, turns, filled(floats, 1.0), filled(SIXTEEN, 0.0)), a_turn * turns)


def filled(floats: int, number: float) -> NDArray[np.float32]:
    """The same number so many times, from the beginning of a cache line on: a load across two lines takes longer."""
    raw = np.empty(4 * floats + CACHE_LINE_BYTES, dtype=np.uint8)
    start = -raw.ctypes.data % CACHE_LINE_BYTES
    array = raw[start : start + 4 * floats].view(np.float32)
    array[:] = number
    return array


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
