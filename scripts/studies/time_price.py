"""Accuracy against time in the position, for several prices of a second.

Every table is that of a tune, simulated on the same passes.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from scripts.studies.cases import CREATED, side_by_side
from scripts.studies.study import Findings, MarkdownTable, Method, Tell, option, plus_minus, table
from synth.problem.problem import Aim
from synth.retarder.case_result import ParetoFront, told
from synth.retarder.class_setup import ClassSetup, Origin, class_setup
from synth.retarder.configuration.config_file import parse_config
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.retarder.tune_case import pareto_front
from synth.simulation.stratified_passes import stratified_passes
from tuning_tables import Generator

if TYPE_CHECKING:
    from matplotlib.figure import Figure


FRESH = 49979687

CUTS = ((1, 22.0), (1, 85.0), (3, 150.0), (10, 520.0))
"""Gondolas of a cut, and their mass, t."""

TARGET_M_S = 3.0


@dataclass(frozen=True)
class Options:
    """What is studied."""

    passes: int = option(20_000, "fresh passes of each table", (200, 10**6))
    cases: int = option(len(CUTS), "how many of the cuts", (1, len(CUTS)))


@dataclass(frozen=True)
class TimePrice(Findings):
    """The fronts of all cases."""

    config_sha256: str
    seed: int
    passes: int
    fronts: tuple[ParetoFront, ...]

    def tables(self) -> Mapping[str, MarkdownTable]:
        """`fronts`: a row for each case and price."""
        return {"fronts": fronts_table(self.fronts)}

    def sentences(self) -> tuple[str, ...]:
        """What is nearly free, and how much was simulated."""
        return told(self.fronts), f"{self.passes} stratified passes a table, seed {self.seed}"


HEADS = ("case", "price, m²/s³", "rms, mm/s", "rms / rms without price", "predicted, mm/s", "time, s", "commands")


def fronts_table(fronts: tuple[ParetoFront, ...]) -> MarkdownTable:
    """A row for each case and price."""
    rows = [
        (
            front.name,
            f"{point.time_price_m2_s3:g}",
            plus_minus(point.statistics.rms_m_s, point.statistics.rms_ci95_m_s, 1, 1e3),
            plus_minus(point.ratio, point.ratio_ci95, 3),
            f"{1e3 * point.predicted_rms_m_s:.1f}",
            plus_minus(point.statistics.time_s, point.statistics.time_ci95_s, 2),
            f"{point.statistics.switchings:.1f}",
        )
        for front in fronts
        for point in front.points
    ]
    return table("accuracy against time in the position, by the price of a second", HEADS, rows)


def run(options: Options, tell: Tell) -> TimePrice:
    """All cases."""
    config = configured(options.cases)
    seed = config.validation.seed + FRESH
    fresh = stratified_passes(seed, 0, options.passes)
    origin = Origin(Generator("retarder-synth study", "0", config.sha256), CREATED)
    setups = [class_setup(config, label, plant, fresh, origin) for label, plant in config.plants()]

    def front(setup: ClassSetup) -> ParetoFront:
        found = pareto_front(config, setup, Aim(TARGET_M_S, config.criterion))
        tell(found.name)
        return found

    return TimePrice(config.sha256, seed, options.passes, side_by_side(front, setups))


def configured(cases: int) -> ResolvedConfig:
    """The default position with the first of the cuts."""
    cuts = "".join(f'[[cut]]\ncar = "gondola-4"\ncars = {cars}\nmass_t = {mass}\n' for cars, mass in CUTS[:cases])
    return parse_config(f"[targets]\nexit_speeds_m_s = [{TARGET_M_S}]\n{cuts}", "study time-price")


METHOD = Method(Options, Options(passes=200, cases=1), TimePrice, run)


def figures(found: TimePrice) -> Mapping[str, Figure]:
    """`fronts`, rms over the mean time in the position, a panel for each case, as a tune draws them."""
    from synth.retarder.pictures.accuracy import pareto_fronts

    return {"fronts": pareto_fronts(found.fronts)}
