"""The page itself: one file that loads nothing, with tables, plants, style and the program that plays passes; and what
it shows beside a table: the passes of a tune under it, and the best classical rule on the same passes.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from importlib.resources import files
from itertools import groupby
from typing import Any, Final

import numpy as np

from plant_models import PointSensors
from synth.frame.page.document import SPEED_UNITS, scripted_document
from synth.frame.page.markup import Markup, element
from synth.problem.problem import OVERSPEED_M_S
from synth.retarder.class_setup import TUNING_PASSES, validation_passes
from synth.retarder.comparison.baselines import TunedBaseline, best_law, compared_laws, permitted
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.retarder.explore.plant_data import plant_data
from synth.retarder.sensors.sensor_case import sensor_passes
from synth.retarder.served_class import PassageClass, ServedClass
from synth.simulation.common_passes import common_passes
from synth.simulation.controllers import LineController, TableController
from synth.simulation.exit_statistics import ExitStatistics, exit_statistics
from synth.simulation.passage_controller import of_table
from synth.simulation.passes import ExitSample
from synth.simulation.random_passes import random_passes
from synth.solver.switching_lines import SwitchingLines
from tuning_tables.controller_code.js_rules import JsRules, js_passage_rules, js_rules
from tuning_tables.decisions import Decisions
from tuning_tables.document import StageTable
from tuning_tables.passages.passage_table import PassageTable
from tuning_tables.table import ControllerTable

BIN_M_S: Final = 0.01
"""Width of the bins of a density."""

LINE_DIGITS: Final = 6
"""Decimals of a line that the page holds, m/s: it is no finer than a float32."""


@dataclass(frozen=True, eq=False)
class SimulatedExits:
    """Exits of simulated passes and their figures."""

    sample: ExitSample
    statistics: ExitStatistics


@dataclass(frozen=True, eq=False)
class Beside:
    """The passes under a table, and those under `rule`, the best of the laws that a tune compares it with.

    `rule` None: point sensors, for which no such law is tuned.
    """

    table: SimulatedExits
    rule: tuple[TunedBaseline, SimulatedExits] | None


def beside(table: StageTable, served: ServedClass, config: ResolvedConfig) -> Beside:
    """A table and the best rule on the passes of `config`: those that a tune of it runs both on, so with its figures.

    The rule is tuned as a tune does it, on other passes.
    """
    passes, target_m_s = validation_passes(config), table.target_speed_m_s
    if isinstance(table, PassageTable):
        assert isinstance(served, PassageClass)
        heard = sensor_passes(served.plant, served.sensors, passes, len(table.pressure_kpa))
        return Beside(simulated(heard.run(of_table(table, tracking=True)), target_m_s), None)
    common = common_passes(served.plant, passes)
    tuning = common.of_others(random_passes(config.validation.seed + 1, 0, TUNING_PASSES))
    sample = common.run(TableController(table))
    best = best_law(compared_laws(tuning, common, sample, target_m_s, permitted(table)))
    return Beside(simulated(sample, target_m_s), (best.law, SimulatedExits(best.sample, best.measured.statistics)))


def simulated(sample: ExitSample, target_m_s: float) -> SimulatedExits:
    """A sample with its figures."""
    return SimulatedExits(sample, exit_statistics(sample, target_m_s))


def beside_data(found: Beside, target_m_s: float) -> dict[str, Any]:
    """What the page must know of it."""
    data = {"simulated": exits_data(found.table, target_m_s), "rule": None}
    if found.rule is not None:
        law, exits = found.rule
        data["rule"] = {**rule_data(law), "simulated": exits_data(exits, target_m_s)}
    return data


def exits_data(exits: SimulatedExits, target_m_s: float) -> dict[str, Any]:
    """Figures, each [value, low, high] of its 95 % interval, and the density of the exit error."""
    found = exits.statistics
    figures = {
        "rms": [found.rms_m_s, *found.rms_ci95_m_s],
        "within": [found.p95_m_s, *found.p95_ci95_m_s],
        "bias": [found.bias_m_s, *found.bias_ci95_m_s],
        "overspeed": [found.overspeed, *found.overspeed_ci95],
        "stalled": [found.stalled, *found.stalled_ci95],
        "commands": [found.switchings, *found.switchings_ci95],
        "time": [found.time_s, *found.time_ci95_s],
    }
    return {"n": found.passes, **figures, "density": density(exits.sample, target_m_s)}


def density(sample: ExitSample, target_m_s: float) -> dict[str, Any]:
    """Share of all passes that leave with an error in each bin: the first begins at `from_m_s`."""
    left = ~sample.stalled
    place = np.floor((sample.exit_speed_m_s[left] - target_m_s) / BIN_M_S).astype(np.int64)
    first = int(place.min(initial=0))
    shares = np.bincount(place - first, weights=sample.weight[left]) / sample.weight.sum()
    return {
        "from_m_s": round(first * BIN_M_S, 2),
        "width_m_s": BIN_M_S,
        "shares": [float(f"{share:.3g}") for share in shares],
    }


def rule_data(law: TunedBaseline) -> dict[str, Any]:
    """A rule as the page tells and runs it."""
    parameters = {name: float(f"{value:.4g}") for name, value in law.parameters.items()}
    return {"name": law.name, "parameters": parameters, "lines": lines_data(played_controller(law.controller))}


def played_controller(controller: LineController) -> LineController:
    """The regulator with its lines as the page holds them."""
    lines = controller.lines
    lower, upper = (np.round(each, LINE_DIGITS) for each in (lines.lower_m_s, lines.upper_m_s))
    return replace(controller, lines=SwitchingLines(lines.nodes_m, lower, upper))


def lines_data(controller: LineController) -> dict[str, Any]:
    """The rule of a regulator with lines; a stage without a line has null."""
    rule = controller.rule
    return {
        "lower": [row.tolist() if np.isfinite(row).all() else None for row in rule.lower],
        "upper": [row.tolist() if np.isfinite(row).all() else None for row in rule.upper],
        "start_m": rule.start_m,
        "spacing_m": rule.spacing_m,
        "farthest": rule.farthest,
        "lead_s": rule.lead_s,
        "filter_s": rule.filter_s,
        "at_any_time": int(controller.decisions is Decisions.AT_ANY_TIME),
    }


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
