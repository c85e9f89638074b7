"""Where every event goes: into the log and into the state, so that the log tells the state completely."""

from __future__ import annotations

from synth.hump.control.event import Event, Kind
from synth.hump.control.hump_state import HumpState


class Journal:
    """A log, whose lines are added and never changed, and the state that it amounts to; `now_s` stands in events that
    tell no time of their own."""

    def __init__(self) -> None:
        self._events: list[Event] = []
        self.state, self.now_s = HumpState(), 0.0

    @property
    def events(self) -> tuple[Event, ...]:
        """All lines so far, in the order in which it was found what happened."""
        return tuple(self._events)

    def tell(self, kind: Kind, element: int, cut: int = 0, value: float = 0.0, time_s: float | None = None) -> None:
        """Record what happened, and change the state accordingly."""
        event = Event(self.now_s if time_s is None else time_s, element, cut, kind, float(value))
        self._events.append(event)
        self.state.apply(event)
