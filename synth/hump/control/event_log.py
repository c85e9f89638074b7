"""The log of a hump: what happened, in the order in which it was found; lines are added and never changed."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable

from synth.hump.control.event import Event

COLUMNS = ("time_s", "element", "cut", "event", "data")


class EventLog:
    """An append-only list of events."""

    def __init__(self) -> None:
        self._events: list[Event] = []

    def append(self, event: Event) -> None:
        """One line more."""
        self._events.append(event)

    def __len__(self) -> int:
        return len(self._events)

    @property
    def events(self) -> tuple[Event, ...]:
        """All lines so far."""
        return tuple(self._events)


def to_log_csv(events: Iterable[Event]) -> str:
    """The lines as CSV with the columns time_s, element, cut, event, data; numbers read back exactly."""
    text = io.StringIO(newline="")
    writer = csv.writer(text, lineterminator="\r\n")
    writer.writerow(COLUMNS)
    for event in events:
        name = event.kind.name.lower().replace("_", "-")
        writer.writerow([repr(event.time_s), event.element, event.cut, name, repr(event.value)])
    return text.getvalue()
