"""The page itself: one file that loads nothing, with plan, train, style and the program that plays them."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from importlib.resources import files

from plant_models.library.hump_entry import HumpEntry
from synth.frame.page.markup import Markup, element
from synth.frame.page.page_style import STYLE
from synth.hump.trains.hump_page.plan_data import plan_data
from synth.hump.trains.hump_page.train_data import train_data
from synth.hump.trains.train_trace import TrainTrace

POLICY = "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; img-src data:"
"""The browser itself keeps the page from loading anything."""


def hump_page(hump: HumpEntry, shown: Mapping[str, TrainTrace], categories: Sequence[str]) -> str:
    """One HTML document: the trains `shown`, by their titles in a menu, on the plan of `hump`; the first of them is
    there when the page is opened. The same trains give the same text."""
    traces = tuple(shown.values())
    used = sorted({row for trace in traces for cut in trace.cuts for row in (cut.route, cut.wanted)})
    routes = {row: traces[0].routes.routes[row] for row in used}
    data = {
        "title": hump.title,
        "plan": plan_data(hump.graph, routes),
        "trains": [{"title": title, **train_data(trace, categories)} for title, trace in shown.items()],
    }
    title = "Trains over the hump" if len(traces) > 1 else f"Train {traces[0].number + 1} over the hump"
    head = element(
        "head",
        element("meta", charset="utf-8"),
        Markup(f'<meta http-equiv="Content-Security-Policy" content="{POLICY}">'),
        element("meta", name="viewport", content="width=device-width, initial-scale=1"),
        element("title", f"{title}: {hump.title}"),
        element("style", Markup(STYLE + "\n" + text_of("player.css"))),
    )
    body = element(
        "body",
        element("h1", title),
        element("p", hump.title, class_="meta"),
        Markup(text_of("player.html")),
        element("script", Markup(script_safe(data)), id="data", type="application/json"),
        element("script", Markup(text_of("player.js"))),
    )
    return f"<!DOCTYPE html>\n{element('html', head, body, lang='en')}\n"


def script_safe(data: object) -> str:
    """JSON in which nothing can end the script element that holds it."""
    text = json.dumps(data, ensure_ascii=True, separators=(",", ":"), allow_nan=False)
    return text.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026")


def text_of(name: str) -> str:
    """A part of the page that is kept as a file beside this one."""
    return files("synth.hump.trains.hump_page").joinpath(name).read_text(encoding="utf-8")
