"""Friction falls and the exhaust slows down; tables are tuned anew from a log, and beside them with the truth: how
much of what can be recovered do they recover?

A log is made by the old tables on the changed plant. All three tables are then run on the same passes of that plant,
which no tuning has seen.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from plant_models.pressure_regulator import PressureGauge
from scripts.studies.cases import CREATED
from scripts.studies.study import Findings, MarkdownTable, Method, Tell, option, span, table
from synth.frame.workers.engine import Teller
from synth.logs.fitting_passes import fitting_passes
from synth.logs.identified_config import with_numbers
from synth.logs.retune.retune import RetuneOrder, retune
from synth.logs.retune.tuned_books import Case, class_setups, tuned_tables
from synth.retarder.configuration.config_file import ConfigSource, source_of_text
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.simulation.closed_loop import simulate
from synth.simulation.controllers import TableController
from synth.simulation.passes import ExitSample
from synth.simulation.random_passes import RandomPasses
from synth.simulation.replicates import Interval, rms_of
from synth.simulation.sampled_pass import LoggedClass, mixed_log
from synth.simulation.stratified_passes import stratified_passes
from tuning_tables import ControllerTable

SLOPE, EXHAUST = "retarder.force.slope_kn_per_kpa", "retarder.pneumatics.exhaust_time_constant_s"

FRESH = 99
"""Seed of the passes that all tables are run on."""

TEXT = """
[position]
name = "knp-5-bunch"
[entry]
low_m_s = 4.5
high_m_s = 6.5
[targets]
exit_speeds_m_s = [3.0]
[[cut]]
label = "LS-1"
car = "gondola-4"
cars = 1
mass_t = 36.0
[[cut]]
label = "S-1"
car = "gondola-4"
cars = 1
mass_t = 52.0
"""


@dataclass(frozen=True)
class Options:
    """What changes, and how much is measured."""

    friction: float = option(0.7, "share of the friction that is left", (0.3, 1.5))
    exhaust: float = option(1.5, "times the exhaust constant", (0.5, 3.0))
    logged: tuple[int, ...] = option((50, 200), "measured passes of each class", (20, 10_000))
    logs: int = option(3, "logs of each size", (1, 200))
    passes: int = option(20_000, "passes that all tables are run on", (200, 10**7))


@dataclass(frozen=True)
class Row:
    """One log of `logged` passes a class, and one case; `recovered`: (old − new) / (old − truth) of the rms."""

    logged: int
    seed: int
    case: str
    changed: bool
    old_rms_m_s: float
    new_rms_m_s: float
    truth_rms_m_s: float
    recovered: float
    predicted_ci95: Interval


@dataclass(frozen=True)
class Unchanged:
    """Logs of the plant that was assumed: of `cases` in all, so many were offered a new table."""

    logged: int
    logs: int
    cases: int
    changed: int


@dataclass(frozen=True)
class Retunings(Findings):
    """All logs."""

    passes: int
    rows: tuple[Row, ...]
    unchanged: tuple[Unchanged, ...]

    def tables(self) -> Mapping[str, MarkdownTable]:
        """`recovered`: by size of the log and case; `unchanged`: what is offered where nothing has changed."""
        heads = ("passes a class", "case", "rms before", "retuned", "with the truth", "recovered [least, most]",
                 "interval holds the ratio", "changed")  # fmt: skip
        keys = dict.fromkeys((row.logged, row.case) for row in self.rows)
        groups = [[row for row in self.rows if (row.logged, row.case) == key] for key in keys]
        return {
            "recovered": table("rms of exit less target, m/s, over the logs", heads, map(cells, groups)),
            "unchanged": table(
                "The plant is what was assumed",
                ("passes a class", "logs", "cases", "offered a new table"),
                [(str(u.logged), str(u.logs), str(u.cases), str(u.changed)) for u in self.unchanged],
            ),
        }

    def sentences(self) -> tuple[str, ...]:
        """How much was simulated."""
        return (f"{self.passes} stratified passes of every table, seed {FRESH}",)

    def faults(self) -> tuple[str, ...]:
        """The longest logs recover less than 90 % on the mean."""
        longest = [row.recovered for row in self.rows if row.logged == max(row.logged for row in self.rows)]
        mean = float(np.mean(longest))
        return () if mean >= 0.9 else (f"the longest logs recover {100.0 * mean:.0f} % of what can be recovered",)


def cells(rows: list[Row]) -> tuple[str, ...]:
    """One line of the table, means over logs."""

    def mean(name: str) -> float:
        return float(np.mean([getattr(row, name) for row in rows]))

    shares = [row.recovered for row in rows]
    recovered = f"{100.0 * mean('recovered'):.0f} % {span((min(shares), max(shares)), 0, 100.0)}"
    held = sum(row.predicted_ci95[0] <= row.new_rms_m_s / row.old_rms_m_s <= row.predicted_ci95[1] for row in rows)
    return (
        str(rows[0].logged), rows[0].case, f"{mean('old_rms_m_s'):.4f}", f"{mean('new_rms_m_s'):.4f}",
        f"{mean('truth_rms_m_s'):.4f}", recovered,
        f"{held} of {len(rows)}", f"{sum(row.changed for row in rows)} of {len(rows)}",
    )  # fmt: skip


@dataclass(frozen=True)
class Yards:
    """The assumed plant, also as `source`, and the true one, tables tuned for both, and passes of the true one."""

    source: ConfigSource
    assumed: ResolvedConfig
    truth: ResolvedConfig
    old: Mapping[Case, ControllerTable]
    best: Mapping[Case, ControllerTable]
    fresh: RandomPasses

    def rms(self, case: Case, controller_table: ControllerTable) -> float:
        """On the true plant."""
        found: ExitSample = simulate(dict(self.truth.plants())[case[0]], TableController(controller_table), self.fresh)
        return rms_of(found.exit_speed_m_s - case[1], found.weight)[0]


def run(options: Options, tell: Tell) -> Retunings:
    """Logs of all sizes, of the changed plant and of the assumed one."""
    source = source_of_text(TEXT, "retuning")
    config = source.resolved()
    known = {value.key: value.value for value in config.parameters}
    slope, exhaust = known[SLOPE], known[EXHAUST]
    assert isinstance(slope, float)
    assert isinstance(exhaust, float)
    changes = {SLOPE: options.friction * slope, EXHAUST: options.exhaust * exhaust}
    truth = with_numbers(source, changes, "truth", lambda _: "truth").resolved()
    old, best = (tuned_tables(each, class_setups(each, CREATED), 2, Teller(tell)).whole for each in (config, truth))
    yards = Yards(source, config, truth, old, best, stratified_passes(FRESH, 0, options.passes))
    rows: list[Row] = []
    unchanged = []
    for logged in options.logged:
        for seed in range(options.logs):
            rows += retuned(yards, logged, seed)
            tell(f"log {seed + 1} of {logged} passes a class: recovered {rows[-1].recovered:.2f}")
        same = [retuned(replace(yards, truth=config), logged, seed) for seed in range(options.logs)]
        offered = [row.changed for found in same for row in found]
        unchanged.append(Unchanged(logged, options.logs, len(offered), sum(offered)))
    return Retunings(options.passes, tuple(rows), tuple(unchanged))


def retuned(yards: Yards, logged: int, seed: int) -> list[Row]:
    """One log and what comes of it."""
    plants = dict(yards.truth.plants())
    classes = [LoggedClass(plants[case[0]], TableController(each), case[1]) for case, each in yards.old.items()]
    log = mixed_log(classes, [logged] * len(classes), 1000 + seed, PressureGauge(2.0, 1.0))
    passes = fitting_passes(log, yards.assumed.plants(), "retuning")
    found = retune(passes, yards.source, RetuneOrder(yards.old, CREATED, threads=2), Teller(lambda _: None))
    rows = []
    for gain in found.gains:
        tables = (yards.old[gain.case], found.new[gain.case], yards.best[gain.case])
        old, new, best = (yards.rms(gain.case, each) for each in tables)
        share = (old - new) / (old - best) if abs(old - best) > 1e-12 else 0.0
        name = f"{gain.label} to {gain.target_m_s:g} m/s"
        rows.append(Row(logged, seed, name, gain in found.changed, old, new, best, share, gain.ratio_ci95))
    return rows


METHOD = Method(Options, Options(logged=(30,), logs=1, passes=400), Retunings, run)
