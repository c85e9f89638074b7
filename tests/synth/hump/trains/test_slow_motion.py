"""How cuts of the slow simulator roll: energy, the rolling issue's free roll, and steps of half the length."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pytest

from plant_models.hump import HumpGraph, Route
from plant_models.library.hump_entry import load_hump
from plant_models.rolling.random_cuts import CutPopulation, DrawnCuts
from plant_models.rolling.resistance_law import HumpNormLaw, Tb10062Law
from plant_models.rolling.weather import Weather
from synth.simulation.free_roll import rolling_cuts
from tests.plant_models.rolling.populations import MIX, WINDY, population
from tests.synth.hump.trains.made_slow_trains import heads_in_order, random_train, slow_body, without_positions
from tests.synth.hump.trains.slow_cut import first_root
from tests.synth.hump.trains.slow_humping import STEP_S, humped_slowly
from tests.synth.hump.trains.slow_marks import FIRST_AXLE, marks_of
from tests.synth.hump.trains.slow_train import Mark, SlowCut, SlowRun, SlowTrain

FINE_M = 0.25
"""Step of the free roll that the slow simulator is compared with; its usual step has larger errors in time."""

HUMP = load_hump("large").graph
LEAD = HUMP.leads[0]
FREE_ROLLING = without_positions(HUMP)


def drawn_cut(people: CutPopulation, seed: int, cars: int, heaviness: int) -> DrawnCuts:
    return people.draw(people.categories.members[heaviness], cars, seed, 0, 1)


def alone(graph: HumpGraph, cut: SlowCut) -> SlowTrain:
    """A train of one cut, on empty tracks."""
    free = {track: route.length_m for track, route in graph.routes(LEAD).items()}
    return SlowTrain((cut,), LEAD, free)


def stations(found: SlowRun, body_of: SlowCut, route: Route) -> Mapping[float, tuple[float, float]]:
    """(time, speed) by the place of the head, of the only cut."""
    numbers = [element.number for element in route.elements]
    marks = [each for each in marks_of(body_of.body, route) if (0, numbers[each.order], each.mark) in found.passages]
    passed = [(each.head_m, found.passages[0, numbers[each.order], each.mark]) for each in marks]
    return {head: (passage.time_s, passage.speed_m_s) for head, passage in passed}


def test_positions_are_gone_and_nothing_else() -> None:
    assert not FREE_ROLLING.retarders
    for track, route in HUMP.routes(LEAD).items():
        assert FREE_ROLLING.route(LEAD, track).roll_track == route.roll_track


@pytest.mark.parametrize("cars", [1, 3, 6])
def test_energy_is_kept_without_resistance(cars: int) -> None:
    """v²/2 − g'·fall to 1e-4 of itself, the fall taken from the track's own law and not from the simulator."""
    route = FREE_ROLLING.route(LEAD, 9)
    body = replace(
        slow_body(drawn_cut(population(bends=route.roll_track.bends), 3, cars, 2), 0, {}),
        w0_n_per_kn=0.0, air_n_per_kn=0.0, bend_heads=None,
    )  # fmt: skip
    cut = SlowCut(body, 9, 0.0, 2.0)
    found = stations(humped_slowly(FREE_ROLLING, alone(FREE_ROLLING, cut)), cut, route)
    gravity = 9.81 / (1.0 + 0.42 * sum(len(car.axles_m) for car in body.cars) / body.mass_t)

    def fall_m(head: float) -> float:
        of_cars = [
            car.mass_t * float(route.roll_track.fall_m(head - front - np.array(car.axles_m)).mean())
            for front, car in zip(body.fronts_m, body.cars, strict=True)
        ]
        return sum(of_cars) / body.mass_t

    half_m = 0.5 * body.length_m
    assert len(found) > 30
    for head, (_, speed_m_s) in found.items():
        if head > half_m:
            energy = 0.5 * 2.0**2 + gravity * (fall_m(head) - fall_m(half_m))
            assert 0.5 * speed_m_s**2 == pytest.approx(energy, rel=1e-4)


@pytest.mark.parametrize("law", [HumpNormLaw(), Tb10062Law()], ids=["hump-norm", "tb-10062"])
@pytest.mark.parametrize(("cars", "heaviness", "track"), [(1, 0, 1), (1, 4, 32), (2, 2, 12), (3, 3, 20), (5, 4, 7)])
def test_a_cut_rolls_as_in_the_rolling_issue(
    law: HumpNormLaw | Tb10062Law, cars: int, heaviness: int, track: int
) -> None:
    """At every mark to 2 ms and 2 mm/s, on the whole way of the large hump without its positions."""
    route = FREE_ROLLING.route(LEAD, track)
    snow = 0.3
    people = population(MIX, law, replace(WINDY, snow_n_per_kn=snow), route.roll_track.bends)
    drawn = drawn_cut(people, 10 * track + cars, cars, heaviness)
    cut = SlowCut(slow_body(drawn, 0, heads_in_order(drawn, 0, {track: route})), track, 0.0, 2.0)
    train = replace(
        alone(FREE_ROLLING, cut), linear_n_per_kn=law.linear_n_per_kn, slope_n_per_kn=law.slope_extra_n_per_kn,
        yard_n_per_kn=snow,
    )  # fmt: skip
    found = stations(humped_slowly(FREE_ROLLING, train), cut, route)
    half_m = 0.5 * cut.body.length_m
    heads = np.array([head for head in sorted(found) if head > half_m])
    rolled = rolling_cuts(people, route.roll_track, route.elements[-1].from_m, drawn).roll_on(
        np.array([half_m]), np.array([2.0]), heads[None, :], FINE_M
    )
    times, speeds = (np.array([found[head][k] for head in heads.tolist()]) for k in (0, 1))
    assert len(heads) > 30
    np.testing.assert_allclose(times, rolled.time_s[0], atol=2e-3, rtol=0.0)
    np.testing.assert_allclose(speeds, rolled.speed_m_s[0], atol=2e-3, rtol=0.0)


def crowded_train(seed: int) -> SlowTrain:
    """Six cuts of one to three cars for few tracks, so that they catch up with each other."""
    rng = np.random.default_rng(seed)
    people = population(MIX, HumpNormLaw(), Weather(), HUMP.route(LEAD, 1).roll_track.bends)
    drawn = [drawn_cut(people, 6 * seed + k, int(rng.integers(1, 4)), int(rng.integers(5))) for k in range(6)]
    return random_train(HUMP, drawn, seed, (1, 2, 3, 9, 17))


def compared(found: SlowRun, finer: SlowRun) -> float:
    """The largest difference of times at marks, once the events are the same."""
    assert found.outcome() == finer.outcome()
    assert found.passages.keys() == finer.passages.keys()
    assert found.tracks == finer.tracks
    return max(abs(passage.time_s - finer.passages[key].time_s) for key, passage in found.passages.items())


@pytest.mark.long
@pytest.mark.parametrize("seed", range(4))
def test_half_the_step_gives_the_same_events_and_times(seed: int) -> None:
    train = crowded_train(seed)
    found, finer = humped_slowly(HUMP, train), humped_slowly(HUMP, train, 0.5 * STEP_S)
    assert len(found.events) >= len(train.cuts)
    assert found.closest_s > 1e-3
    assert compared(found, finer) < 1e-3


def test_first_axles_and_marks_agree() -> None:
    """A mark of a first axle is at the head's place less the overhang: what the comparison above rests on."""
    route = FREE_ROLLING.route(LEAD, 1)
    body = slow_body(drawn_cut(population(bends=route.roll_track.bends), 1, 2, 1), 0, {})
    for each in marks_of(body, route):
        behind = body.first_axle_m if each.mark in FIRST_AXLE else body.last_axle_m
        if each.mark is not Mark.TRACK:
            assert each.head_m - each.place_m == pytest.approx(behind)


@pytest.mark.parametrize(
    ("bend", "slope", "begin", "root"),
    [(0.0, -2.0, 1.0, 0.5), (-4.0, 1.0, 1.5, 0.75), (1.0, -2.5, 1.0, 0.5), (0.0, 1.0, -0.5, 0.0)],
)
def test_the_first_root_of_a_gap(bend: float, slope: float, begin: float, root: float) -> None:
    """Gaps that close evenly, ever faster, ever slower, and one that was closed before."""
    at = [begin + slope * x + bend * x * x for x in (0.0, 0.5, 1.0)]
    assert first_root(*at) == pytest.approx(root, abs=1e-12)
