"""Trains for the tests of the hump control.

Trains of random cuts, and what rolls when they are uncoupled rightly or wrongly.
Trains over the small hump of `test_hump_control`, and what the control did with them.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from synth.hump.control.cut_record import CutRecord, Mark, SortingList
from synth.hump.control.cut_routes import RouteTable
from synth.hump.control.events import Event, Kind
from synth.hump.control.hump_control import HumpControl, Operation
from synth.hump.control.models import ENTRY
from tests.plant_models.hump.random_humps import small_hump
from tests.synth.hump.control.queue_of_cuts import NO_STALLS, Queue, Stall
from tests.synth.hump.control.reference_sections import (
    CounterSlip,
    FalselyFree,
    FalselyOccupied,
    Fault,
    LateSwitch,
    MovingCut,
    StuckSwitch,
    moving_cut,
)
from tests.synth.hump.control.reference_track import ReferenceTrack

TICK_S = 0.1
GRID_M = 10.0
COUPLED_M = 3.5
"""Between the last axle of a car and the first of the next one, coupled."""
USUAL_M, LONG_M = 8.65, 20.5
"""From the first axle of a car to its third one; sections of random humps are 18 m long, shorter than the long car."""


def record(serial: int, track: int, cars: int = 1, lead: int = 0, marks: frozenset[Mark] = frozenset()) -> CutRecord:
    """A cut of four-axle cars."""
    return CutRecord(serial, cars, 4 * cars, 60.0 * cars, 3, track, 13.92 * cars, lead=lead, marks=marks)


def axle_places(cars: int, base_m: float = USUAL_M) -> NDArray[np.float64]:
    """Where the axles of coupled four-axle cars are, behind the first; `base_m` between the inner axles and a bogie."""
    of_car = np.array([0.0, 1.85, base_m, base_m + 1.85])
    return np.concatenate([of_car + car * (of_car[-1] + COUPLED_M) for car in range(cars)])


@dataclass
class Rolling:
    """What rolls as one: the axles of each cut in it, first to last, as (serial, first axle, axles)."""

    parts: list[tuple[int, int, int]] = field(default_factory=list)

    @property
    def cut(self) -> int:
        """The number by which the geometry knows it."""
        return self.parts[0][0]

    def axles_m(self, base_m: float) -> NDArray[np.float64]:
        """Where its axles are, behind the first."""
        axles = sum(count for _, _, count in self.parts)
        return axle_places(axles // 4 + 1, base_m)[:axles]


def uncoupled(cuts: Sequence[CutRecord], splits: dict[int, int], kept: dict[int, int]) -> list[Rolling]:
    """What rolls: `splits`: a cut comes apart behind so many of its axles; `kept`: so many first axles of a cut stay
    coupled to the one ahead."""
    rolling: list[Rolling] = []
    for cut in cuts:
        begun = 0
        if rolling and cut.serial in kept:
            begun = kept[cut.serial]
            rolling[-1].parts.append((cut.serial, 0, begun))
        gap = splits.get(cut.serial, 0)
        if begun < gap < cut.axles:
            rolling.append(Rolling([(cut.serial, begun, gap - begun)]))
            begun = gap
        if begun < cut.axles:
            rolling.append(Rolling([(cut.serial, begun, cut.axles - begun)]))
    return rolling


def moving(
    rolling: Sequence[Rolling],
    cuts: Sequence[CutRecord],
    table: RouteTable,
    random: np.random.Generator,
    close: float,
    base_m: float = USUAL_M,
    stalls: Mapping[int, Stall] = NO_STALLS,
) -> list[MovingCut]:
    """Objects that follow each other and never overlap, their speed a random walk of at most 0.5 m/s in 10 m from 2 to
    7 m/s unless a cut ahead holds them up; `close`: share that comes close behind; `stalls`: by place in the list.
    """
    leads = {cut.serial: cut.lead for cut in cuts}
    lead = table.graph.leads[leads[rolling[0].cut]]
    end_m = max(e.from_m for e in table.places[lead].values()) + 40.0 + 14.0 * sum(cut.cars for cut in cuts)
    grid = np.arange(0.0, end_m + GRID_M, GRID_M)
    found: list[MovingCut] = []
    queue = Queue()
    start_s = 0.0
    for number, each in enumerate(rolling):
        axles = each.axles_m(base_m)
        fast = random.uniform(2.5, 7.0)
        speeds = np.clip(fast + np.cumsum(random.uniform(-0.5, 0.5, len(grid) - 1)), 2.0, 7.0)
        steps = np.diff(grid) / speeds
        times = start_s + np.concatenate([[0.0], np.cumsum(steps)])
        places, times = queue.behind(grid, times, axles, stalls.get(number))
        found.append(MovingCut(each.cut, axles, times, places, leads[each.cut]))
        pause = random.uniform(0.5, 3.0) if random.random() < close else random.uniform(9.0, 16.0)
        start_s = float(times[0]) + (axles[-1] + COUPLED_M) / 2.0 + pause
    return found


def humped(
    table: RouteTable,
    cuts: Sequence[CutRecord],
    objects: Sequence[MovingCut],
    faults: Sequence[Fault] = (),
    operation: Operation | None = None,
    *,
    sees_axles: bool = True,
) -> tuple[HumpControl, ReferenceTrack]:
    """Hump the train until everything stands, and some time more."""
    track = ReferenceTrack(table, objects, faults, sees_axles)
    control = HumpControl(table, SortingList(tuple(cuts)), track, operation)
    tick, rest = 0, 150
    while rest:
        control.tick(tick * TICK_S)
        tick += 1
        rest -= track.is_empty()
    control.finish()
    return control, track


def random_faults(
    table: RouteTable, random: np.random.Generator, count: int, until_s: float, points_alone: bool
) -> list[Fault]:
    """Faults of the equipment, each on an element of its own."""
    switches, sections = sorted(table.needed), sorted(table.sections)
    found: list[Fault] = []
    for element in map(int, random.permutation(switches if points_alone else sections)[:count]):
        from_s = float(random.uniform(0.0, until_s))
        to_s = from_s + float(random.uniform(1.0, 40.0))
        kind = random.integers(0 if element in switches else 2, 2 if points_alone else 5)
        if kind == 0:
            found.append(StuckSwitch(element, from_s, to_s))
        elif kind == 1:
            found.append(LateSwitch(element, float(random.uniform(0.5, 5.0))))
        elif kind == 2:
            end = int(random.choice([ENTRY, 0, 1]))
            found.append(CounterSlip(element, end, int(random.integers(0, 20)), int(random.choice([-1, 1]))))
        elif kind == 3:
            found.append(FalselyOccupied(element, from_s, to_s))
        else:
            found.append(FalselyFree(element, from_s, to_s))
    return found


def random_uncoupling(
    cuts: Sequence[CutRecord], random: np.random.Generator, share: float
) -> tuple[dict[int, int], dict[int, int]]:
    """Cuts that come apart in the middle, and cuts whose first cars stay with the cut ahead, whole cars each."""
    splits = {c.serial: 4 * int(random.integers(1, c.cars)) for c in cuts if c.cars > 1 and random.random() < share}
    kept = {c.serial: 4 * int(random.integers(1, c.cars + 1)) for c in cuts[1:] if random.random() < share}
    return splits, {serial: axles for serial, axles in kept.items() if serial not in splits}


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
