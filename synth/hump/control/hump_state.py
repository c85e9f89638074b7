"""The states of all elements of a hump: what the events so far amount to."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
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
        """The state after `event`."""
        change = CHANGES.get(event.kind)
        if change is not None:
            change(self, event)
        if event.kind in ALARMS:
            self.alarms.append(event)


def replayed(events: Iterable[Event]) -> HumpState:
    """The state that `events` lead to."""
    state = HumpState()
    for event in events:
        state.apply(event)
    return state


def on_stored(state: HumpState, event: Event) -> None:
    """The cut has a track."""
    state.tracks[event.cut] = int(event.value)


def on_signal(state: HumpState, event: Event) -> None:
    """The signal shows it."""
    state.aspects[event.element] = int(event.value)


def on_mode(state: HumpState, event: Event) -> None:
    """The switch is controlled so."""
    if event.value == 1.0:
        state.by_hand.discard(event.element)
    else:
        state.by_hand.add(event.element)


def on_occupied(state: HumpState, event: Event) -> None:
    """The object is on it."""
    state.occupants[event.element] = event.cut


def on_freed(state: HumpState, event: Event) -> None:
    """Nothing is on it."""
    state.occupants[event.element] = 0


def on_commanded(state: HumpState, event: Event) -> None:
    """The points are to lie so."""
    state.commanded[event.element] = int(event.value)


def on_position(state: HumpState, event: Event) -> None:
    """The points lie so."""
    state.positions[event.element] = int(event.value)


def on_misrouted(state: HumpState, event: Event) -> None:
    """The cut is marked."""
    state.misrouted.add(event.cut)


def on_arrived(state: HumpState, event: Event) -> None:
    """The cut, or a part of it, is on the track."""
    tracks = state.arrived.setdefault(event.cut, [])
    if int(event.value) not in tracks:
        tracks.append(int(event.value))


def on_braking(state: HumpState, event: Event) -> None:
    """The retarder brakes so."""
    state.braking[event.element] = event.value


def on_entry(state: HumpState, event: Event) -> None:
    """The entry counter shows it."""
    state.counters[event.element] = Counters(int(event.value), state.counters.get(event.element, Counters()).exit)


def on_exit(state: HumpState, event: Event) -> None:
    """The exit counter shows it."""
    state.counters[event.element] = Counters(state.counters.get(event.element, Counters()).entry, int(event.value))


CHANGES: Mapping[Kind, Callable[[HumpState, Event], None]] = {
    Kind.STORED: on_stored,
    Kind.RE_ROUTED: on_stored,
    Kind.SIGNAL: on_signal,
    Kind.MODE: on_mode,
    Kind.OCCUPIED: on_occupied,
    Kind.NOT_SEPARATED: on_occupied,
    Kind.UNKNOWN_OBJECT: on_occupied,
    Kind.FREED: on_freed,
    Kind.COMMANDED: on_commanded,
    Kind.POSITION: on_position,
    Kind.MISROUTED: on_misrouted,
    Kind.ARRIVED: on_arrived,
    Kind.BRAKED: on_braking,
    Kind.RELEASED: on_braking,
    Kind.ENTRY_COUNTER: on_entry,
    Kind.EXIT_COUNTER: on_exit,
}
"""What an event changes; kinds that are not here change nothing but alarms."""
