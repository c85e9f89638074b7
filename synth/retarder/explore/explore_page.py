"""The page itself: one file that loads nothing, with tables, plants, style and the program that plays passes."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from importlib.resources import files
from itertools import groupby
from typing import Any, Final

from plant_models import PointSensors
from synth.frame.page.markup import Markup, element
from synth.frame.page.scripted_document import SPEED_UNITS, scripted_document
from synth.problem.aim import OVERSPEED_M_S
from synth.retarder.explore.beside import Beside, beside_data
from synth.retarder.explore.plant_data import plant_data
from synth.retarder.served_class import PassageClass, ServedClass
from tuning_tables.controller_code.js_rules import JsRules, js_passage_rules, js_rules
from tuning_tables.passages.passage_table import PassageTable
from tuning_tables.table import ControllerTable
from tuning_tables.table_kinds import StageTable

PAGE: Final = "explore.html"
"""The name of its file, and of what stands in its body."""

SCRIPTS: Final = (
    "motion.js", "drive.js", "laws.js", "passes.js", "passages.js", "draws.js", "figures.js", "words.js",
    "passage_words.js", "chart.js", "histogram.js", "pictures.js", "controls.js", "figure_table.js", "legends.js",
    "explore.js",
)  # fmt: skip


@dataclass(frozen=True)
class PlayedTable:
    """A table and the class that it brakes, whose cuts weigh from low to high.

    `infeasible`: the tune that made the table calls its case so. `beside`: what the page shows beside it; None: not
    simulated yet.
    """

    table: StageTable
    served: ServedClass
    mass_limits_t: tuple[float, float]
    infeasible: bool
    beside: Beside | None = None

    @property
    def sensors(self) -> PointSensors | None:
        """Those that the table decides at; None: a radar."""
        return self.served.sensors if isinstance(self.served, PassageClass) else None

    @property
    def stages(self) -> int:
        """Stages of the table."""
        return len(self.table.pressure_kpa if isinstance(self.table, PassageTable) else self.table.stages)

    @property
    def title(self) -> str:
        """What the menu calls it."""
        mark = ", infeasible by its tune" if self.infeasible else ""
        return f"{self.served.label} to {self.table.target_speed_m_s:g} m/s{mark}"


def explore_page(title: str, meta: str, tables: Sequence[PlayedTable]) -> str:
    """One HTML document; `meta`: a line below the title. The same tables give the same text."""
    lines = [(each, each.table) for each in tables if isinstance(each.table, ControllerTable)]
    passages = [(each, each.table) for each in tables if isinstance(each.table, PassageTable)]
    rules, classes = [], list[dict[str, Any]]()
    if lines:
        rules.append(js_rules([table for _, table in lines]))
        classes += class_data([each for each, _ in lines], rules[-1])
    if passages:
        rules.append(js_passage_rules([table for _, table in passages]))
        classes += class_data([each for each, _ in passages], rules[-1])
    alarms = [each for rule in rules for each in rule.alarms]
    data = {"classes": classes, "overspeed_m_s": OVERSPEED_M_S, "alarms": alarms}
    content = (element("h1", title), element("p", meta, class_="meta"), Markup(part(PAGE)))
    scripts = [*(rule.text for rule in rules), SPEED_UNITS, *(part(name) for name in SCRIPTS)]
    return scripted_document(f"{title}: play with its tables", part("explore.css"), content, data, scripts)


def class_data(tables: Sequence[PlayedTable], rules: JsRules) -> Iterator[dict[str, Any]]:
    """What the page must know of each class, with those of its tables that follow each other."""
    held = {id(each): values for each, values in zip(tables, rules.tables, strict=True)}
    for _, played in groupby(tables, key=lambda each: (each.served.label, each.stages, each.sensors)):
        together = list(played)
        first = together[0]
        plant = plant_data(first.served.plant, first.mass_limits_t, first.stages, first.sensors)
        yield {
            "plant": plant,
            "room": dict(rules.room),
            "tables": [{**table_data(each), "held": held[id(each)]} for each in together],
        }


def table_data(played: PlayedTable) -> dict[str, Any]:
    """What the page tells of a table."""
    table = played.table
    return {
        "id": table.id,
        "title": played.title,
        "target_m_s": table.target_speed_m_s,
        "predicted_m_s": table.predicted.rms_m_s,
        **(beside_data(played.beside, table.target_speed_m_s) if played.beside else {}),
    }


def part(name: str) -> str:
    """A part of the page that is kept as a file beside this one."""
    return files("synth.retarder.explore").joinpath(name).read_text(encoding="utf-8")
