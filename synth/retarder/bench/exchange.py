"""What lies on the cable now: the last sample, and the last command; between the position and its servers. And when the
next sample comes: by the clock, or as soon as the controller has answered.
"""

from __future__ import annotations

import contextlib
import os
import threading
import time
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Final, Protocol

from synth.retarder.bench.wires import COUNTS, TOLD

Values = Mapping[str, float]


@dataclass(frozen=True)
class Answer:
    """The stage that stands when a sample is over; `response_s`: from the sample to its answer, None without one."""

    stage: int
    response_s: float | None


@dataclass
class Traffic:
    """What was heard so far: requests, those refused and why the last was, commands of a stage that the position does
    not have (refused, too), connections made, and open."""

    requests: int = 0
    refused: int = 0
    last_refusal: str = ""
    impossible: int = 0
    connections: int = 0
    connected: int = 0


class Exchange:
    """Between one thread that plays the position and those of servers; a command stands until another comes.

    `stages`: 0 … `stages` − 1 can be commanded; all else is refused, and what stood before stands.
    """

    def __init__(self, stages: int) -> None:
        self._stages = stages
        self._changed = threading.Condition()
        self._values: Values = dict.fromkeys((each.name for each in TOLD), 0.0)
        self._told_s = 0.0
        self._stage = 0
        self._response_s: float | None = None
        self._traffic = Traffic()
        self._hearers: list[Callable[[Values], None]] = []

    def hear(self, hearer: Callable[[Values], None]) -> None:
        """`hearer` is told each sample, at once, in the thread of the position."""
        self._hearers.append(hearer)

    @property
    def values(self) -> Values:
        """What the position tells, all of one sample."""
        return self._values

    @property
    def traffic(self) -> Traffic:
        """What was heard so far, a copy."""
        with self._changed:
            return replace(self._traffic)

    def tell(self, values: Values, stage: int) -> None:
        """A new sample; `stage` stands unless a command comes."""
        with self._changed:
            self._values, self._stage = values, stage
            self._told_s, self._response_s = time.monotonic(), None
        for hearer in self._hearers:
            hearer(values)

    def answer(self, wait_s: float = 0.0) -> Answer:
        """What stands now, or as soon as the sample is answered, at the latest after `wait_s`."""
        with self._changed:
            self._changed.wait_for(lambda: self._response_s is not None, wait_s)
            return Answer(self._stage, self._response_s)

    def command(self, stage: int) -> bool:
        """Command `stage`; whether it is one of the position."""
        with self._changed:
            is_possible = 0 <= stage < self._stages
            if is_possible:
                self._stage = stage
            else:
                self._traffic.impossible += 1
            return is_possible

    def answered(self, sample: int) -> None:
        """The stage commanded answers `sample`; another than the last one told is no answer."""
        with self._changed:
            if self._response_s is None and sample == self._values["sample"]:
                self._response_s = time.monotonic() - self._told_s
                self._changed.notify_all()

    def refuse(self, why: str) -> None:
        """A request was refused, that of an impossible stage too."""
        with self._changed:
            self._traffic.refused += 1
            self._traffic.last_refusal = why

    def requested(self) -> None:
        """A request came."""
        self._traffic.requests += 1

    def connected(self, opens: bool) -> None:
        """A client has come, or gone."""
        with self._changed:
            self._traffic.connections += opens
            self._traffic.connected += 1 if opens else -1


def next_count(number: int) -> int:
    """The count after `number`."""
    return (number + 1) % COUNTS


TOLERANCE: Final = 0.1
"""Of a period: a cycle that is longer or shorter by more is off."""

MOST_OFF: Final = 0.01
"""Share of the cycles that may be off; with more the score may be the clock's."""


class Clock(Protocol):
    """What the position is played by."""

    def next_sample(self, exchange: Exchange) -> Answer:
        """Wait until the sample is over; what stands then."""
        ...


@dataclass
class RealTime:
    """A sample every `period_s` seconds; `cycles_s` are the times that they took.

    After a stop of the machine the clock goes on from there: no samples are made up for.
    """

    period_s: float
    cycles_s: list[float] = field(default_factory=list)
    _due_s: float = 0.0
    _last_s: float = 0.0

    def next_sample(self, exchange: Exchange) -> Answer:
        """See `Clock`."""
        now = time.monotonic()
        if now - self._due_s > self.period_s:
            self._due_s = self._last_s = now
        self._due_s += self.period_s
        time.sleep(max(0.0, self._due_s - now))
        over_s = time.monotonic()
        self.cycles_s.append(over_s - self._last_s)
        self._last_s = over_s
        return exchange.answer()


@dataclass(frozen=True)
class Cycles:
    """How a clock was kept: the times that samples `period_s` apart `took_s`.

    `is_first`: the bench went before all else that the machine had to do.
    """

    period_s: float
    took_s: tuple[float, ...]
    is_first: bool

    @property
    def off(self) -> int:
        """Those that differ from the period by more than `TOLERANCE`."""
        return sum(abs(each - self.period_s) > TOLERANCE * self.period_s for each in self.took_s)

    @property
    def are_kept(self) -> bool:
        """No more than `MOST_OFF` of them are off."""
        return self.off <= MOST_OFF * len(self.took_s)

    @property
    def worst_s(self) -> float:
        """That which differs most."""
        return max(self.took_s, key=lambda each: abs(each - self.period_s))


@dataclass(frozen=True)
class InStep:
    """The next sample comes with the answer; without one after `patience_s`."""

    patience_s: float

    def next_sample(self, exchange: Exchange) -> Answer:
        """See `Clock`."""
        return exchange.answer(self.patience_s)


@contextlib.contextmanager
def before_all_others() -> Iterator[bool]:
    """Within, this thread and those that it starts run before all ordinary ones: whether the system permits it.

    A controller's own machine does the same. Without it, a machine with much to do holds a sample up by tens of
    milliseconds.
    """
    if not hasattr(os, "sched_setscheduler"):
        yield False
        return
    policy, priority = os.sched_getscheduler(0), os.sched_getparam(0)
    try:
        os.sched_setscheduler(0, os.SCHED_RR, os.sched_param(1))
    except OSError:
        yield False
        return
    try:
        yield True
    finally:
        os.sched_setscheduler(0, policy, priority)
