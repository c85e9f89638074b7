"""rms against switchings a pass, for several prices of a switching, with commands at rest and at any time.

The price is `criterion.switching_tolerance_m2_s2`, which solver and polish both count. Every table is that of a tune,
simulated on the same passes.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from scripts.studies.cases import CREATED, named_cases
from scripts.studies.study import Findings, MarkdownTable, Method, Tell, option, table
from synth.problem.problem import Aim
from synth.retarder.class_setup import ClassSetup, Origin, class_setup
from synth.retarder.configuration.config_file import load_config
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.retarder.tuned_table import solutions, tuned_table
from synth.simulation.closed_loop import TableController
from synth.simulation.exit_statistics import exit_statistics
from synth.simulation.replicates import Interval
from synth.simulation.stratified_passes import stratified_passes
from tuning_tables import Generator

FRESH = 32452843

AT_REST, AT_ANY_TIME = "at rest", "at any time"


@dataclass(frozen=True)
class Options:
    """What is studied."""

    config: Path | None = option(None, "configuration; the built-in default book without it")
    cases: tuple[str, ...] = option(("22:2", "52:3", "66:4"), "mass, t : target, m/s")
    prices_m2_s2: tuple[float, ...] = option(
        (1e-6, 1e-5, 3e-5, 1e-4, 3e-4, 1e-3), "what a change of stage costs, m²/s²", (0.0, 1.0)
    )
    passes: int = option(20_000, "fresh passes of each table", (200, 10**6))


@dataclass(frozen=True)
class Point:
    """One table: the price it was made for, and what its passes gave."""

    price_m2_s2: float
    rms_m_s: float
    rms_ci95_m_s: Interval
    switchings: float
    predicted_rms_m_s: float
    predicted_switchings: float


@dataclass(frozen=True)
class Curve:
    """One case, by when commands come."""

    case: str
    at_rest: tuple[Point, ...]
    at_any_time: tuple[Point, ...]


@dataclass(frozen=True)
class SwitchingPrice(Findings):
    """All cases."""

    config_sha256: str
    seed: int
    passes: int
    curves: tuple[Curve, ...]

    def tables(self) -> Mapping[str, MarkdownTable]:
        """`curves`: a row for each case and price."""
        heads = ("case", "price, cm²/s²", *(f"{each}, {what}" for each in (AT_REST, AT_ANY_TIME) for what in
                 ("mm/s / switchings", "predicted")))  # fmt: skip
        rows = (row for curve in self.curves for row in rows_of(curve))
        return {"curves": table("rms ± half its 95 % interval, mm/s / switchings a pass", heads, rows)}

    def sentences(self) -> tuple[str, ...]:
        """How much was simulated."""
        return (f"{self.passes} stratified passes a table, seed {self.seed}",)


def rows_of(curve: Curve) -> Iterator[tuple[str, ...]]:
    """A row for each price."""
    for rest, free in zip(curve.at_rest, curve.at_any_time, strict=True):
        cells = [cell for point in (rest, free) for cell in (simulated_cell(point), predicted_cell(point))]
        yield (curve.case, f"{1e4 * rest.price_m2_s2:g}", *cells)


def simulated_cell(point: Point) -> str:
    """'23.4 ± 0.3 / 10.7'."""
    low, high = point.rms_ci95_m_s
    return f"{1e3 * point.rms_m_s:.1f} ± {500 * (high - low):.1f} / {point.switchings:.1f}"


def predicted_cell(point: Point) -> str:
    """'22.6 / 10.7'."""
    return f"{1e3 * point.predicted_rms_m_s:.1f} / {point.predicted_switchings:.1f}"


def run(options: Options, tell: Tell) -> SwitchingPrice:
    """All cases, one after the other."""
    config = load_config(options.config)
    seed = config.validation.seed + FRESH
    fresh = stratified_passes(seed, 0, options.passes)
    origin = Origin(Generator("retarder-synth study", "0", config.sha256), CREATED)
    curves = []
    for case in named_cases(config, options.cases):
        setups = {
            words: class_setup(commanding(config, commands), case.label, case.plant, fresh, origin)
            for words, commands in ((AT_REST, "at_rest"), (AT_ANY_TIME, "any_time"))
        }
        rest, free = (points(setup, config, case.target_m_s, options) for setup in setups.values())
        curves.append(Curve(case.name, rest, free))
        tell(case.name)
    return SwitchingPrice(config.sha256, seed, options.passes, tuple(curves))


def commanding(config: ResolvedConfig, commands: str) -> ResolvedConfig:
    """The configuration with commands at these times."""
    return replace(config, regulator=config.regulator.model_copy(update={"commands": commands}))


def points(setup: ClassSetup, config: ResolvedConfig, target_m_s: float, options: Options) -> tuple[Point, ...]:
    """The tables of one case for all prices."""
    criteria = [replace(config.criterion, switching_tolerance_m2_s2=price) for price in options.prices_m2_s2]
    found = []
    for solution in solutions(setup.design, [Aim(target_m_s, criterion) for criterion in criteria]):
        made = tuned_table(setup, solution).table
        passes = exit_statistics(setup.passes.run(TableController(made)), target_m_s)
        found.append(
            Point(
                solution.aim.criterion.switching_tolerance_m2_s2, passes.rms_m_s, passes.rms_ci95_m_s,
                passes.switchings, made.predicted.rms_m_s, made.predicted.switchings,
            )
        )  # fmt: skip
    return tuple(found)


METHOD = Method(Options, Options(None, ("52:3",), (1e-3,), 200), SwitchingPrice, run)
