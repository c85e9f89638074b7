"""A position that runs exported tables: which class of a book stands for a cut, of its category, nearest by axles, then
by axle load; each cut through the closed loop under the two nearest targets of its class.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass

import numpy as np

from plant_models import PlantError
from plant_models.frozen_arrays import Bools, Floats, Ints, frozen_arrays
from plant_models.library.weight_category import WeightCategories
from synth.hump.rolling.hump_position import Arrivals, Passed
from synth.kernels.loop.passes import Draws
from synth.retarder.table_class import TableClass, draws, taken
from synth.simulation.closed_loop import ClosedLoop, picked
from synth.simulation.random_passes import RandomPasses, keyed_passes

MOST_LONGER, MOST_SHORTER = 10.0 / 3.0, 1.5
"""A class stands for cuts of up to so many times its axles, and of as few as its axles over the other number."""


@dataclass(frozen=True)
class ClassChoice:
    """The classes of a book, and the categories that arrivals name by their places.

    Nearest by axles is the class with the least difference in number, of two the one with fewer; among those with equal
    axles the one with the nearest axle load. A book of single cars thus serves cuts of three, one with cuts of three
    serves cuts of ten.
    """

    classes: tuple[TableClass, ...]
    categories: WeightCategories

    def of(self, arrivals: Arrivals) -> Ints:
        """Place of the class of each cut, (m,); `PlantError` for the first kind of cut that none stands for."""
        found = np.empty(len(arrivals), dtype=np.int64)
        kinds, of_kind = np.unique(np.stack((arrivals.category, arrivals.axles)), axis=1, return_inverse=True)
        loads = np.array([c.plant.cut.axle_load_t for c in self.classes])
        for kind, (category, axles) in enumerate(kinds.T):
            rows = np.flatnonzero(of_kind.reshape(-1) == kind)
            able = self.able(int(category), int(axles))
            apart = np.abs((arrivals.mass_t[rows] / axles)[:, None] - loads[able])
            found[rows] = able[apart.argmin(axis=1)]
        return found

    def able(self, category: int, axles: int) -> Ints:
        """The classes, by place, among which the axle load decides for cuts of this category with so many axles."""
        member = self.categories.members[category]
        counts = {
            place: c.plant.cut.axles for place, c in enumerate(self.classes) if c.plant.cut.category == member.name
        }
        nearest = nearest_axles(counts.values(), axles)
        if nearest is None:
            raise PlantError(f"tables: none for cuts of category {member.label} with {axles} axles")
        return np.array([place for place, count in counts.items() if count == nearest])


def nearest_axles(held: Collection[int], axles: int) -> int | None:
    """Which of the axle numbers `held` of the classes of a category stands for cuts with so many `axles`; None where
    none does."""
    nearest = min(held, key=lambda count: (abs(count - axles), count), default=0)
    return nearest if nearest and nearest / MOST_SHORTER <= axles <= nearest * MOST_LONGER else None


@dataclass(frozen=True)
class TableHumpPosition:
    """Exported tables as a position of the hump. A cut gets the class that `choice` finds for it.

    What the class does not have comes from the cut: mass and axles (in the work of the brake), entry speed, path, and
    what track and air take from it by the metre (`loop_resistance_n_kn`). Its axles stand where those of the class do.
    On a shorter path than its own a cut comes faster, so that brake and rolling have the same work in all; times are
    stretched to the path of the cut and to its speed. No cut leaves faster than it would unbraked.

    Between two targets exit speed and time are linear: the controller that chooses its lines between tables is taken to
    do so. Where one of both passes stops, the nearer target alone counts; it always does for the commands to the
    valves. A command beyond the lowest or highest target is that target.

    A cut has one friction factor in all positions, as oil stays on its wheels, or another in each: `friction_anew`.
    """

    choice: ClassChoice
    friction_anew: bool = False

    def passed(self, arrivals: Arrivals) -> Passed:
        """See `HumpPosition`; `PlantError` for a cut that has no class."""
        exits, times = np.empty(len(arrivals)), np.empty(len(arrivals))
        switchings = np.empty(len(arrivals), dtype=np.int64)
        found, passes = self.choice.of(arrivals), self._passes(arrivals)
        for place in np.unique(found):
            rows = np.flatnonzero(found == place)
            passed = class_passed(self.choice.classes[place], arrivals.chosen(rows), taken(passes, rows))
            exits[rows], times[rows], switchings[rows] = passed.exit_m_s, passed.time_s, passed.switchings
        return Passed(exits, times, switchings)

    def _passes(self, arrivals: Arrivals) -> RandomPasses:
        """The random numbers of the cuts, as many along the path as the class with the most cells needs."""
        own, of_cut = arrivals.keys, (arrivals.train, arrivals.cut)
        cells = max(braked_cells(of_class.loops[0]) for of_class in self.choice.classes)
        return keyed_passes(arrivals.seed, own, own if self.friction_anew else of_cut, cells)


@frozen_arrays
class Looped:
    """What the closed loop makes of n cuts under their lower and their higher target, (2, n) each."""

    exit_m_s: Floats
    time_s: Floats
    stalled: Bools
    switchings: Ints

    def between(self, share: Floats) -> Passed:
        """What it makes of them under commands at `share` (n,) of the way from the lower to the higher target."""
        nearer = (share > 0.5).astype(np.int64)
        share = np.where(self.stalled.any(axis=0), nearer, share)
        speed, time = (low + share * (high - low) for low, high in (self.exit_m_s, self.time_s))
        return Passed(speed, time, self.switchings[nearer, np.arange(len(share))])


def class_passed(its: TableClass, cuts: Arrivals, passes: RandomPasses) -> Passed:
    """How cuts pass that all have the class `its`."""
    targets = its.targets_m_s
    place = np.interp(cuts.commanded_m_s, targets, np.arange(len(targets)))
    low, high = np.floor(place).astype(np.int64), np.ceil(place).astype(np.int64)
    looped = looped_under(its, cuts, passes, low, high).between(place - low)
    exit_m, speed = its.plant.exit_m, np.minimum(looped.exit_m_s, cuts.unbraked_exit_m_s)
    faster = (loop_entry_m_s(exit_m, cuts) + speed) / (cuts.entry_m_s + speed)
    time = np.where(speed > 0.0, looped.time_s, np.inf) * (cuts.path_m / exit_m) * faster
    return Passed(speed, time, looped.switchings)


def looped_under(its: TableClass, cuts: Arrivals, passes: RandomPasses, low: Ints, high: Ints) -> Looped:
    """The passes of all cuts under their targets, at the places `low` and `high` (n,)."""
    loop = its.loops[0]
    resistance = loop_resistance_n_kn(loop, cuts)
    entry = loop_entry_m_s(loop.plant.exit_m, cuts)
    drawn = draws(loop, passes, its.brakes(passes, cuts.mass_t, cuts.axles), entry, resistance)
    ahead_s, shape = approach_s(loop, drawn), (2, len(cuts))
    speed, time = np.empty(shape), np.empty(shape)
    stalled, switchings = np.empty(shape, dtype=np.bool_), np.empty(shape, dtype=np.int64)
    for k in np.unique(np.concatenate((low, high))):
        rows = np.flatnonzero((low == k) | (high == k))
        sample = its.loops[k].run(its.controllers[k], picked(drawn, rows))
        behind_s = sample.transit_time_s - ahead_s[rows]
        for side, wanted in enumerate((low, high)):
            here = wanted[rows] == k
            at = side, rows[here]
            speed[at], time[at] = sample.exit_speed_m_s[here], behind_s[here]
            stalled[at], switchings[at] = sample.stalled[here], sample.switchings[here]
    return Looped(speed, time, stalled, switchings)


def loop_entry_m_s(exit_m: float, cuts: Arrivals) -> Floats:
    """Entry speed of the cuts in a loop of `exit_m`: on a shorter way than theirs they gain less, so they come faster.

    With it an unbraked pass of the loop ends with the speed of the unbraked cut.
    """
    return np.sqrt(np.maximum(cuts.unbraked_exit_m_s**2 - 2.0 * gain_m_s2(cuts) * exit_m, 0.0))


def loop_resistance_n_kn(loop: ClosedLoop, cuts: Arrivals) -> Floats:
    """Resistance of the cuts in the loop of their class: with it they gain or lose by the metre what they do unbraked.

    So it holds what the track of the hump takes or gives otherwise than that of the class: grade, bends. A braked cut
    is slower; what the air takes less from it is left out.
    """
    path = loop.path
    braked = slice(path.approach_cells, None)
    fall = float(path.gravity_m_s2[braked] @ np.diff(path.edges_m)[braked]) / loop.plant.exit_m
    slower = cuts.resistance_n_per_kn - cuts.unbraked_resistance_n_per_kn
    lost = fall - gain_m_s2(cuts) + 1e-3 * cuts.reduced_gravity_m_s2 * slower
    return np.asarray(lost / path.drag_m_s2_per_n_kn)


def gain_m_s2(cuts: Arrivals) -> Floats:
    """Mean acceleration of the unbraked cuts along their path; negative where they lose speed."""
    return np.asarray((cuts.unbraked_exit_m_s**2 - cuts.entry_m_s**2) / (2.0 * cuts.path_m))


def approach_s(loop: ClosedLoop, drawn: Draws) -> Floats:
    """Time of the passes from where the regulator acts to the entrance; nothing brakes there."""
    path, speed, time = loop.path, drawn.entry_m_s, np.zeros_like(drawn.entry_m_s)
    for cell in range(path.approach_cells):
        gap = float(path.edges_m[cell + 1] - path.edges_m[cell])
        free = path.gravity_m_s2[cell] - path.drag_m_s2_per_n_kn * drawn.resistance_n_kn
        next_speed = np.sqrt(np.maximum(speed**2 + 2.0 * free * gap, 0.0))
        time, speed = time + 2.0 * gap / (speed + next_speed), next_speed
    return time


def braked_cells(loop: ClosedLoop) -> int:
    """Path cells in which the brake may act."""
    return len(loop.path.gravity_m_s2) - loop.path.approach_cells
