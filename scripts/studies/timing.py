"""The machine that times were taken on, as a study keeps it beside them, and times of calls that run in turns, so
that a slow moment of the machine meets them all.
"""

from __future__ import annotations

import os
import platform
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from importlib.metadata import version
from statistics import median

from synth.frame.machine import available, processor_name


@dataclass(frozen=True)
class Machine:
    """Processor, cores that this process may use, load of the last minute before the study, and software."""

    processor: str
    system: str
    cores: int
    load_before: float
    python: str
    numpy: str
    numba: str

    @property
    def sentence(self) -> str:
        """What a document says of it."""
        return (
            f"{self.processor}, {self.cores} cores, load {self.load_before:.1f} before; {self.system}; "
            f"Python {self.python}, numpy {self.numpy}, numba {self.numba}"
        )


def this_machine() -> Machine:
    """The machine as it is now."""
    return Machine(
        processor=processor_name(),
        system=f"{platform.system()} {platform.machine()}",
        cores=available(),
        load_before=round(os.getloadavg()[0], 2),
        python=platform.python_version(),
        numpy=version("numpy"),
        numba=version("numba"),
    )


Call = Callable[[], object]


@dataclass(frozen=True)
class Times:
    """Wall times and processor times of one call, s, by round; processor time is that of all threads."""

    wall_s: tuple[float, ...]
    processor_s: tuple[float, ...]

    @property
    def median_s(self) -> float:
        """Median wall time."""
        return median(self.wall_s)

    @property
    def median_processor_s(self) -> float:
        """Median processor time."""
        return median(self.processor_s)

    @property
    def of_processor(self) -> Times:
        """The processor times alone: work of one thread, whatever else the machine did meanwhile."""
        return Times(self.processor_s, self.processor_s)

    @property
    def milliseconds(self) -> str:
        """'8.18 (8.10 to 8.30, n = 15)': median, least and greatest wall time."""
        low, high = 1e3 * min(self.wall_s), 1e3 * max(self.wall_s)
        return (
            f"{three_digits(1e3 * self.median_s)} ({three_digits(low)} to {three_digits(high)}, n = {len(self.wall_s)})"
        )


@dataclass(frozen=True)
class Ratio:
    """One time over another, taken round by round: median, extremes, number of rounds."""

    median: float
    least: float
    greatest: float
    rounds: int

    @property
    def cell(self) -> str:
        """'17.5 (15.8 to 18.7, n = 15)'."""
        return (
            f"{three_digits(self.median)} ({three_digits(self.least)} to {three_digits(self.greatest)}, "
            f"n = {self.rounds})"
        )


def in_turns(calls: Mapping[str, Call], rounds: int, fewer: Mapping[str, int] | None = None) -> dict[str, Times]:
    """Every call once a round, after one round that counts for nothing; `fewer` names calls with fewer rounds.

    Calls with fewer rounds run in the first of them.
    """
    wanted = {name: min(rounds, (fewer or {}).get(name, rounds)) for name in calls}
    walls: dict[str, list[float]] = {name: [] for name in calls}
    processors: dict[str, list[float]] = {name: [] for name in calls}
    for call in calls.values():
        call()
    for turn in range(rounds):
        for name, call in calls.items():
            if turn < wanted[name]:
                wall, processor = timed(call)
                walls[name].append(wall)
                processors[name].append(processor)
    return {name: Times(tuple(walls[name]), tuple(processors[name])) for name in calls}


def timed(call: Call) -> tuple[float, float]:
    """Wall time and processor time of one call, s."""
    processor, wall = time.process_time(), time.perf_counter()
    call()
    return time.perf_counter() - wall, time.process_time() - processor


def speed_against(base: Times, other: Times) -> Ratio:
    """How many times as fast as `base` the `other` is, by the rounds that both took."""
    each = [a / b for a, b in zip(base.wall_s, other.wall_s, strict=False)]
    return Ratio(median(each), min(each), max(each), len(each))


def three_digits(number: float) -> str:
    """'0.123', '12.3', '1 234': three digits, more where the whole part has more."""
    if abs(number) >= 99.95:
        return f"{number:,.0f}".replace(",", " ")
    return f"{number:.3g}" if abs(number) < 9.995 else f"{number:.1f}"
