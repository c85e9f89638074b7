"""Traces of trains, and pictures of them.

A traced train is the train that was humped: the same instants, the same meetings, the same ends.
Pictures of humped trains: the same bytes twice, nothing outside the paper, and what they show is what happened.
"""

from __future__ import annotations

import re
from itertools import pairwise

import numpy as np
import pytest
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure
from matplotlib.text import Text

from plant_models.library.hump_entry import load_hump
from synth.aim.configuration.shared_settings import COUPLING_SPEED_M_S
from synth.frame.picture.house_style import draw
from synth.hump.rolling.hump_routes import OF_FIRST_AXLE, Mark
from synth.hump.rolling.outcomes import TrainOutcomes, outcomes
from synth.hump.trains.pictures.outcomes import catch_ups, couplings
from synth.hump.trains.pictures.time_path import levels, time_path
from synth.hump.trains.pictures.train_speeds import PushedTrain, hump_speed_program, speed_path
from synth.hump.trains.shown.figures import by_element
from synth.hump.trains.train_trace import AlarmKind, TracedCut, TrainTrace, body_of, train_trace
from tests.plant_models.rolling.populations import CATEGORIES
from tests.synth.hump.trains.humped_trains import CUTS, FIRST, TRAINS, HumpedTrains, humped_trains

STEP_S = 0.02
"""The trace rolls in steps of a metre, the humping in steps of six: so far instants may differ."""


@pytest.fixture(scope="module")
def humped() -> HumpedTrains:
    return humped_trains()


@pytest.fixture(scope="module")
def traces(humped: HumpedTrains) -> list[TrainTrace]:
    return [train_trace(humped.hump, humped.trains, humped.memory, lane) for lane in range(TRAINS)]


def marks_m(humped: HumpedTrains, lane: int, cut: TracedCut) -> np.ndarray:
    """Where the head is at each mark, (elements, marks), from the lengths alone."""
    row = lane * CUTS + cut.cut
    axle = np.where(OF_FIRST_AXLE, humped.trains.first_axle_m[row], humped.trains.last_axle_m[row])
    return np.asarray(humped.hump.routes.place_m[cut.route] + axle)


def met_s(humped: HumpedTrains, trace: TrainTrace) -> dict[int, float]:
    """When cuts first touched others, or were touched on their track."""
    lane = trace.number - FIRST
    found: dict[int, float] = {}
    for alarm in trace.alarms:
        if alarm.kind in (AlarmKind.CONTACT, AlarmKind.ON_TRACK):
            cuts = body_of(humped.memory, lane, alarm.cut).tolist()
            found.update({cut: min(alarm.time_s, found.get(cut, np.inf)) for cut in cuts})
    return found


def test_the_trains_have_all_that_is_to_be_shown(traces: list[TrainTrace]) -> None:
    kinds = {alarm.kind for trace in traces for alarm in trace.alarms}
    assert kinds >= {AlarmKind.MISROUTED, AlarmKind.CONTACT, AlarmKind.UNSEPARATED, AlarmKind.ON_TRACK}
    assert [trace.number for trace in traces] == list(range(FIRST, FIRST + TRAINS))


def test_times_at_marks_are_those_of_the_memory(humped: HumpedTrains, traces: list[TrainTrace]) -> None:
    """For cuts in contact, up to the element where they touch: from there on the model shifts those of the leader."""
    compared = 0
    for lane, trace in enumerate(traces):
        touched = met_s(humped, trace)
        for cut in trace.cuts:
            told = humped.memory.time_s[lane, cut.cut]
            marks = marks_m(humped, lane, cut)
            traced = np.interp(marks, cut.trace.head_m, cut.trace.time_s, left=np.nan, right=np.nan)
            before = told < touched.get(cut.cut, np.inf) - STEP_S
            before[humped.memory.contact_at[lane, cut.cut] :] = False
            before &= ~(marks > humped.memory.touch_m[lane, cut.cut] - 1e-6)  # it may wait for the tail there
            np.testing.assert_allclose(traced[before], told[before], atol=STEP_S)
            compared += int(before.sum())
            if cut.cut not in touched:
                np.testing.assert_array_equal(np.isfinite(traced), np.isfinite(told))
    assert compared > 0.9 * np.isfinite(humped.memory.time_s).sum() - CUTS


def test_a_trace_goes_forwards_at_its_own_speed(humped: HumpedTrains, traces: list[TrainTrace]) -> None:
    """Metres in each step are the mean of both speeds times its duration, the last bit before a stop
    included; cuts that touch others left out."""
    for trace in traces:
        touched = met_s(humped, trace)
        for cut in trace.cuts:
            way = cut.trace
            steps = np.diff(way.time_s)
            assert (steps > 0.0).all()
            assert (np.diff(way.head_m) >= 0.0).all()
            if cut.cut not in touched:
                rolled = 0.5 * (way.speed_m_s[1:] + way.speed_m_s[:-1]) * steps
                assert np.abs(rolled - np.diff(way.head_m)).max() < 0.05


def test_ends_are_those_of_the_memory(humped: HumpedTrains, traces: list[TrainTrace]) -> None:
    for lane, trace in enumerate(traces):
        for cut in trace.cuts:
            end = humped.memory.end_m[lane, cut.cut]
            if not np.isfinite(end):
                continue
            by_itself = cut.cut not in met_s(humped, trace)
            assert cut.trace.head_m[-1] == pytest.approx(end, abs=1e-6 if by_itself else 5e-3)
            if humped.memory.caught_on_track[lane, cut.cut]:
                continue
            speed = humped.memory.end_speed_m_s[lane, cut.cut]
            assert cut.trace.speed_m_s[-1] == pytest.approx(speed, abs=0.01)


def test_passes_are_those_of_the_memory(humped: HumpedTrains, traces: list[TrainTrace]) -> None:
    memory, routes = humped.memory, humped.hump.routes
    for lane, trace in enumerate(traces):
        touched = {a.cut: a.time_s for a in trace.alarms if a.kind in (AlarmKind.CONTACT, AlarmKind.ON_TRACK)}
        for cut in trace.cuts:
            for position, each in enumerate(cut.passages):
                assert each.command_m_s == memory.command_m_s[lane, cut.cut, position]
                assert each.number in {element.number for element in routes.routes[cut.route].elements}
                if np.isfinite(each.end_s) and each.end_s < touched.get(cut.cut, np.inf):
                    leaves = routes.exit_m[cut.route, position] + humped.trains.last_axle_m[lane * CUTS + cut.cut]
                    assert cut.trace.head_at(np.array(each.end_s)) == pytest.approx(leaves, abs=1e-6)


def test_a_cut_in_contact_stays_behind_the_tail_of_its_leader(traces: list[TrainTrace]) -> None:
    found = 0
    for trace in traces:
        for alarm in trace.alarms:
            if alarm.kind not in (AlarmKind.CONTACT, AlarmKind.ON_TRACK) or alarm.ahead is None:
                continue
            cut, leader = trace.cuts[alarm.cut], trace.cuts[alarm.ahead]
            assert cut.route == leader.route
            times = np.linspace(alarm.time_s, trace.end_s, 200)
            room = leader.trace.head_at(times) - leader.length_m - cut.trace.head_at(times)
            assert room.min() > -0.3
            if alarm.kind is AlarmKind.CONTACT:
                assert room[-1] == pytest.approx(0.0, abs=1.0)
            found += 1
    assert found > 20


def test_elements_that_two_cuts_occupy_are_those_that_the_memory_tells(
    humped: HumpedTrains, traces: list[TrainTrace]
) -> None:
    """The intervals of each element, one cut after the other, against what was judged while the train was humped."""
    routes = humped.hump.routes
    for lane, trace in enumerate(traces):
        both: set[tuple[int, int]] = set()
        for number in routes.numbers:
            users = sorted((o for o in trace.occupied if o.number == number), key=lambda o: o.cut)
            both |= {(behind.cut, number) for ahead, behind in pairwise(users) if behind.from_s < ahead.to_s}
        told = {
            (int(cut), routes.numbers[routes.vertex[trace.cuts[cut].route, column]])
            for cut, column in zip(*np.nonzero(humped.memory.unseparated[lane]), strict=True)
        }
        assert both == told


def test_alarms_and_ends_add_up_to_the_outcomes(humped: HumpedTrains, traces: list[TrainTrace]) -> None:
    found = outcomes(humped.hump.routes, humped.trains, humped.memory)
    for lane, trace in enumerate(traces):
        count = {kind: sum(alarm.kind is kind for alarm in trace.alarms) for kind in AlarmKind}
        assert count[AlarmKind.MISROUTED] == found.misrouted[lane].sum()
        assert count[AlarmKind.CONTACT] == found.contact[lane].sum()
        assert count[AlarmKind.OVERSPEED] == found.overspeed[lane].sum()
        assert sum(cut.gap_m or 0.0 for cut in trace.cuts) == pytest.approx(found.gap_m[lane])
        judged = [cut for cut in trace.cuts if cut.coupled_m_s is not None or cut.gap_m is not None]
        assert len(judged) == found.judged[lane]
        fast = [cut for cut in judged if (cut.coupled_m_s or 0.0) > COUPLING_SPEED_M_S]
        assert len(fast) == count[AlarmKind.OVERSPEED]
        assert trace.mean_hump_speed_m_s == pytest.approx(found.span_m[lane] / found.span_s[lane])


def test_alarms_come_in_order_and_when_they_are_told(humped: HumpedTrains, traces: list[TrainTrace]) -> None:
    for lane, trace in enumerate(traces):
        assert [a.time_s for a in trace.alarms] == sorted(a.time_s for a in trace.alarms)
        for alarm in trace.alarms:
            if alarm.kind is AlarmKind.MISROUTED:
                column = humped.memory.misrouted_at[lane, alarm.cut]
                assert alarm.time_s == humped.memory.time_s[lane, alarm.cut, column, Mark.FIRST_IN]
                assert trace.cuts[alarm.cut].route != trace.cuts[alarm.cut].wanted


CATEGORY_TYPES = CATEGORIES.members


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
