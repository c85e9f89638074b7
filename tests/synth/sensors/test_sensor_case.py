"""Cases with point sensors, and their pictures.

What a tune for point sensors says of brake power, of passages, and of the limits of a configuration.
Pictures of tables for point sensors: columns show what the rule does, and every picture is drawn twice alike.
"""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from matplotlib.figure import Figure
from matplotlib.text import Text

from plant_models import every_axle
from plant_models.point_sensors import Axles
from synth.frame.picture.house_style import draw
from synth.retarder.acceptance import CaseVerdict, judge_case
from synth.retarder.configuration.settings import AcceptanceSettings
from synth.retarder.sensors.sensor_case import (
    HeardShares,
    SensorCase,
    SensorPasses,
    full_brake,
    heard_shares,
    sensor_passes,
    unavoidable,
)
from synth.retarder.sensors.table_pictures import (
    colour_of,
    columns_m,
    passes_figure,
    switching_speeds,
    wanted_edges_m_s,
)
from synth.retarder.served_class import highest_stage
from synth.simulation.exit_statistics import BrakePower, UnavoidableError, exit_statistics
from synth.simulation.passage_controller import (
    DECIDED,
    NO_DECISION,
    NOT_BELIEVED,
    NOT_HEARD,
    UNFINISHED,
    PassageSample,
    PassageTrace,
    PassReadings,
)
from synth.simulation.passes import ExitSample
from synth.simulation.random_passes import random_passes
from synth.solver.descent import Descent
from synth.solver.exit_density import ExitDensity
from synth.solver.passage_speeds import PassageSpeeds
from tests.controller_code.passage_tables import passage_table
from tests.synth.conftest import pilot_plant
from tests.synth.simulation.passage_cases import SENSORS, braking_rule, holding_rule, with_approach
from tuning_tables.passages.passage_table import PassageTable
from tuning_tables.passages.rule import held_by
from tuning_tables.passages.sensor_layout import DecidesOn
from tuning_tables.programs.at_pulse import wanted_stage

COUNT = 400


@pytest.fixture(scope="module")
def passes() -> SensorPasses:
    """A light cut that may be given stage 2 at the entrance."""
    plant = with_approach(pilot_plant(36.0), 5.0, entrance_stage=2)
    return sensor_passes(plant, SENSORS, random_passes(1, 0, COUNT))


def test_full_brake_goes_to_the_highest_stage_allowed_at_once(passes: SensorPasses) -> None:
    top = passes.loop.plant.top_stage
    for index in range(5):
        found = passes.trace(full_brake(passes.loop), index, 1.0)
        read = found.readings
        assert (read.outcome == DECIDED)[0]
        assert read.stage[0] == 2  # as much as may be given before the entrance
        behind = found.path_m > SENSORS.path_m[1] + SENSORS.base_m
        assert set(found.stage[behind].tolist()) == {top}


@pytest.mark.parametrize("axles", [SENSORS.axles, every_axle])
def test_no_rule_slows_down_a_cut_more_than_full_brake(axles: Axles) -> None:
    plant = with_approach(pilot_plant(66.0), 5.0)  # may be given all stages
    sensors = replace(SENSORS, axles=axles)
    found = sensor_passes(plant, sensors, random_passes(2, 0, COUNT))
    least = found.at_full_brake.exit_speed_m_s
    for rule in (holding_rule(plant, sensors), braking_rule(plant, sensors, 2.0), braking_rule(plant, sensors, 4.0)):
        assert (found.run(rule).exit_speed_m_s >= least - 1e-9).all()


def exits(speeds_m_s: np.ndarray) -> ExitSample:
    """Cuts that left with these speeds."""
    n = len(speeds_m_s)
    return ExitSample(speeds_m_s, speeds_m_s == 0.0, np.zeros(n, np.int32), np.ones(n), np.ones(n))


def test_what_no_table_can_avoid_is_the_excess_of_the_slower_of_two(passes: SensorPasses) -> None:
    """The table is slower in every other pass; nothing brakes cuts that are released."""
    braked, free = passes.at_full_brake.exit_speed_m_s, passes.released.exit_speed_m_s
    assert (passes.released.switchings == 0).all()
    assert (free > braked).all()
    slower = np.where(np.arange(COUNT) % 2 == 0, braked - 0.3, braked + 0.3)
    target = float(np.median(braked)) - 0.1
    found = unavoidable(passes, exits(slower), target)
    excess = np.maximum(np.minimum(slower, braked) - target, 0.0)
    assert found.rms_m_s == pytest.approx(math.sqrt(float(np.mean(excess**2))))
    assert found.rms_ci95_m_s[0] <= found.rms_m_s <= found.rms_ci95_m_s[1]
    assert found.too_fast
    too_slow = unavoidable(passes, exits(slower), 9.0)
    assert too_slow.rms_m_s == pytest.approx(math.sqrt(float(np.mean((9.0 - free) ** 2))))
    assert not too_slow.too_fast


def test_shares_are_of_the_cuts_that_come_to_a_passage() -> None:
    first = np.resize([DECIDED, UNFINISHED, DECIDED, NOT_BELIEVED], 400)
    last = np.resize([NOT_HEARD, NOT_HEARD, NO_DECISION, DECIDED], 400)
    never = np.full(400, NOT_HEARD)
    outcome = np.stack([first, last, never], axis=1).astype(np.uint8)
    sample = PassageSample(**vars(exits(np.full(400, 2.0))), outcome=outcome)
    found = heard_shares(sample)
    assert [share for share, _ in found.mistaken[:2]] == pytest.approx([0.25, 0.5])
    assert found.unfinished[0][0] == pytest.approx(1.0 / 3.0)  # of those that were believed
    assert math.isnan(found.mistaken[2][0])
    assert math.isnan(found.unfinished[2][0])


def case(spread_m_s: float, least: float, ci95: tuple[float, float]) -> SensorCase:
    """A case with normal errors, predicted as simulated."""
    error = spread_m_s * np.random.default_rng(7).standard_normal(4000)
    table = passage_table(target_m_s=2.5)
    found = exit_statistics(exits(2.5 + error), 2.5)
    return SensorCase(
        label="made",
        plant=with_approach(pilot_plant(22.0), 5.0),
        table=replace(table, predicted=replace(table.predicted, rms_m_s=found.rms_m_s)),
        predicted=ExitDensity(np.array([0.0, 2.5]), np.array([0.0, 1.0]), 0.0, 0.0, 4.0),
        polish=Descent(PassageSpeeds(np.zeros((1, 2, 1))), 1.0, 0.5, 9, True, "done"),
        exit_speeds_m_s=(2.5 + error).astype(np.float32),
        exit_weight=np.ones(4000),
        statistics=found,
        brake_power=BrakePower(0.0, (0.0, 0.001), found.rms_m_s, found.rms_ci95_m_s),
        unavoidable=UnavoidableError(least, ci95, too_fast=True),
        heard=HeardShares((), (), (), ()),
        traces=(),
    )


LIMITS = AcceptanceSettings(rms_m_s=0.1)


def verdict(spread_m_s: float, least: float = 0.0, ci95: tuple[float, float] = (0.0, 0.0)) -> CaseVerdict:
    """That on a case."""
    return judge_case(case(spread_m_s, least, ci95), LIMITS)


def test_a_case_is_judged_by_the_limits_unless_the_brake_alone_misses_them() -> None:
    assert verdict(0.08).word == "accepted"
    assert verdict(0.13).word == "missed"
    assert verdict(0.10).word == "not decidable"
    assert verdict(0.13, 0.06, (0.05, 0.07)).word == "missed"  # there is brake enough
    short = verdict(0.3, 0.12, (0.11, 0.13))
    assert (short.word, short.obstacle) == ("infeasible", "brake saturated")
    unsure = verdict(0.3, 0.1, (0.09, 0.11))
    assert unsure.word == "not decidable"
    assert "too near to the limit to tell whether the case is feasible" in unsure.judgement.undecided[-1]
    assert verdict(0.08, 0.1, (0.09, 0.11)).word == "accepted"


def test_warnings_tell_of_a_polish_cut_short_and_of_escaped_probability() -> None:
    plain = case(0.08, 0.0, (0.0, 0.0))
    assert plain.warnings == ()
    doubtful = replace(
        plain,
        polish=replace(plain.polish, converged=False, status="Iteration limit reached"),
        predicted=replace(plain.predicted, escaped=1e-3),
    )
    assert "Iteration limit reached" in doubtful.warnings[0]
    assert "lower grid.speed_step_m_s" in doubtful.warnings[1]


FIRST = passage_table()
EVERY = passage_table(decides_on=DecidesOn.EVERY_AXLE)
WINDOW_M_S = (0.0, 12.0)


@given(data=st.data(), v=st.floats(0.015625, 11.5, width=32))
def test_a_column_shows_the_stage_that_the_rule_wants(data: st.DataObject, v: float) -> None:
    passage = data.draw(st.integers(0, len(FIRST.passages) - 1))
    stage = data.draw(st.integers(0, len(FIRST.pressure_kpa) - 1))
    edges = wanted_edges_m_s(FIRST, passage, stage, WINDOW_M_S)
    wanted = wanted_stage(held_by(FIRST), passage, stage, v)
    assert edges[wanted] <= v <= edges[wanted + 1]
    assert (np.diff(edges) >= 0.0).all()


@pytest.mark.parametrize("table", [FIRST, EVERY], ids=["first axle", "every axle"])
def test_columns_hold_their_passages_and_do_not_meet(table: PassageTable) -> None:
    columns = columns_m(table)
    for (left, right), path_m in zip(columns, table.path_m, strict=True):
        assert left <= path_m <= right
    assert all(one[1] <= other[0] for one, other in pairwise(columns))


def test_stages_above_the_highest_are_never_asked_for() -> None:
    top = highest_stage(FIRST)
    speeds = (0.5, 3.0, 6.0, 20.0)
    asked = {
        wanted_stage(held_by(FIRST), passage, stage, v)
        for passage in range(len(FIRST.passages))
        for stage in range(top + 1)
        for v in speeds
    }
    assert max(asked) <= top


def test_colours_tell_direction_and_distance() -> None:
    assert len({colour_of(wanted, 2, 4) for wanted in range(5)}) == 5
    assert colour_of(3, 2, 4) == colour_of(1, 0, 4)  # as far away, in the same direction


def trace() -> PassageTrace:
    """A pass that brakes once, made by hand: the second reading came too early, the third was of no deciding axle."""
    time = np.array([0.0, 1.0, 2.0, 6.0])
    readings = PassReadings(
        time_s=np.array([0.5, 1.5, 2.5]),
        middle_s=np.array([0.4, 1.4, 2.4]),
        told_sensor=np.array([0, 1, 1]),
        passage=np.array([0, 1, 2]),
        believed=np.array([0, 1, 2]),
        reading_m_s=np.array([5.0, 4.6, 4.4]),
        outcome=np.array([DECIDED, UNFINISHED, 4], dtype=np.uint8),
        stage=np.array([2, 2, 2]),
    )
    return PassageTrace(
        time_s=time,
        path_m=np.array([-4.0, 1.0, 6.0, 37.45]),
        speed_m_s=np.array([5.0, 4.8, 4.2, 2.4]),
        overpressure_kpa=np.array([0.0, 250.0, 250.0, 0.0]),
        stage=np.array([0, 2, 2, 0]),
        measured_m_s=np.full(4, np.nan),
        stalled=False,
        readings=readings,
    )


FIGURES = {
    "switching speeds": lambda: switching_speeds("лёгкая-23t", [FIRST, FIRST], [(trace(),), ()]),
    "of every axle": lambda: switching_speeds("лёгкая-23t", [EVERY], []),
    "of two stages": lambda: switching_speeds("two", [passage_table(stages=2)], [()]),
    "passes": lambda: passes_figure("лёгкая-23t", FIRST, (trace(), trace())),
    "no passes": lambda: passes_figure("лёгкая-23t", FIRST, ()),
}


@pytest.mark.long
@pytest.mark.parametrize("name", FIGURES)
def test_a_figure_is_drawn_twice_alike_and_holds_its_text(name: str) -> None:
    assert draw(FIGURES[name]()) == draw(FIGURES[name]())
    figure: Figure = FIGURES[name]()
    draw(figure)
    width, height = figure.get_size_inches() * figure.dpi
    children = [part for axes in figure.axes for part in (*axes.get_children(), axes.xaxis.label, axes.yaxis.label)]
    for text in (*figure.texts, *(part for part in children if isinstance(part, Text))):
        box = text.get_window_extent()
        if text.get_text():
            assert min(box.x0, box.y0, width - box.x1, height - box.y1) > -1.0, text


def test_only_readings_at_which_could_be_decided_are_marked() -> None:
    speed_panel = passes_figure("x", FIRST, (trace(),)).axes[0]
    marks = [line for line in speed_panel.lines if line.get_linestyle() == "None" and line.get_marker() == "o"]
    shown = {str(line.get_fillstyle()): np.asarray(line.get_xydata()).tolist() for line in marks}
    assert shown == {"full": [[FIRST.heard_path_m[0], 5.0]], "none": [[FIRST.heard_path_m[1], 4.6]]}
