"""What happens on the hump, one line of the log each."""

from __future__ import annotations

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
