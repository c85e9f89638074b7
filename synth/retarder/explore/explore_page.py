"""The page itself: one file that loads nothing, with tables, plants, style and the program that plays passes."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from importlib.resources import files
from itertools import groupby
from typing import Any, Final

from plant_models import Plant
from synth.frame.page.markup import Markup, element
from synth.frame.page.scripted_document import SPEED_UNITS, scripted_document
from synth.retarder.explore.plant_data import plant_data
from synth.simulation.exit_statistics import OVERSPEED_M_S
from tuning_tables.controller_code.js_rules import JsRules, js_rules
from tuning_tables.table import ControllerTable

PAGE: Final = "explore.html"
"""The name of its file, and of what stands in its body."""

SCRIPTS: Final = (
    "motion.js", "drive.js", "passes.js", "draws.js", "figures.js", "words.js", "chart.js", "pictures.js",
    "controls.js", "explore.js",
)  # fmt: skip


@dataclass(frozen=True)
class PlayedTable:
    """A table and what it brakes: the plant of its class, called `label`, whose cuts weigh from low to high.

    `infeasible`: the tune that made the table calls its case so.
    """

    table: ControllerTable
    label: str
    plant: Plant
    mass_limits_t: tuple[float, float]
    infeasible: bool

    @property
    def title(self) -> str:
        """What the menu calls it."""
        mark = ", infeasible by its tune" if self.infeasible else ""
        return f"{self.label} to {self.table.target_speed_m_s:g} m/s{mark}"


def explore_page(title: str, meta: str, tables: Sequence[PlayedTable]) -> str:
    """One HTML document; `meta`: a line below the title. The same tables give the same text."""
    rules = js_rules([each.table for each in tables])
    data = {"classes": list(class_data(tables, rules)), "overspeed_m_s": OVERSPEED_M_S, "alarms": rules.alarms}
    content = (element("h1", title), element("p", meta, class_="meta"), Markup(part(PAGE)))
    scripts = [rules.text, SPEED_UNITS, *(part(name) for name in SCRIPTS)]
    return scripted_document(f"{title}: play with its tables", part("explore.css"), content, data, scripts)


def class_data(tables: Sequence[PlayedTable], rules: JsRules) -> Iterator[dict[str, Any]]:
    """What the page must know of each class, with those of its tables that follow each other."""
    held = {id(each): values for each, values in zip(tables, rules.tables, strict=True)}
    for (_, stages), played in groupby(tables, key=lambda each: (each.label, len(each.table.stages))):
        together = list(played)
        first = together[0]
        plant = plant_data(first.plant, first.mass_limits_t, stages)
        yield {"plant": plant, "tables": [{**table_data(each), "held": held[id(each)]} for each in together]}


def table_data(played: PlayedTable) -> dict[str, Any]:
    """What the page tells of a table."""
    table, checked = played.table, played.table.validated
    return {
        "id": table.id,
        "title": played.title,
        "target_m_s": table.target_speed_m_s,
        "predicted": vars(table.predicted),
        "validated": None if checked is None else vars(checked),
    }


def part(name: str) -> str:
    """A part of the page that is kept as a file beside this one."""
    return files("synth.retarder.explore").joinpath(name).read_text(encoding="utf-8")
