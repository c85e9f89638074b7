"""Pictures of humped trains: the same bytes twice, nothing outside the paper, and what they show is what happened."""

from __future__ import annotations

import re

import numpy as np
import pytest
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure
from matplotlib.text import Text

from plant_models.library.hump_entry import load_hump
from synth.frame.picture.figure_file import draw
from synth.hump.trains.outcomes import TrainOutcomes, outcomes
from synth.hump.trains.pictures.catch_ups import catch_ups
from synth.hump.trains.pictures.couplings import couplings
from synth.hump.trains.pictures.element_strip import levels
from synth.hump.trains.pictures.hump_speed_program import PushedTrain, hump_speed_program
from synth.hump.trains.pictures.speed_path import speed_path
from synth.hump.trains.pictures.time_path import time_path
from synth.hump.trains.shown.places import by_element
from synth.hump.trains.train_trace import AlarmKind, TrainTrace, train_trace
from tests.plant_models.rolling.populations import CATEGORIES
from tests.synth.hump.trains.humped_trains import CUTS, TRAINS, HumpedTrains, humped_trains

CATEGORY_TYPES = CATEGORIES.members


@pytest.fixture(scope="module")
def humped() -> HumpedTrains:
    return humped_trains()


@pytest.fixture(scope="module")
def trace(humped: HumpedTrains) -> TrainTrace:
    return train_trace(humped.hump, humped.trains, humped.memory, 0)


@pytest.fixture(scope="module")
def found(humped: HumpedTrains) -> TrainOutcomes:
    return outcomes(humped.hump.routes, humped.trains, humped.memory)


def pushed(trace: TrainTrace) -> PushedTrain:
    """How a traced train was pushed."""
    kept = ((cut.crest_s, cut.hump_speed_m_s, cut.length_m) for cut in trace.cuts)
    return PushedTrain(trace.number, *map(np.array, zip(*kept, strict=True)))


@pytest.fixture(scope="module")
def figures(humped: HumpedTrains, trace: TrainTrace, found: TrainOutcomes) -> dict[str, Figure]:
    counts = by_element(humped.hump.routes, found.misrouted)
    return {
        "time_path": time_path(trace),
        "speed_path": speed_path(trace, CATEGORY_TYPES),
        "program": hump_speed_program(pushed(trace)),
        "catch_ups": catch_ups(humped.entry, counts, TRAINS * CUTS, "misroutes"),
        "no catch_ups": catch_ups(humped.entry, {}, TRAINS * CUTS),
        "couplings": couplings(found),
    }


def texts(figure: Figure) -> list[Text]:
    """Every text of a figure."""
    inside = [part for axes in figure.axes for part in axes.get_children() if isinstance(part, Text)]
    return [text for text in (*figure.texts, *inside) if text.get_text()]


def test_no_text_leaves_a_figure(figures: dict[str, Figure]) -> None:
    for name, figure in figures.items():
        draw(figure)
        width, height = figure.get_size_inches() * figure.dpi
        for text in texts(figure):
            box = text.get_window_extent()
            outside = box.x0 < 0 or box.x1 > width or box.y0 < 0 or box.y1 > height
            assert not outside, (name, text.get_text())


def test_the_time_path_diagram_marks_every_meeting_on_its_way(figures: dict[str, Figure], trace: TrainTrace) -> None:
    """As many crosses as misroutes, at their instants; a band for each cut; a box for each occupied element."""
    (axes,) = figures["time_path"].axes
    marks = {"X": AlarmKind.MISROUTED, "o": AlarmKind.CONTACT, "s": AlarmKind.UNSEPARATED}
    for marker, kind in marks.items():
        drawn = sorted(float(line.get_ydata()[0]) for line in axes.lines if line.get_marker() == marker)  # type: ignore[index, arg-type]
        assert drawn == [alarm.time_s for alarm in trace.alarms if alarm.kind is kind]
    patches = [part for part in axes.collections if type(part) is PolyCollection and part.get_clip_on()]
    assert sum(len(part.get_paths()) for part in patches) == len(trace.occupied)
    lines = [line for line in axes.lines if len(line.get_xdata()) > 2]  # type: ignore[arg-type]
    assert len(lines) == len(trace.cuts)


def test_bands_lie_where_the_cuts_were(figures: dict[str, Figure], trace: TrainTrace) -> None:
    (axes,) = figures["time_path"].axes
    lines = [line for line in axes.lines if len(line.get_xdata()) > 2]  # type: ignore[arg-type]
    for line, cut in zip(lines, trace.cuts, strict=True):
        heads, times = (np.asarray(data, dtype=float) for data in (line.get_xdata(), line.get_ydata()))
        np.testing.assert_allclose(cut.trace.head_at(times), heads, atol=0.02)


def test_elements_at_one_place_are_named_together(humped: HumpedTrains) -> None:
    named = {number for level in levels(humped.hump.routes) for number in level.numbers}
    assert named == set(humped.hump.routes.numbers)
    first = next(iter(levels(humped.hump.routes)))
    assert first.numbers == (1,)
    assert {level.name for level in levels(humped.hump.routes)} >= {"1", "401, 402", "421 … 452"}


def test_discs_tell_the_counts(figures: dict[str, Figure], humped: HumpedTrains, found: TrainOutcomes) -> None:
    counts = [count for count in by_element(humped.hump.routes, found.misrouted).values() if count]
    axes = figures["catch_ups"].axes[0]
    inside = [text for text in axes.texts if text.get_verticalalignment() == "center" and text.get_zorder() == 9]
    assert sorted(int(text.get_text()) for text in inside) == sorted(counts)
    assert f"Misroutes: {sum(counts)}," in figures["catch_ups"].texts[1].get_text()
    assert len(figures["no catch_ups"].axes) == 1


def test_the_program_tells_the_mean_of_two_speeds() -> None:
    """Cuts of 20 m at 2, 3 and 2 m/s, pushed at an even rate in between: 40 m in 8 + 8 s."""
    program = PushedTrain(0, np.array([0.0, 8.0, 16.0]), np.array([2.0, 3.0, 2.0]), np.full(3, 20.0))
    assert program.mean_m_s == 2.5
    assert "2.50 m/s, 9.0 km/h; 16 s" in hump_speed_program(program).texts[1].get_text()


def test_the_histograms_hold_every_judged_cut(figures: dict[str, Figure], found: TrainOutcomes) -> None:
    speeds, gaps = figures["couplings"].axes
    heights = [sum(bar.get_height() for bar in axes.patches) for axes in (speeds, gaps)]  # type: ignore[attr-defined]
    assert heights == [found.speed_bins.sum(), found.gap_bins.sum()]
    shown = " ".join(text.get_text() for text in figures["couplings"].legends[0].texts)
    told = [int(count) for count in re.findall(r": (\d+) cuts?,", shown)]
    assert told == found.overspeed.sum(axis=0).tolist()


@pytest.mark.parametrize("name", ["dumper", "large", "large-two-leads", "medium"])
def test_every_hump_of_the_library_can_be_marked(name: str) -> None:
    entry = load_hump(name)
    numbers = {vertex.number: place for place, vertex in enumerate(entry.graph.vertices)}
    draw(catch_ups(entry, numbers, 1000))
