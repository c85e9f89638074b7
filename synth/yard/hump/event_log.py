"""The log of a hump: what happened, in the order in which it was found; lines are added and never changed."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable

from synth.frame.input_error import InputError
from synth.yard.hump.event import Event, Kind
from tuning_tables.excerpt import excerpt

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


def events_of_csv(text: str, file: str) -> tuple[Event, ...]:
    """The lines in `text`; `InputError` names the row at fault."""
    try:
        rows = list(csv.reader(io.StringIO(text, newline=""), strict=True))
    except csv.Error as fault:
        raise InputError(f"{file}: this is not valid CSV ({fault}); export the log again") from None
    if not rows or tuple(rows[0]) != COLUMNS:
        raise InputError(f"{file}: its first row must be {','.join(COLUMNS)}; give an exported log")
    return tuple(event_of_row(cells, f"{file}: row {number}") for number, cells in enumerate(rows[1:], start=2))


def event_of_row(cells: list[str], place: str) -> Event:
    """One line of the log."""
    if len(cells) != len(COLUMNS):
        raise InputError(f"{place}: {len(cells)} cells; a line of a log has {len(COLUMNS)}")
    time, element, cut, name, value = cells
    kind = Kind.__members__.get(name.upper().replace("-", "_"))
    if kind is None:
        raise InputError(f"{place}: event {excerpt(name)!r} is unknown; export the log again")
    try:
        return Event(float(time), int(element), int(cut), kind, float(value))
    except ValueError as fault:
        raise InputError(f"{place}: {excerpt(str(fault), 120)}; export the log again") from None
