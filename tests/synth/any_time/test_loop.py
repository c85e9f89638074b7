"""The simulator of commands at any time: the rule that it runs, commands during a change of stage, and valves that do
not open (without a fault the simulators of sound valves; what stands still; by hand; figures).
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest

from plant_models import Plant
from scripts.studies.any_time.findings import Ways
from scripts.studies.any_time.wrong_plants import (
    NOTHING,
    STUCK,
    StuckLoop,
    StuckValves,
    where_stuck,
    with_a_silent_gauge,
)
from synth.kernels.loop.passes import Draws
from synth.simulation.closed_loop import ClosedLoop, LineController, TableController, close_loop
from synth.simulation.common_passes import common_passes
from synth.simulation.passes import PassTrace
from synth.simulation.random_passes import random_passes
from synth.solver.any_time.polynomial_surfaces import CUBIC_AND_SLOPE, PolynomialSurfaces
from synth.solver.switching_lines import SwitchingLines
from synth.solver.tabulate import UNPREDICTED, tabulate
from tests.synth.any_time.conftest import ORIGIN, tabled
from tuning_tables import ControllerTable


def falling_lines(plant: Plant, nodes: int) -> SwitchingLines:
    """Lines that fall to 3 m/s and make much ado."""
    s = np.linspace(0.0, plant.exit_m, nodes)
    middle = 3.0 + 1.2 * (1.0 - s / plant.exit_m) ** 2 + 0.03 * np.sin(s) + 0.1 * np.arange(3)[:, None]
    lower, upper = middle - 0.03, middle + 0.03
    lower[0], upper[-1] = -np.inf, np.inf
    return SwitchingLines(s, lower, upper)


def polynomials(
    plant: Plant, coefficients: np.ndarray, has_line: np.ndarray, degrees: tuple[int, ...]
) -> PolynomialSurfaces:
    stages = np.asarray(plant.position.stage_pressures_kpa)
    return PolynomialSurfaces(plant.start_m, plant.exit_m, stages, degrees, coefficients, has_line)


def test_two_stages_can_be_climbed_in_two_samples(plant: Plant) -> None:
    always_up = np.full((3, 2, 1), 0.5)
    has_line = np.array([[False, True], [False, True], [False, False]])
    trace = close_loop(plant, plant.position.top_stage + 1).follow(
        tabled(plant, polynomials(plant, always_up, has_line, (0,))),
        close_loop(plant, plant.position.top_stage + 1).draws(random_passes(1, 0, 1)),
    )
    times = trace.time_s[1:][np.diff(trace.stage) == 1]
    assert np.diff(times) == pytest.approx([0.1])
    pressure = 50.0 + trace.overpressure_kpa
    still_s = 0.02 + 0.1 + 0.2  # computing, valve and touch delay from the first command, and no second delay
    filled = trace.time_s[np.argmax(pressure > 284.9)] - times[0]
    assert filled == pytest.approx(still_s + 0.3 * math.log((700.0 - 15.0) / (700.0 - 285.0)), abs=0.021)


FOR_EVER = {each.name: replace(each, duration_s=math.inf) for each in STUCK}
BOTH = FOR_EVER["both valves, 1 s"]
FILLING = FOR_EVER["filling valve, for good"]
RELEASE = FOR_EVER["release valve, for good"]


@pytest.fixture(scope="module")
def loop(plant: Plant) -> ClosedLoop:
    return close_loop(plant, plant.position.top_stage + 1)


@pytest.fixture(scope="module")
def lines(plant: Plant) -> LineController:
    return LineController(falling_lines(plant, 101))


def surfaces(plant: Plant, slope_m_s: float) -> PolynomialSurfaces:
    coefficients = np.zeros((3, 2, 5))
    coefficients[:, :, 0] = 3.0 + np.array([0.15, 0.3])
    coefficients[:, :, 1], coefficients[:, :, 2], coefficients[:, :, 4] = -0.25, 0.05, slope_m_s
    has_line = np.array([[False, True], [True, True], [True, False]])
    return PolynomialSurfaces(
        0.0, plant.exit_m, np.asarray(plant.position.stage_pressures_kpa), CUBIC_AND_SLOPE, coefficients, has_line
    )


def surface_table(plant: Plant, slope_m_s: float) -> ControllerTable:
    return tabulate(plant, surfaces(plant, slope_m_s), 3.0, UNPREDICTED, *ORIGIN)


@pytest.fixture(scope="module")
def table(plant: Plant) -> TableController:
    return TableController(surface_table(plant, 0.06))


def every_way(loop: ClosedLoop, lines: LineController, table: TableController) -> Iterator[StuckLoop]:
    """The three regulators of the study."""
    yield StuckLoop(loop, lines, Ways.GAUGE)
    yield StuckLoop(loop, lines, Ways.TIMES)
    yield StuckLoop(loop, table, Ways.ANY_TIME)


def held_up(draws: Draws, start_s: float) -> np.ndarray:
    return np.full(len(draws.cut_factor), start_s)


# ------------------------------------------------------------------------------------ sound valves


def test_sound_valves_give_the_passes_of_the_closed_loop(
    loop: ClosedLoop, lines: LineController, table: TableController
) -> None:
    draws = loop.draws(random_passes(11, 0, 2000))
    for each in every_way(loop, lines, table):
        found, known = each.run(draws, NOTHING, held_up(draws, 1.0)), loop.run(each.controller, draws)
        assert known.switchings.mean() > 3.0
        assert (found.switchings == known.switchings).all()
        assert (found.stalled == known.stalled).all()
        if each.way is Ways.ANY_TIME:
            assert (found.exit_speed_m_s == known.exit_speed_m_s).all()
            assert (found.transit_time_s == known.transit_time_s).all()
        else:  # the locked simulator has its pressures from a history, rounded to 1e-9 kPa
            assert found.exit_speed_m_s == pytest.approx(known.exit_speed_m_s, abs=1e-9)
            assert found.transit_time_s == pytest.approx(known.transit_time_s, abs=1e-9)


def test_a_fault_after_the_pass_changes_no_bit_and_one_within_it_does(
    loop: ClosedLoop, lines: LineController, table: TableController
) -> None:
    draws = loop.draws(random_passes(12, 0, 300))
    for each in every_way(loop, lines, table):
        sound = each.run(draws, NOTHING, held_up(draws, 0.0))
        late = each.run(draws, BOTH, sound.transit_time_s)
        assert (late.exit_speed_m_s == sound.exit_speed_m_s).all()
        assert (late.switchings == sound.switchings).all()
        early = each.run(draws, BOTH, 0.5 * sound.transit_time_s)
        assert (early.exit_speed_m_s != sound.exit_speed_m_s).mean() > 0.5


# ------------------------------------------------------------------------------------ what a stuck valve does


def traces(loop: ClosedLoop, each: StuckLoop, stuck: StuckValves, start_s: float) -> Iterator[PassTrace]:
    for i in range(20):
        yield each.follow(loop.draws(random_passes(13, i, 1)), stuck, start_s)


def test_with_both_valves_stuck_the_pressure_stays(
    loop: ClosedLoop, lines: LineController, table: TableController
) -> None:
    for each in every_way(loop, lines, table):
        for found in traces(loop, each, BOTH, 0.0):
            assert (found.overpressure_kpa == 0.0).all()
            assert found.stage.max() >= 1  # commanded, and not carried out
        moved = 0.0
        for found in traces(loop, each, BOTH, 1.5):
            # The first sample lies within a period behind the start.
            after = found.overpressure_kpa[found.time_s >= 1.6]
            assert np.ptp(after) < 1e-9
            moved = max(moved, after.max())
        assert moved > 0.0  # not all of them got stuck before they braked


@pytest.mark.parametrize(
    ("stuck", "sign", "start_s"), [(FILLING, 1.0, 1.5), (RELEASE, -1.0, 0.1)], ids=["filling", "release"]
)
def test_one_stuck_valve_lets_the_other_work(
    loop: ClosedLoop, lines: LineController, table: TableController, stuck: StuckValves, sign: float,
    start_s: float,
) -> None:  # fmt: skip
    for each in every_way(loop, lines, table):
        worked = 0
        for found in traces(loop, each, stuck, start_s):
            change = np.diff(found.overpressure_kpa[found.time_s >= start_s + 0.1])
            assert (sign * change < 1e-9).all()
            worked += int((sign * change < -1.0).any())
        assert worked > 0


def test_lines_by_gauge_are_silent_while_a_valve_is_stuck_and_lines_by_times_are_not(
    loop: ClosedLoop, lines: LineController
) -> None:
    gauge, times = (StuckLoop(loop, lines, way) for way in (Ways.GAUGE, Ways.TIMES))
    for found in traces(loop, gauge, FILLING, 0.0):
        assert (np.diff(found.stage) != 0).sum() == 1  # the first command is waited for in vain
    commands = [(np.diff(found.stage) != 0).sum() for found in traces(loop, times, FILLING, 0.0)]
    assert max(commands) > 1


def test_a_valve_that_is_free_again_pays_its_whole_delay(plant: Plant, loop: ClosedLoop) -> None:
    """By hand: commanded at the first sample, stuck for 1 s, then computed pressure of a first filling."""
    up = PolynomialSurfaces(
        0.0, plant.exit_m, np.asarray(plant.position.stage_pressures_kpa), (0,), np.full((3, 2, 1), 0.5),
        np.array([[False, True], [False, True], [False, False]]),
    )  # fmt: skip
    draws = loop.draws(random_passes(1, 0, 1))
    second = STUCK[1]
    assert (second.filling, second.release, second.duration_s) == (True, True, 1.0)
    trace = StuckLoop(loop, tabled(plant, up), Ways.ANY_TIME).follow(draws, second, 0.0)
    free_s = draws.first_sample_s[0] + math.ceil((1.0 - draws.first_sample_s[0]) / 0.1 - 1e-9) * 0.1
    touched_s = free_s + 0.1 + 0.2 + 0.3 * math.log((700.0 - 15.0) / (700.0 - 50.0))
    first = np.flatnonzero(trace.overpressure_kpa > 0.0)[0]
    assert trace.time_s[first] <= touched_s < trace.time_s[first + 1]
    filled_s = free_s + 0.1 + 0.2 + 0.3 * math.log((700.0 - 15.0) / (700.0 - 285.0))
    assert trace.time_s[np.argmax(trace.overpressure_kpa > 234.9)] == pytest.approx(filled_s, abs=0.021)


# ------------------------------------------------------------------------------------ figures and the silent gauge


def test_figures_are_those_of_the_passes(plant: Plant, table: TableController, lines: LineController) -> None:
    passes = common_passes(plant, random_passes(14, 0, 400))
    found = where_stuck(3.0, table, lines, passes, 5)
    assert list(found) == [each.name for each in STUCK]
    nothing, for_good = found[NOTHING.name], found["release valve, for good"]
    error = passes.run(table).exit_speed_m_s - 3.0
    ours = nothing.ways[Ways.ANY_TIME.value]
    assert ours.rms_m_s == pytest.approx(math.sqrt((error**2).mean()))
    assert ours.outside == pytest.approx((abs(error) > 0.3).mean())
    assert nothing.to_times.value == pytest.approx(ours.rms_m_s / nothing.ways[Ways.TIMES.value].rms_m_s)
    assert nothing.to_times.value == pytest.approx(nothing.to_gauge.value, abs=1e-9)
    surfaces_rms, gauge_rms = (for_good.ways[way.value].rms_m_s for way in (Ways.ANY_TIME, Ways.GAUGE))
    assert for_good.to_gauge.value == pytest.approx(surfaces_rms / gauge_rms)
    assert for_good.to_gauge.value != pytest.approx(for_good.to_times.value)
    assert min(way.rms_m_s for way in for_good.ways.values()) > 2.0 * ours.rms_m_s


def test_a_silent_gauge_asks_the_lines_at_the_stages_pressure(plant: Plant, lines: LineController) -> None:
    passes = common_passes(plant, random_passes(15, 0, 400))
    with_slope, without = (surface_table(plant, slope) for slope in (0.06, 0.0))
    found = with_a_silent_gauge(3.0, with_slope, lines, passes)
    flat = with_a_silent_gauge(3.0, without, lines, passes)
    assert found == flat
    assert found.gain.value == pytest.approx(found.waiting.value / found.going_on.value)
    assert found.gain.value != 1.0
