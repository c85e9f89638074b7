"""What lies on the cable now: the last sample, and the last command; between the position and its servers."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

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
