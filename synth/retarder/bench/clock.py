"""When the next sample comes: by the clock, or as soon as the controller has answered."""

from __future__ import annotations

import contextlib
import os
import time
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Final, Protocol

from synth.retarder.bench.exchange import Answer, Exchange

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
