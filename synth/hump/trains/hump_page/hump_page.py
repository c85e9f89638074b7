"""The page itself: one file that loads nothing, with plan, train, style and the program that plays them."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from importlib.resources import files
from typing import Any, Final

from plant_models.library.hump_entry import HumpEntry
from plant_models.library.weight_category import WeightCategory
from synth.frame.page.markup import Markup, element
from synth.frame.page.page_style import STYLE
from synth.frame.picture.category_colour import category_colour
from synth.hump.configuration.coupling_limits import CouplingLimits
from synth.hump.trains.hump_page.plan_data import plan_data
from synth.hump.trains.hump_page.train_data import train_data
from synth.hump.trains.train_trace import TrainTrace

PLAYER: Final = "hump.html"
"""The name of its file."""

POLICY: Final = "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; img-src data:"
"""The browser itself keeps the page from loading anything."""

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
    head = element(
        "head",
        element("meta", charset="utf-8"),
        Markup(f'<meta http-equiv="Content-Security-Policy" content="{POLICY}">'),
        element("meta", name="viewport", content="width=device-width, initial-scale=1"),
        element("title", f"{title}: {humps}"),
        element("style", Markup(STYLE + "\n" + text_of("player.css"))),
    )
    body = element(
        "body",
        element("h1", title),
        element("p", humps, class_="meta"),
        Markup(text_of("player.html")),
        element("script", Markup(script_safe(data)), id="data", type="application/json"),
        *(element("script", Markup(text_of(name))) for name in SCRIPTS),
    )
    return f"<!DOCTYPE html>\n{element('html', head, body, lang='en')}\n"


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


def script_safe(data: object) -> str:
    """JSON in which nothing can end the script element that holds it."""
    text = json.dumps(data, ensure_ascii=True, separators=(",", ":"), allow_nan=False)
    return text.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026")


def text_of(name: str) -> str:
    """A part of the page that is kept as a file beside this one."""
    return files("synth.hump.trains.hump_page").joinpath(name).read_text(encoding="utf-8")
