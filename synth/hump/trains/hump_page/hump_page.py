"""The page itself: one file that loads nothing, with plan, train, style and the program that plays them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from importlib.resources import files
from typing import Any, Final

from plant_models.library.hump_entry import HumpEntry
from plant_models.library.weight_category import WeightCategory
from synth.frame.page.markup import Markup, element
from synth.frame.page.scripted_document import SPEED_UNITS, scripted_document
from synth.frame.picture.category_colour import category_colour
from synth.hump.configuration.coupling_limits import CouplingLimits
from synth.hump.trains.hump_page.plan_data import plan_data
from synth.hump.trains.hump_page.train_data import train_data
from synth.hump.trains.train_trace import TrainTrace

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
