"""Valves that do not open: the simulators of sound valves without a fault, by hand, and a second, slow formulation."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest

from plant_models import Plant
from synth.kernels.loop.closed_loop import Draws
from synth.simulation.closed_loop import ClosedLoop, LineController, TableController, close_loop
from synth.simulation.common_passes import common_passes
from synth.simulation.passes import PassTrace
from synth.simulation.random_passes import random_passes
from synth.solver.any_time.polynomial_surfaces import CUBIC_AND_SLOPE, PolynomialSurfaces
from synth.solver.tabulate import UNPREDICTED, tabulate
from synth.studies.any_time.findings import Ways
from synth.studies.any_time.stuck_valves import NOTHING, STUCK, StuckLoop, StuckValves, where_stuck
from synth.studies.any_time.wrong_plants import waiting_table, with_a_silent_gauge
from tests.synth.any_time.tabled import ORIGIN, tabled
from tests.synth.any_time.test_loop import falling_lines
from tests.synth.any_time.test_slow_passes import SAME_M_S, SlowPass
from tuning_tables import ControllerTable

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


class SlowStuckPass(SlowPass):
    """The slow pass with valves that do not open between two times of its own clock."""

    def __init__(self, plant: Plant, draws: Draws, i: int, stuck: StuckValves, start_s: float) -> None:
        super().__init__(plant, draws.cut_factor[i], draws.resistance_n_kn[i], draws.entry_m_s[i])
        self.stuck, self.start_s, self.begun = stuck, start_s, False

    def at_sample(self, time_s: float) -> None:
        """Valves get stuck, or free, at samples alone."""
        begun = self.start_s <= time_s < self.start_s + self.stuck.duration_s
        if self.begun and not begun and self.shut():
            self.flow = 0
            self.command(self.wanted_kpa)  # from rest: the whole delay
        self.begun = begun

    def shut(self) -> bool:
        """Whether the valve that is wanted does not open."""
        return (self.flow > 0 and self.stuck.filling) or (self.flow < 0 and self.stuck.release)

    def step(self, dt: float) -> None:
        """As for sound valves, unless the valve wanted is stuck: the motion goes on alone."""
        if self.begun and self.shut():
            flow, wait_s, self.flow = self.flow, self.wait_s, 0
            super().step(dt)
            self.flow, self.wait_s = flow, wait_s
        else:
            super().step(dt)


def sound_samples(plant: Plant, believed_kpa: float, wanted_kpa: float) -> int:
    """Sampling periods that sound valves need from a pressure at rest to a stage."""
    history = plant.position.pneumatics.respond(believed_kpa, wanted_kpa, plant.position.force.touch_pressure_kpa)
    return max(1, math.ceil((plant.sensor.computing_delay_s + history.duration_s) / 0.1 - 1e-9))


def slow_exit(
    cut: SlowStuckPass, lines: PolynomialSurfaces, way: Ways, first_s: float, z: np.ndarray
) -> tuple[float, int]:
    """Exit speed and number of commands of a pass."""
    plant, stage, commands, rests_at, believed_kpa = cut.plant, 0, 0, 0, 15.0
    stages, band = plant.position.stage_pressures_kpa, plant.position.pneumatics.dead_band_kpa
    cut.go_on(first_s)
    for sample in range(400):
        if cut.s >= plant.exit_m or cut.v <= 0.0:
            break
        cut.at_sample(first_s + 0.1 * sample)
        waits = abs(cut.kpa - stages[stage]) > band + 1e-9 if way is Ways.GAUGE else sample < rests_at
        if not waits or way is Ways.ANY_TIME:
            measured = max(0.0, cut.v + plant.sensor.noise_m_s * float(z[sample]))
            u, x = 2.0 * cut.s / plant.exit_m - 1.0, (cut.kpa - stages[stage]) / 100.0
            lower, upper = (
                float(np.polynomial.legendre.legval(u, a[:4]) + x * a[4]) for a in lines.coefficients[stage]
            )
            step = int(lines.has_line[stage, 1] and measured > upper) - int(
                lines.has_line[stage, 0] and measured < lower
            )
            stage, commands = stage + step, commands + abs(step)
            if step:
                rests_at = sample + sound_samples(plant, believed_kpa, stages[stage])
                believed_kpa = stages[stage] - step * band
        cut.go_on(plant.sensor.computing_delay_s)
        cut.command(stages[stage])
        cut.go_on(plant.sensor.sample_period_s - plant.sensor.computing_delay_s)
    return max(cut.v, 0.0), commands


@pytest.mark.parametrize("way", Ways)
@pytest.mark.parametrize("stuck", STUCK, ids=lambda stuck: stuck.name)
def test_slow_passes_are_those_of_the_kernel(plant: Plant, stuck: StuckValves, way: Ways) -> None:
    smooth = replace(
        plant,
        friction=replace(plant.friction, path_std=0.0),
        sensor=replace(plant.sensor, resolution_m_s=0.0),
    )
    loop, lines = close_loop(smooth, 3), surfaces(smooth, 0.06)
    draws = loop.draws(random_passes(31, 0, 10))
    starts_s = np.linspace(0.2, 3.0, 10)
    found = StuckLoop(loop, tabled(smooth, lines), way).run(draws, stuck, starts_s)
    same = 0
    for i in range(10):
        cut = SlowStuckPass(smooth, draws, i, stuck, starts_s[i])
        speed, commands = slow_exit(cut, lines, way, float(draws.first_sample_s[i]), draws.noise_z[i])
        if commands == found.switchings[i]:
            same += 1
            # Energies, as a cut that has almost stopped makes any error of them a large one of its speed.
            assert speed**2 == pytest.approx(found.exit_speed_m_s[i] ** 2, abs=2.0 * 3.0 * SAME_M_S)
    assert same >= 9  # a speed within a millimetre of a line may fall on either side


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
    assert min(way.rms_m_s for way in for_good.ways.values()) > 2.0 * ours.rms_m_s


def test_an_estimator_or_a_table_at_rest_is_refused(plant: Plant, loop: ClosedLoop, lines: LineController) -> None:
    with pytest.raises(ValueError, match="stuck valves"):
        StuckLoop(loop, replace(lines, lead_s=0.5), Ways.ANY_TIME).law()
    with pytest.raises(ValueError, match="stuck valves"):
        StuckLoop(loop, TableController(waiting_table(surface_table(plant, 0.06))), Ways.TIMES).law()


def test_a_silent_gauge_asks_the_lines_at_the_stages_pressure(plant: Plant, lines: LineController) -> None:
    passes = common_passes(plant, random_passes(15, 0, 400))
    with_slope, without = (surface_table(plant, slope) for slope in (0.06, 0.0))
    found = with_a_silent_gauge(3.0, with_slope, lines, passes)
    flat = with_a_silent_gauge(3.0, without, lines, passes)
    assert found == flat
    assert found.gain.value == pytest.approx(found.waiting.value / found.going_on.value)
    assert found.gain.value != 1.0
