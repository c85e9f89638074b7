"""What happens on the hump, one line of the log each; the states of all elements that the lines amount to; the journal,
where every line goes into log and state, so that the log tells the state completely; and the log as CSV.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable
from dataclasses import dataclass, field
from enum import IntEnum
from typing import NamedTuple


class Kind(IntEnum):
    """What happened; behind it what `value` is. The numbers stand in files: a new kind gets a new one."""

    STORED = 1
    """A cut of the train is in the route store: its track."""
    SIGNAL = 2
    """A signal shows another aspect: `Aspect`."""
    MODE = 3
    """A switch is controlled otherwise: 1 automatic, 0 by hand."""
    OCCUPIED = 4
    """A cut is on a section."""
    FREED = 5
    """A section is free; `cut` left it."""
    COMMANDED = 6
    """Points are commanded for a cut: the position."""
    POSITION = 7
    """Points are detected: the position, or −1 where they move."""
    BLOCKED = 8
    """A throw for a cut waits: `Block`."""
    NOT_SEPARATED = 9
    """A cut came on a section that its leader had not left: the leader."""
    RE_ROUTED = 10
    """A cut gets another track: the track."""
    MISROUTED = 11
    """A cut does not go where the list says: `Why`."""
    ARRIVED = 12
    """A cut is on a classification track: the track."""
    BRAKED = 13
    """A retarder brakes: the resistance in N/kN, or an exit speed in m/s where a table controls it."""
    RELEASED = 14
    """A retarder is open."""
    UNKNOWN_OBJECT = 15
    """A section is occupied by what no list names."""
    ENTRY_COUNTER = 21
    """The counter at an entry joint: axles of the cut still to come."""
    EXIT_COUNTER = 22
    """The counter at the exit joints: axles still to leave."""
    CATCH_UP = 23
    """New information met an exit counter that was not at zero: the leader."""
    TOO_FEW_AXLES = 24
    """A gap within a cut: axles of it still missing."""
    TOO_MANY_AXLES = 25
    """No gap behind a cut: the cut whose axles followed."""
    COUNTER_FAULT = 26
    """The counters of a section contradict each other: axles in less axles out."""
    COUNTERS_LEFT = 27
    """At the end of the train counters are not at zero: axles still to leave."""
    STROBED = 28
    """A computed exit speed was not possible, and the nearest possible one was commanded: the computed one, m/s."""


ALARMS = frozenset(
    {
        Kind.NOT_SEPARATED,
        Kind.MISROUTED,
        Kind.UNKNOWN_OBJECT,
        Kind.CATCH_UP,
        Kind.TOO_FEW_AXLES,
        Kind.TOO_MANY_AXLES,
        Kind.COUNTER_FAULT,
        Kind.COUNTERS_LEFT,
        Kind.STROBED,
    }
)
"""What stands as an alarm until somebody has looked."""


class Aspect(IntEnum):
    """What a hump signal shows, s of the published model."""

    STOP = 0
    HUMP = 1


class Block(IntEnum):
    """Why points are not thrown."""

    BY_HAND = 1
    OCCUPIED = 2
    COUNTERS = 3
    FOULED = 4


class Why(IntEnum):
    """Why a cut does not go where the list says."""

    NOT_SEPARATED = 1
    """It came on a switch that its leader had not left."""
    WRONG_POSITION = 2
    """The points did not lie for it when it came."""
    OFF_ROUTE = 3
    """It, or a part of it, was found where its route does not lead."""
    COUPLED = 4
    """It was not uncoupled from its leader."""
    NOT_SEEN = 5
    """It, or a part of it, was not found on any track at the end of the train."""


class Event(NamedTuple):
    """One line: time from the begin of the train, element and cut concerned (0: none), what happened, and its value."""

    time_s: float
    element: int
    cut: int
    kind: Kind
    value: float = 0.0


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
