"""The page that plays trains on the plan of their hump: one file that loads nothing, with plan, trains, style and the
program that plays them.

The plan is metres along, rows across. A train is whole numbers of centimetres, hundredths of seconds, each the
difference to the one before.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from importlib.resources import files
from typing import Any, Final

import numpy as np

from plant_models.frozen_arrays import Floats
from plant_models.hump import HumpGraph, Retarder, Route, Switch, TrackSection
from plant_models.library.hump_entry import HumpEntry
from plant_models.library.weight_category import WeightCategory
from synth.frame.page.document import SPEED_UNITS, scripted_document
from synth.frame.page.markup import Markup, element
from synth.frame.picture.picture import category_colour
from synth.hump.configuration.sections import CouplingLimits
from synth.hump.plan_layout import PlanLayout, plan_layout
from synth.hump.trains.train_trace import Alarm, AlarmKind, TracedCut, TrainTrace

Data = dict[str, Any]


def plan_data(graph: HumpGraph, routes: Mapping[int, Route]) -> Data:
    """What is drawn once; `routes`: those of the cuts, by the numbers that the page knows them by."""
    layout = plan_layout(graph)
    last = max(layout.at[vertex.number][0] for vertex in graph.vertices)
    return {
        "rows": len(layout.row),
        "last_m": rounded(last),
        "end_m": rounded(max(layout.end_m.values())),
        "rails": list(rails(graph, layout)),
        "sections": list(sections(graph, layout)),
        "zones": [zone for each in graph.retarders for zone in zones(each, layout)],
        "switches": [[each.number, *map(rounded, layout.at[each.number])] for each in graph.switches],
        "signals": [[each.number, *map(rounded, layout.at[each.number])] for each in graph.signals],
        "retarders": [[each.number, *map(rounded, layout.at[each.number])] for each in graph.retarders],
        "tracks": [[track, rounded(layout.end_m[track]), row] for track, row in layout.row.items()],
        "called": {str(each.number): graph.called(each.number) for each in graph.vertices},
        "tracks_called": {str(track): graph.track_called(track) for track in layout.row},
        "routes": {str(row): way(route, layout) for row, route in routes.items()},
    }


def rails(graph: HumpGraph, layout: PlanLayout) -> Iterator[list[float]]:
    """Ends of every edge (x, y, x, y); a track's last one goes to its end."""
    for vertex in graph.vertices:
        x, y = layout.at[vertex.number]
        for edge in vertex.edges:
            to_x, to_y = layout.at[edge.to] if edge.to is not None else (x + edge.length_m, y)
            yield [rounded(value) for value in (x, y, to_x, to_y)]


def sections(graph: HumpGraph, layout: PlanLayout) -> Iterator[Data]:
    """The insulated sections, each with its number and its lines."""
    for vertex in graph.vertices:
        if isinstance(vertex, TrackSection) and vertex.is_last:
            continue
        ahead, behind = vertex.section_m
        if behind <= 0.0:
            continue
        x, y = layout.at[vertex.number]
        lines = [[x - ahead, y, x, y]] if isinstance(vertex, Switch) and ahead > 0.0 else []
        for edge in vertex.edges:
            assert edge.to is not None
            lines.append([x, y, *along(layout, vertex.number, edge.to, behind)])
        kind = "switch" if isinstance(vertex, Switch) else "retarder" if isinstance(vertex, Retarder) else "plain"
        yield {"number": vertex.number, "kind": kind, "lines": [[rounded(v) for v in line] for line in lines]}


def zones(retarder: Retarder, layout: PlanLayout) -> Iterator[Data]:
    """The braking zones of a retarder."""
    assert retarder.next.to is not None
    for begin, end in retarder.zones_m:
        ends = (value for place in (begin, end) for value in along(layout, retarder.number, retarder.next.to, place))
        yield {"number": retarder.number, "line": [rounded(value) for value in ends]}


def along(layout: PlanLayout, number: int, to: int, metres: float) -> tuple[float, float]:
    """The place so many metres behind an element on its edge to another."""
    (x, y), (to_x, to_y) = layout.at[number], layout.at[to]
    return x + metres, y + metres * (to_y - y) / (to_x - x)


def way(route: Route, layout: PlanLayout) -> list[list[float]]:
    """(metres of the route, x, y) at each element and at the end."""
    points = [[element.at_m, *layout.at[element.number]] for element in route.elements]
    (m, x, y) = points[-1]
    points.append([route.length_m, x + route.length_m - m, y])
    return [[rounded(value) for value in point] for point in points]


def rounded(value: float) -> float:
    """To a millimetre."""
    return round(float(value), 3)


HUNDREDTHS = 100.0

TOLD = {
    AlarmKind.MISROUTED: "misrouted behind",
    AlarmKind.CONTACT: "in contact with",
    AlarmKind.UNSEPARATED: "not separated from",
    AlarmKind.FOUL: "foul of",
    AlarmKind.ON_TRACK: "coupled on its track, while that rolled, to",
    AlarmKind.OVERSPEED: "coupled too fast",
    AlarmKind.STOPPED: "stopped before its track",
}
"""What stands between the cut and the cut ahead."""


def train_data(trace: TrainTrace) -> Data:
    """Cuts, passes, occupied elements and alarms."""
    return {
        "begin_s": hundredth(min(float(cut.trace.time_s[0]) for cut in trace.cuts)),
        "end_s": hundredth(trace.end_s),
        "mean_hump_speed_m_s": finite(trace.mean_hump_speed_m_s),
        "cuts": [cut_data(trace, cut) for cut in trace.cuts],
        "occupied": [[o.number, o.cut, hundredth(o.from_s), finite(o.to_s)] for o in trace.occupied],
        "alarms": [alarm_data(alarm, trace) for alarm in trace.alarms],
    }


def cut_data(trace: TrainTrace, cut: TracedCut) -> Data:
    """One cut; `t`, `s`, `v`: its samples."""
    return {
        "cars": cut.cars,
        "category": cut.category,
        "mass_t": round(cut.mass_t, 1),
        "length_m": round(cut.length_m, 3),
        "route": str(cut.route),
        "track": trace.routes.routes[cut.route].track,
        "wanted": trace.routes.routes[cut.wanted].track,
        "crest_s": hundredth(cut.crest_s),
        "hump_speed_m_s": hundredth(cut.hump_speed_m_s),
        "free_m": finite(cut.free_m),
        "coupled_m_s": finite(cut.coupled_m_s),
        "gap_m": finite(cut.gap_m),
        "caught_s": caught_s(trace, cut),
        "passes": [
            [p.number, hundredth(p.begin_s), finite(p.end_s), *map(hundredth, (p.entry_m_s, p.command_m_s)),
             hundredth(p.exit_m_s)]
            for p in cut.passages
        ],
        "t": differences(cut.trace.time_s),
        "s": differences(cut.trace.head_m),
        "v": differences(cut.trace.speed_m_s),
    }  # fmt: skip


def caught_s(trace: TrainTrace, cut: TracedCut) -> float | None:
    """When it caught up, as the figures count it: misrouted, or in contact ahead of its last position."""
    at = trace.routes.retarder[cut.route].max()
    last = trace.routes.numbers[trace.routes.vertex[cut.route, at]] if at >= 0 else None
    counted = (
        alarm.time_s
        for alarm in trace.alarms
        if alarm.cut == cut.cut
        and (alarm.kind is AlarmKind.MISROUTED or (alarm.kind is AlarmKind.CONTACT and alarm.number != last))
    )
    return finite(min(counted, default=None))


def alarm_data(alarm: Alarm, trace: TrainTrace) -> Data:
    """One alarm; an instant that never comes is None. `m_s`: the speed that belongs to it."""
    return {
        "kind": alarm.kind.name.lower(),
        "words": words(alarm, trace.routes.graph),
        "m_s": finite(trace.cuts[alarm.cut].coupled_m_s) if alarm.kind is AlarmKind.OVERSPEED else None,
        "severe": alarm.kind.severe,
        "t": finite(alarm.time_s),
        "cut": alarm.cut,
    }


def words(alarm: Alarm, graph: HumpGraph) -> str:
    """'cut 4 in contact with cut 3 at retarder 411'."""
    told = f"cut {alarm.cut + 1} {TOLD[alarm.kind]}"
    if alarm.ahead is not None:
        told += f" cut {alarm.ahead + 1}"
    return told if alarm.number is None else f"{told} at {graph.element_called(alarm.number)}"


def differences(values: Floats) -> list[int]:
    """The first value and the steps to the next ones, in hundredths; sums of them err by half a hundredth at most."""
    whole = np.round(values * HUNDREDTHS).astype(np.int64)
    return [int(step) for step in np.diff(whole, prepend=0)]


def hundredth(value: float) -> float:
    """To two places."""
    return round(float(value), 2)


def finite(value: float | None) -> float | None:
    """To two places; None for what is not known or never comes."""
    return None if value is None or not math.isfinite(value) else hundredth(value)


PLAYER: Final = "hump.html"
"""The name of its file."""

SCRIPTS: Final = ("train_ways.js", "plan_panel.js", "alarms.js", "player.js")


@dataclass(frozen=True)
class PlayedRun:
    """Trains of one run over `hump`, in the order of the menu; `name` tells it from the others, '' where it is alone.

    `categories`: the weight categories in their places. `couplings`: which couplings are too fast.
    """

    name: str
    hump: HumpEntry
    traces: tuple[TrainTrace, ...]
    categories: tuple[WeightCategory, ...]
    couplings: CouplingLimits


def hump_page(title: str, runs: Sequence[PlayedRun], trains: Sequence[str]) -> str:
    """One HTML document: the trains of all `runs` one below the other on one clock, each on the plan of its hump.

    `trains`: what the menu calls them; the first is there when the page is opened. The same trains give the same text.
    """
    data = {"trains": list(trains), "runs": [run_data(run) for run in runs]}
    humps = "; ".join(f"{run.name}: {run.hump.title}" if run.name else run.hump.title for run in runs)
    content = (element("h1", title), element("p", humps, class_="meta"), Markup(text_of("player.html")))
    scripts = [SPEED_UNITS, *(text_of(name) for name in SCRIPTS)]
    return scripted_document(f"{title}: {humps}", text_of("player.css"), content, data, scripts)


def run_data(run: PlayedRun) -> dict[str, Any]:
    """What the page must know of one run."""
    used = sorted({row for trace in run.traces for cut in trace.cuts for row in (cut.route, cut.wanted)})
    routes = {row: run.traces[0].routes.routes[row] for row in used}
    return {
        "name": run.name,
        "plan": plan_data(run.hump.graph, routes),
        "categories": [{"name": each.label, "colour": category_colour(each.number)} for each in run.categories],
        "coupling_limits_m_s": list(run.couplings.classes_m_s),
        "trains": [train_data(trace) for trace in run.traces],
    }


def text_of(name: str) -> str:
    """A part of the page that is kept as a file beside this one."""
    return files("synth.hump.trains.hump_page").joinpath(name).read_text(encoding="utf-8")
