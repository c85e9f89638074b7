"""Rows of a log: pressure, released drives, and a path in parts.

The pressure along logged passes against the pressure histories of the drive.
A drive that is open to the air when released: recognised from its log, and then no number is off by it.
A path that treadles set right within the passes: the numbers stay what they are without.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from plant_models.library.catalogue import load_position
from plant_models.pressure_regulator import PressureGauge
from plant_models.valve_drive import ValveDrive
from scripts.studies.identification import GAUGE, TRUTHS, Truth, Yard
from synth.kernels.measured.drive_rows import Commands, drive_rows
from synth.logs import unknowns as asked
from synth.logs.estimate import posterior
from synth.logs.fitting_passes import FittingPasses, fitting_passes, released_drive_vents
from synth.logs.identify_shown import log_sentences
from synth.logs.likelihood import pass_rows
from synth.logs.unknowns import unknowns_of
from tuning_tables.pass_log.pass_log import PassLog

POSITION = load_position("knp-5-bunch").position
TOUCH = POSITION.force.touch_pressure_kpa
DELAY_S, PERIOD_S, PARTS = 0.02, 0.1, 4


def driven(
    stage: list[int], settled: bool = False, released: ValveDrive | None = None
) -> tuple[np.ndarray, np.ndarray]:
    """Pressures at rows a tenth of a second apart, and mean overpressures between them."""
    n = len(stage)
    over, kpa = np.empty((n, PARTS)), np.empty(n)
    levels = np.asarray(POSITION.stage_pressures_kpa)
    commands = Commands(
        np.arange(n, dtype=np.float64) * PERIOD_S, np.array(stage), np.array([0, n]), 0, levels, DELAY_S, settled
    )  # fmt: skip
    valves = POSITION.pneumatics.valves(TOUCH)
    drive_rows(commands, valves, valves if released is None else released, 0, 1, over, kpa)
    return kpa, over


@pytest.mark.parametrize("way", [(0, 1, 2), (0, 2, 1), (0, 4, 0), (0, 3, 4)])
def test_commands_at_rest_follow_the_histories(way: tuple[int, int, int]) -> None:
    stage = [way[0]] * 5 + [way[1]] * 25 + [way[2]] * 25
    kpa, over = driven(stage)
    levels, drive = POSITION.stage_pressures_kpa, POSITION.pneumatics
    first = drive.respond(levels[0] + drive.dead_band_kpa, levels[way[1]], TOUCH)
    second = drive.respond(first.end_kpa, levels[way[2]], TOUCH)
    for history, at in ((first, 5), (second, 30)):
        since = np.arange(20, dtype=np.float64) * PERIOD_S - DELAY_S
        np.testing.assert_allclose(kpa[at + 1 : at + 20], history.pressure_kpa(since[1:]), atol=1e-9)
        edges = np.arange(1, 21, dtype=np.float64) * PERIOD_S - DELAY_S
        total = history.overpressure_integral(edges, TOUCH)
        np.testing.assert_allclose(PERIOD_S * over[at + 1 : at + 20].mean(axis=1), np.diff(total), atol=1e-9)


def test_settled_commands_pay_their_delay_whatever_the_drive_does() -> None:
    """The second command comes while the pressure still falls: it goes on at once, unless it must have been at rest."""
    stage = [0] * 3 + [4] * 20 + [3] + [2] * 20
    under_way, _ = driven(stage)
    at_rest, _ = driven(stage, settled=True)
    assert under_way[24] == pytest.approx(at_rest[24])
    assert at_rest[25] > under_way[25] + 15.0
    assert at_rest[-1] == pytest.approx(under_way[-1])


@pytest.mark.parametrize(("above", "edge"), [(2, -1.0), (3, 1.0)])
def test_a_released_drive_that_is_open_to_the_air_goes_on_to_zero(above: int, edge: float) -> None:
    """By the exponential of the exhaust, also where the dead band would have shut the valve, from either
    edge of the dead band above; and fills from there."""
    drive = POSITION.pneumatics
    stage = [0] * 5 + [above] * 10 + [2] * 5 + [0] * 45 + [2] * 15
    kpa, over = driven(stage, released=drive.valves(TOUCH)._replace(band_kpa=1e-3))
    assert kpa[:6] == pytest.approx(1e-3)
    top = POSITION.stage_pressures_kpa[2] + edge * drive.dead_band_kpa
    since = np.arange(45, dtype=np.float64) * PERIOD_S - DELAY_S - drive.release_delay_s
    expected = top * np.exp(-np.maximum(since, 0.0) / drive.exhaust_time_constant_s)
    np.testing.assert_allclose(kpa[20:65], np.maximum(expected, 1e-3), atol=1e-9)
    again = drive.respond(1e-3, POSITION.stage_pressures_kpa[2], TOUCH)
    edges = np.arange(1, 15, dtype=np.float64) * PERIOD_S - DELAY_S
    np.testing.assert_allclose(kpa[66:], again.pressure_kpa(edges), atol=1e-9)
    total = again.overpressure_integral(edges, TOUCH)
    np.testing.assert_allclose(PERIOD_S * over[66:-1].mean(axis=1), np.diff(total), atol=1e-9)


AIR_KPA = 15.0
OPEN = Truth(
    "open to the air",
    f"""
[retarder]
stage_pressures_kpa = [0.1, {150 + AIR_KPA}, {300 + AIR_KPA}, {450 + AIR_KPA}, {600 + AIR_KPA}]
[retarder.pneumatics]
supply_pressure_kpa = {700 + AIR_KPA}
exhaust_pressure_kpa = {AIR_KPA}
[retarder.force]
touch_pressure_kpa = {50 + AIR_KPA}
""",
    GAUGE,
)
"""The assumed plant on a scale on which the air has the pressure of its dead band: only there our drive exhausts to the
air, because the edge of the dead band of stage 0 lies at it."""


@pytest.fixture(scope="module")
def vented(yard: Yard) -> FittingPasses:
    """80 passes, on the scale of the assumed plant again."""
    log = yard.passes(OPEN, 80, 7).log
    return fitting_passes(replace(log, pressure_kpa=log.pressure_kpa - AIR_KPA), yard.config.plants(), "test")


def vents(log: PassLog, passes: FittingPasses) -> bool:
    position = passes.plant.position
    return released_drive_vents(log, position.stage_pressures_kpa, position.pneumatics)


def test_both_kinds_of_drive_are_recognised(passes: FittingPasses, vented: FittingPasses) -> None:
    assert vented.released_vents
    assert not passes.released_vents
    for each in (passes, vented):
        for first in range(0, 80, 20):
            assert vents(each.log.taken(np.arange(first, first + 20)), each) == each.released_vents


def test_without_readings_nothing_is_said(vented: FittingPasses) -> None:
    blind = replace(vented.log, pressure_kpa=np.full(len(vented.log.time_s), np.nan))
    assert not vents(blind, vented)
    assert not vents(vented.log.taken([0]), vented)


def one_step(passes: FittingPasses, yard: Yard) -> dict[str, float]:
    """From the true numbers to the most likely ones, by one step, in standard errors."""
    unknowns = unknowns_of(passes, yard.config.parameters)
    keys = tuple(unknown.key for unknown in unknowns)
    truth = TRUTHS[0].values(keys)
    u = np.array([unknown.standing(truth[unknown.key]) for unknown in unknowns])
    there = posterior(passes, unknowns, 2).linearised(u)
    covariance = np.linalg.inv(np.eye(len(u)) + there.information)
    step = covariance @ (there.scores.sum(axis=0) - u) / np.sqrt(np.diag(covariance))
    return dict(zip(keys, step.tolist(), strict=True))


def test_dead_band_and_noise_are_those_of_the_drive(vented: FittingPasses, yard: Yard) -> None:
    right = one_step(vented, yard)
    wrong = one_step(replace(vented, released_vents=False), yard)
    for key in (asked.DEAD_BAND, asked.GAUGE_NOISE):
        assert abs(right[key]) < 4.0
        assert abs(wrong[key]) > 10.0


@pytest.mark.parametrize("noise_kpa", [0.0, 10.0])
def test_noise_of_the_gauge_does_not_mislead(noise_kpa: float, passes: FittingPasses, vented: FittingPasses) -> None:
    z = np.random.default_rng(3).standard_normal(len(vented.log.time_s))
    for each in (passes, vented):
        z = np.resize(z, len(each.log.time_s))
        shown = PressureGauge(noise_kpa, 5.0).reading_kpa(each.log.pressure_kpa, z)
        assert vents(replace(each.log, pressure_kpa=shown), each) == each.released_vents


TREADLE_M = 12.0


def set_right(log: PassLog, off_m: float) -> PassLog:
    """Its path is `off_m` too far until the treadle, and right behind it."""
    return replace(log, path_m=np.where(log.path_m < TREADLE_M, log.path_m + off_m, log.path_m))


def log_start(log: PassLog) -> float:
    """Ahead of all passes."""
    return float(log.path_m.min())


@pytest.mark.parametrize("off_m", [0.2, -0.2])
def test_steps_are_those_of_the_cut(passes: FittingPasses, off_m: float) -> None:
    true, parted = pass_rows(passes), pass_rows(replace(passes, log=set_right(passes.log, off_m)))
    assert np.max(np.abs(parted.step_m - true.step_m)) < 0.03
    met = set_right(passes.log, off_m).path_m != passes.log.path_m
    alone = np.add.reduceat(met, passes.log.first_row[:-1]) == np.diff(passes.log.first_row)
    assert (np.isfinite(parted.show_m_s) == alone).all()


def test_a_path_that_counts_too_much_says_nothing_wrong_of_the_sensor(passes: FittingPasses) -> None:
    """2 % too much from each treadle to the next; between the first and the last the path is known."""
    treadles_m = (0.0, 8.0, 16.0, 24.0)
    log, last = passes.log, np.full(len(passes.log.path_m), log_start(passes.log))
    for at in treadles_m:
        last = np.where(log.path_m >= at, at, last)
    counted = last + 1.02 * (log.path_m - last)
    true, parted = pass_rows(passes), pass_rows(replace(passes, log=replace(log, path_m=counted)))
    both = np.isfinite(parted.show_m_s)
    assert both.mean() > 0.9
    assert abs(np.mean((parted.show_m_s - true.show_m_s)[both])) < 0.005
    known = (log.path_m > 8.5) & (log.path_m < 15.0)
    assert np.max(np.abs(parted.step_m - true.step_m)[known]) < 0.002


@pytest.mark.parametrize("off_m", [0.2, -0.2])
def test_the_numbers_are_those_without(passes: FittingPasses, yard: Yard, off_m: float) -> None:
    """By one step from the true numbers each: it moves by less than its standard error."""
    unknowns = unknowns_of(passes, yard.config.parameters)
    truth = TRUTHS[0].values(tuple(unknown.key for unknown in unknowns))
    u = np.array([unknown.standing(truth[unknown.key]) for unknown in unknowns])
    steps = []
    for each in (passes, replace(passes, log=set_right(passes.log, off_m))):
        there = posterior(each, unknowns, 2).linearised(u)
        covariance = np.linalg.inv(np.eye(len(u)) + there.information)
        steps.append(covariance @ (there.scores.sum(axis=0) - u) / np.sqrt(np.diag(covariance)))
    assert np.max(np.abs(steps[1] - steps[0])) < 1.0


def test_it_is_told_with_the_number(passes: FittingPasses) -> None:
    values = TRUTHS[0].values(())
    assert list(log_sentences(passes, values)) == []
    (told,) = log_sentences(replace(passes, log=set_right(passes.log, 0.2)), values)
    met = sum(bool((passes.log.path_m[passes.log.rows(i)] > TREADLE_M).any()) for i in range(len(passes)))
    assert told.startswith(f"The path was set anew {met} times, in {met} of 80 passes, by 0.2")
