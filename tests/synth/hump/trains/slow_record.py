"""What has happened to a train so far: events, passages, and how near decisions were to their limits."""

from __future__ import annotations

from math import inf

from tests.synth.hump.trains.slow_train import Kind, Mark, Passage, SlowEvent


class SlowRecord:
    """Events in the order in which they are found; passages by (cut, element, mark)."""

    def __init__(self) -> None:
        self.events: list[SlowEvent] = []
        self.passages: dict[tuple[int, int, Mark], Passage] = {}
        self.decisions: list[tuple[float, int, int, Mark, float]] = []
        self.margins_s: list[float] = []

    def tell(self, time_s: float, kind: Kind, element: int, cut: int, value: float = 0.0) -> None:
        """Note an event."""
        self.events.append(SlowEvent(time_s, kind, element, cut, value))

    def passed(self, j: int, number: int, mark: Mark, time_s: float, delay_s: float = 0.0) -> bool:
        """Whether the last axle of cut `j` was at `mark` by `time_s`, and `delay_s` before that."""
        self.decisions.append((time_s, j, number, mark, delay_s))
        passage = self.passages.get((j, number, mark))
        return passage is not None and passage.time_s + delay_s <= time_s

    def closest(self) -> float:
        """Seconds by which the nearest decision could have been another; infinite where none was made."""
        margins = list(self.margins_s)
        for time_s, j, number, mark, delay_s in self.decisions:
            passage = self.passages.get((j, number, mark))
            if passage is not None:
                margins.append(abs(time_s - passage.time_s - delay_s))
        return min(margins, default=inf)
