"""Trains over the small hump of `test_hump_control`, and what the control did with them."""

from __future__ import annotations

from synth.hump.control.event import Event, Kind
from synth.hump.control.hump_control import HumpControl, Operation
from synth.hump.control.route_table import RouteTable
from tests.plant_models.hump.random_humps import small_hump
from tests.synth.hump.control.cut_motion import MovingCut, moving_cut
from tests.synth.hump.control.made_trains import axle_places, humped, record

TABLE = RouteTable(small_hump())


def rolling(cut: int, start_s: float, speed_m_s: float = 5.0, cars: int = 1, base_m: float = 8.65) -> MovingCut:
    """A cut of constant speed."""
    return moving_cut(cut, axle_places(cars, base_m).tolist(), start_s, [(500.0, speed_m_s)])


def told(control: HumpControl, *kinds: Kind) -> list[Event]:
    """The events of some kinds."""
    return [event for event in control.events if event.kind in kinds]


def commands(control: HumpControl) -> list[tuple[int, int, float]]:
    """(switch, cut, position) of every throw."""
    return [(event.element, event.cut, event.value) for event in told(control, Kind.COMMANDED)]


def close_pair(operation: Operation | None = None) -> HumpControl:
    """Cut 1 to track 2; cut 2 to track 1 comes on switch 1, 21 m behind it, before cut 1 has left it."""
    control, _ = humped(
        TABLE, [record(1, 2), record(2, 1)], [rolling(1, 0.0, 2.5), rolling(2, 8.5, 2.5)], (), operation
    )
    return control
