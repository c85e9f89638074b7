"""The log of a hump as CSV."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable

from synth.hump.control.event import Event

COLUMNS = ("time_s", "element", "cut", "event", "data")


def to_log_csv(events: Iterable[Event]) -> str:
    """The lines as CSV with the columns time_s, element, cut, event, data; numbers read back exactly."""
    text = io.StringIO(newline="")
    writer = csv.writer(text, lineterminator="\r\n")
    writer.writerow(COLUMNS)
    for event in events:
        name = event.kind.name.lower().replace("_", "-")
        writer.writerow([repr(event.time_s), event.element, event.cut, name, repr(event.value)])
    return text.getvalue()
