"""Random trains, and what the control made of them.

Random trains with random faults on random humps, and what the control made of them against what really happened.
By hand: `python -m tests.synth.hump.control.judged_trains FIRST LAST` humps the trains of these seeds and counts.
"""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np

from plant_models.hump import HumpGraph
from synth.hump.control.cut_record import CutRecord, Mark
from synth.hump.control.cut_routes import RouteTable
from synth.hump.control.events import ALARMS, Kind, replayed
from synth.hump.control.hump_control import HumpControl, Operation
from synth.hump.control.models import PUBLISHED_MODEL, PracticeRules
from tests.plant_models.hump.random_humps import random_hump
from tests.synth.hump.control.made_trains import (
    LONG_M,
    USUAL_M,
    Rolling,
    humped,
    moving,
    random_faults,
    random_uncoupling,
    record,
    uncoupled,
)
from tests.synth.hump.control.queue_of_cuts import FOULING_M, random_stalls
from tests.synth.hump.control.reference_sections import Fault, LateSwitch, MovingCut
from tests.synth.hump.control.reference_track import ReferenceTrack

SURE, NEAR = 1.25, 2.0
"""A gap within a cut that is wider than the rule asks for by the first factor is one for sure; so is one between two
cuts that is wider by the second: speeds change while it passes."""
SLOW_S, SLOW_M = 0.3, 0.25
"""An object that moved less than that in so long, and moves no more in the next, is slower than the rule's 1 m/s."""


@dataclass(frozen=True)
class Scene:
    """What may go wrong: `faults` of sensors and points, or of points alone, at most; a share of wrong uncouplings."""

    faults: int = 0
    points_alone: bool = False
    wrong_share: float = 0.0
    stalled_share: float = 0.0
    """Of the objects that roll."""
    published: bool = False
    """The published model alone: it knows which object is where, and has neither counters nor rules of practice."""


@dataclass
class Humping:
    """A train that was humped."""

    table: RouteTable
    cuts: Sequence[CutRecord]
    rolling: Sequence[Rolling]
    objects: Sequence[MovingCut]
    faults: Sequence[Fault]
    control: HumpControl
    track: ReferenceTrack
    rules: PracticeRules = field(default_factory=PracticeRules)
    stalled: int = 0

    @property
    def told(self) -> frozenset[tuple[Kind, int, int, float]]:
        """Kind, element, cut and value of every alarm."""
        return frozenset((e.kind, e.element, e.cut, e.value) for e in self.control.state.alarms)

    def thrown_under(self) -> list[tuple[float, int, int]]:
        """Points that were commanded to move under a cut, or that moved under it though their machine was in time."""
        late = {fault.switch for fault in self.faults if isinstance(fault, LateSwitch)}
        truth = self.track.truth
        return [*truth.thrown_under, *(each for each in truth.moved_under if each[1] not in late)]

    def thrown_beside(self) -> Iterator[tuple[float, int, int]]:
        """Points that were commanded to move while an object behind them stood or crawled, its last axle short of the
        fouling point: (time, switch, object), from the tables of the motions alone."""
        for event in self.control.events:
            for number, each in enumerate(self.objects):
                if event.kind is not Kind.COMMANDED or (event.element, number) not in self.track.truth.came_s:
                    continue
                now, place = event.time_s, self.table.places[self.table.graph.leads[each.lead]][event.element]
                before_m, now_m, after_m = (each.place_m(now + step * SLOW_S) for step in (-1, 0, 1))
                slow, beyond_m = max(now_m - before_m, after_m - now_m) < SLOW_M, now_m - place.at_m
                if slow and 0.0 < beyond_m < each.axles_m[-1] + FOULING_M:
                    yield now, event.element, number

    def lost(self) -> Iterator[tuple[int, int]]:
        """(cut, element): cuts, or parts of them, that ended elsewhere than on their track and are not recorded."""
        for number, element in self.track.truth.ends.items():
            for cut, _, _ in self.rolling[number].parts:
                own = self.control.store.record(cut).track
                if self.table.home.get(element) != own and cut not in self.control.state.misrouted:
                    yield cut, element

    def silent_counters(self) -> list[int]:
        """Sections whose counters, by their own account or in the state, are not at zero and which have no alarm."""
        alarmed = {element for kind, element, _, _ in self.told if kind in ALARMS}
        waiting = {element for element, shown in self.control.state.counters.items() if any(shown)}
        return sorted((waiting | set(self.control.counters.left_over())) - alarmed)

    def replays(self) -> bool:
        """Whether the log leads to the same state."""
        return replayed(self.control.events) == self.control.state

    def catch_ups(self) -> tuple[set[tuple[int, int]], set[tuple[int, int]]]:
        """(section, follower) of true catch-ups, and of those that the counters told."""
        told = {(element, cut) for kind, element, cut, _ in self.told if kind is Kind.CATCH_UP}
        return set(self._true_catch_ups()), told

    def _true_catch_ups(self) -> Iterator[tuple[int, int]]:
        """From the tables of the motions alone: the first axle came before an axle of a cut ahead had left."""
        for element in sorted(self.table.sections - self.table.last):
            left_s: dict[int, float] = {}
            came_s: dict[int, float] = {}
            for number, each in enumerate(self.rolling):
                if (element, number) not in self.track.truth.came_s:
                    continue
                moves, first = self.objects[number], 0
                place = self.table.places[self.table.graph.leads[moves.lead]][element]
                for cut, _, axles in each.parts:
                    came_s.setdefault(cut, moves.arrivals_s(place.from_m)[first])
                    left_s[cut] = moves.arrivals_s(place.to_m)[first + axles - 1]
                    first += axles
            order = sorted(came_s)
            for place_in_order, cut in enumerate(order):
                if any(came_s[cut] < left_s[ahead] for ahead in order[:place_in_order]):
                    yield element, cut

    def uncouplings(self) -> tuple[set[tuple[str, int]], set[tuple[str, int]]]:
        """Wrong uncouplings at the first section, true ones and told ones. Where speeds change, a gap near the limit
        of a rule may be told or not: it is left out of both."""
        told = {("apart", cut) for kind, _, cut, _ in self.told if kind is Kind.TOO_FEW_AXLES}
        told |= {("kept", int(value)) for kind, _, _, value in self.told if kind is Kind.TOO_MANY_AXLES}
        true: set[tuple[str, int]] = set()
        for number, each in enumerate(self.rolling):
            true |= {("kept", cut) for cut, _, _ in each.parts[1:]}
            cut = each.parts[0][0]
            if not number or self.objects[number - 1].lead != self.objects[number].lead:
                continue
            gap_m = self._gap_m(number)
            if self.rolling[number - 1].parts[-1][0] != cut:
                if gap_m < NEAR * PracticeRules().coupled_gap_m:
                    told.discard(("kept", cut))
            elif gap_m > SURE * self._rule_m(cut):
                true.add(("apart", cut))
            else:
                told.discard(("apart", cut))
        return true, told

    def _rule_m(self, cut: int) -> float:
        """No car of the cut has more between two axles."""
        rules, marks = PracticeRules(), self.control.store.record(cut).marks
        return rules.longest_base_m if Mark.LONG_BASE in marks else rules.usual_base_m

    def _gap_m(self, number: int) -> float:
        """Between the last axle ahead of an object and its first, where the first section begins."""
        ahead, behind = self.objects[number - 1], self.objects[number]
        lead = self.table.graph.leads[behind.lead]
        first = self.table.next_section(lead)
        assert first is not None
        joint_m = self.table.places[lead][first].from_m
        return ahead.place_m(behind.arrivals_s(joint_m)[0]) - float(ahead.axles_m[-1]) - joint_m


def random_humping(seed: int, scene: Scene) -> Humping:
    """The train `seed` on a hump of its own."""
    random, table = np.random.default_rng(seed), RouteTable(random_hump(seed))
    cuts: list[CutRecord] = []
    rolling: list[Rolling] = []
    objects: list[MovingCut] = []
    stalled = 0
    base_m = LONG_M if random.random() < 0.3 else USUAL_M
    marks = frozenset({Mark.LONG_BASE}) if base_m == LONG_M else frozenset()
    for place, lead in enumerate(table.graph.leads):
        if place and joined(table.graph):
            continue
        tracks, begun = list(table.graph.routes(lead)), len(cuts)
        train = [
            record(begun + row, int(random.choice(tracks)), min(int(random.geometric(0.5)), 6), place, marks)
            for row in range(1, int(random.integers(2, 13)))
        ]
        rolls = uncoupled(train, *random_uncoupling(train, random, scene.wrong_share))
        cuts, rolling = cuts + train, rolling + rolls
        stalls = random_stalls([each.axles_m(base_m) for each in rolls], table, lead, random, scene.stalled_share)
        objects += moving(rolls, train, table, random, 0.2, base_m, stalls)
        stalled += len(stalls)
    until_s = max(float(each.times_s[-1]) for each in objects)
    faults = random_faults(table, random, int(random.integers(0, scene.faults + 1)), until_s, scene.points_alone)
    rules = PUBLISHED_MODEL if scene.published else PracticeRules()
    control, track = humped(table, cuts, objects, faults, Operation(rules=rules), sees_axles=not scene.published)
    return Humping(table, cuts, rolling, objects, faults, control, track, rules, stalled)


def joined(graph: HumpGraph) -> bool:
    """Whether routes from two crests share something: then one lead alone is humped over."""
    ways = [{e.number for route in graph.routes(lead).values() for e in route.elements} for lead in graph.leads]
    return len(ways) > 1 and bool(ways[0] & ways[1])


def judgement(humping: Humping) -> Counter[str]:
    """What is to be zero, and how much there was of what."""
    true, told = humping.catch_ups()
    wrong, found = humping.uncouplings()
    judged_gaps = all(humping.table.next_section(lead) not in humping.table.last for lead in humping.table.graph.leads)
    return Counter(
        {
            "trains": 1,
            "cuts": len(humping.cuts),
            "faults": len(humping.faults),
            "misrouted": len(humping.control.state.misrouted),
            "thrown under": len(humping.thrown_under()),
            "thrown beside": len(list(humping.thrown_beside())) if humping.rules.fouling_m_s else 0,
            "stalled": humping.stalled,
            "lost": len(list(humping.lost())),
            "silent counters": len(humping.silent_counters()),
            "other states": int(not humping.replays()),
            "catch-ups": len(true),
            "catch-ups missed": len(true - told),
            "catch-ups false": len(told - true),
            "wrong uncouplings": len(wrong),
            "wrong uncouplings missed": len(wrong - found) if judged_gaps else 0,
            "wrong uncouplings false": len(found - wrong),
        }
    )


SCENES = {
    "no fault": Scene(),
    "points": Scene(faults=3, points_alone=True),
    "uncoupling": Scene(wrong_share=0.15),
    "sensors and points": Scene(faults=3),
    "all": Scene(faults=3, wrong_share=0.1),
    "stalled": Scene(stalled_share=0.1),
    "stalled, points": Scene(faults=3, points_alone=True, stalled_share=0.1),
    "stalled, all": Scene(faults=3, wrong_share=0.1, stalled_share=0.1),
    "published model, points": Scene(faults=3, points_alone=True, published=True),
    "stalled, published model, points": Scene(faults=3, points_alone=True, stalled_share=0.1, published=True),
}


def main(first: int, last: int) -> None:
    """Print the counts of every scene; the seeds go round among them."""
    for place, (name, scene) in enumerate(SCENES.items()):
        counts: Counter[str] = Counter()
        for seed in range(first + place, last, len(SCENES)):
            counts.update(judgement(random_humping(seed, scene)))
        print(f"{name}: {dict(counts)}", flush=True)


if __name__ == "__main__":
    main(int(sys.argv[1]), int(sys.argv[2]))
