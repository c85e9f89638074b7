"""The states of all elements of a hump: what the events so far amount to."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import NamedTuple

from synth.hump.control.event import ALARMS, Event, Kind

MOVING = -1
"""Position of points that are on their way, or not known yet."""


class Counters(NamedTuple):
    """Axles that the entry counter and the exit counters of a section still wait for."""

    entry: int = 0
    exit: int = 0


@dataclass
class HumpState:
    """Changeable parts of the vectors of the published model: position s, mode m and object N of switches, aspects of
    signals, resistance and object of retarders, objects of sections; and of the hump
    computer: counters, track of each cut, alarms.

    It changes by `apply` alone, so the events tell it completely.
    """

    positions: dict[int, int] = field(default_factory=dict)
    commanded: dict[int, int] = field(default_factory=dict)
    by_hand: set[int] = field(default_factory=set)
    occupants: dict[int, int] = field(default_factory=dict)
    aspects: dict[int, int] = field(default_factory=dict)
    braking: dict[int, float] = field(default_factory=dict)
    counters: dict[int, Counters] = field(default_factory=dict)
    tracks: dict[int, int] = field(default_factory=dict)
    misrouted: set[int] = field(default_factory=set)
    arrived: dict[int, list[int]] = field(default_factory=dict)
    alarms: list[Event] = field(default_factory=list)

    def position(self, switch: int) -> int:
        """s of the switch: 0 left, 1 right; MOVING on the way or before it was detected."""
        return self.positions.get(switch, MOVING)

    def occupant(self, element: int) -> int:
        """N of the element: the object that came last on its section; 0 where it is free."""
        return self.occupants.get(element, 0)

    def is_automatic(self, switch: int) -> bool:
        """m of the switch."""
        return switch not in self.by_hand

    def apply(self, event: Event) -> None:
        """The state after `event`; kinds that are not here change nothing but alarms."""
        element, cut, value = event.element, event.cut, event.value
        match event.kind:
            case Kind.STORED | Kind.RE_ROUTED:
                self.tracks[cut] = int(value)
            case Kind.SIGNAL:
                self.aspects[element] = int(value)
            case Kind.MODE if value == 1.0:
                self.by_hand.discard(element)
            case Kind.MODE:
                self.by_hand.add(element)
            case Kind.OCCUPIED | Kind.NOT_SEPARATED | Kind.UNKNOWN_OBJECT:
                self.occupants[element] = cut
            case Kind.FREED:
                self.occupants[element] = 0
            case Kind.COMMANDED:
                self.commanded[element] = int(value)
            case Kind.POSITION:
                self.positions[element] = int(value)
            case Kind.MISROUTED:
                self.misrouted.add(cut)
            case Kind.ARRIVED if int(value) not in self.arrived.get(cut, ()):
                self.arrived.setdefault(cut, []).append(int(value))
            case Kind.BRAKED | Kind.RELEASED:
                self.braking[element] = value
            case Kind.ENTRY_COUNTER:
                self.counters[element] = self.counters.get(element, Counters())._replace(entry=int(value))
            case Kind.EXIT_COUNTER:
                self.counters[element] = self.counters.get(element, Counters())._replace(exit=int(value))
        if event.kind in ALARMS:
            self.alarms.append(event)


def replayed(events: Iterable[Event]) -> HumpState:
    """The state that `events` lead to."""
    state = HumpState()
    for event in events:
        state.apply(event)
    return state
