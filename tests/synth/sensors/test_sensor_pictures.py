"""Pictures of tables for point sensors: columns show what the rule does, and every picture is drawn twice alike."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from matplotlib.figure import Figure
from matplotlib.text import Text

from synth.frame.picture.figure_file import draw
from synth.retarder.highest_stage import highest_stage
from synth.retarder.sensors.pictures.passes_with_readings import passes_figure
from synth.retarder.sensors.pictures.switching_speeds import colour_of, columns_m, switching_speeds, wanted_edges_m_s
from synth.simulation.passage_sample import DECIDED, UNFINISHED, PassageTrace, PassReadings
from tests.controller_code.passage_tables import passage_table
from tuning_tables.passages.held_passages import held_by
from tuning_tables.passages.passage_table import PassageTable
from tuning_tables.passages.sensor_layout import DecidesOn
from tuning_tables.programs.at_pulse import wanted_stage

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
