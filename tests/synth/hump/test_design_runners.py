"""Runners without brakes: their rolls against an integration of the law in time, and the picture that shows them."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from plant_models.hump import Route
from plant_models.library import load_car
from plant_models.library.hump_entry import load_hump
from synth.frame.picture.figure_file import draw
from synth.hump.control.pictures.hump_picture import hump_picture
from synth.hump.control.pictures.plan_layout import plan_layout
from synth.hump.design_runners import DESIGN_RUNNERS, DesignRunner, roll_runners
from tests.effort import every


def in_time(route: Route, runner: DesignRunner, until_m: float) -> float:
    """Speed at `until_m` by integrating acceleration over time: forces on each axle, no step of the kernel."""
    car = load_car("gondola-4").car
    axles = np.asarray(car.axle_offsets_m)
    track = route.roll_track

    def rate(_: float, state: np.ndarray) -> list[float]:
        middle, speed = state
        at = middle + axles[-1] / 2.0 - axles
        grade = np.where(at >= 0.0, track.profile.grade_permille(at), 0.0).mean()
        against = speed + runner.head_wind_m_s
        air = 17.8 * 1.36 * 8.5 / 283.0 / runner.mass_t * against * abs(against)
        bends = sum(
            (0.56 * bend.switches + 0.23 * bend.turn_deg) * speed**2 / (bend.to_m - bend.from_m)
            for bend in track.bends
            if bend.from_m <= middle < bend.to_m
        )
        g = 9.81 / (1.0 + 0.42 * 4 / runner.mass_t)
        return [speed, g * 1e-3 * (grade - runner.resistance_n_per_kn - air - bends)]

    def arrived(_: float, state: np.ndarray) -> float:
        return float(state[0] - until_m)

    arrived.terminal = True  # type: ignore[attr-defined]  # as solve_ivp wants it
    found = solve_ivp(rate, (0.0, 600.0), [0.0, 1.7], events=arrived, max_step=0.02, rtol=1e-8)
    return float(found.y[1, -1])


@pytest.mark.parametrize("runner", every(3, DESIGN_RUNNERS), ids=lambda runner: runner.name)
def test_a_runner_rolls_as_the_law_says(runner: DesignRunner) -> None:
    route = load_hump("large").graph.route(201, 22)
    (roll,) = roll_runners(route, (runner,))
    for place in (112.0, 246.0, 500.0):
        assert np.interp(place, roll.at_m, roll.speed_m_s) == pytest.approx(in_time(route, runner, place), abs=0.02)


def test_the_bad_runner_stops_and_the_others_do_not() -> None:
    route = load_hump("large").graph.route(201, 1)
    good, mean, bad = roll_runners(route)
    assert np.isinf(good.stop_m)
    assert np.isinf(mean.stop_m)
    assert 500.0 < bad.stop_m < 900.0
    assert bad.at_m[-1] < bad.stop_m <= bad.at_m[-1] + 1.0
    for roll in (good, mean, bad):
        assert (np.diff(roll.energy_head_m) < 0.0).all()  # nothing gives a rolling car energy
    # at the crest the light car has more energy for its weight: its wheels are the larger part of it
    assert good.energy_head_m[0] < bad.energy_head_m[0]
    assert (good.energy_head_m[10 : len(bad.at_m)] > bad.energy_head_m[10:]).all()
    assert route.yard_from_m == 316.0 + 11.0


def test_a_plan_gives_each_track_a_row_and_each_element_its_metres() -> None:
    graph = load_hump("large-two-leads").graph
    layout = plan_layout(graph)
    assert [layout.row[track] for track in graph.tracks] == list(range(32))
    places = set(layout.at.values())
    assert len(places) == len(graph.vertices)  # nothing is drawn upon another thing
    for lead in graph.leads:
        for route in graph.routes(lead).values():
            for element in route.elements:
                assert layout.at[element.number][0] == pytest.approx(element.at_m)


def test_the_picture_has_the_same_bytes_twice() -> None:
    hump = load_hump("dumper")
    route = hump.graph.route(201, 3)
    pictures = [draw(hump_picture(hump, route, roll_runners(route))) for _ in range(2)]
    assert pictures[0] == pictures[1]
