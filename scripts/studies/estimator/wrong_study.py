"""What the estimator costs where it, or its lines, are wrong (another plant, a wrong gauge, a lost sensor): the
tables that `tune` writes, on plants they were not made for.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from plant_models import Plant
from plant_models.frozen_arrays import Floats
from scripts.studies.cases import Case, class_cases, side_by_side
from scripts.studies.changed_plants import LostForGood, SensorFault, at_random, friction, no_fault, times
from scripts.studies.estimator.pair import FRESH, Both, Compared, as_tuned, compared
from scripts.studies.study import Findings, MarkdownTable, Method, Tell, option, span, table
from synth.problem.problem import Aim, Problem
from synth.retarder.configuration.config_file import load_config
from synth.simulation.closed_loop import Controller, simulate
from synth.simulation.passes import ExitSample
from synth.simulation.random_passes import RandomPasses
from synth.simulation.stratified_passes import stratified_passes

LOST = "sensor lost for good"

TOGETHER = 5000
"""Passes simulated at a time: those of a lost sensor have 3000 readings."""


@dataclass(frozen=True)
class Wrong:
    """What is wrong: the plant as it is, how many times the brake work the gauge shows, the sensor's fault."""

    name: str
    plant: Plant
    gauge: float = 1.0
    fault: SensorFault = no_fault


def wrongs(plant: Plant, seed: int) -> tuple[Wrong, ...]:
    """All that is tried, the plant that the tables were made for first; `seed` draws when the sensor is lost."""
    law, sensor = plant.friction, plant.sensor
    rough = replace(law, path_std=2.0 * law.path_std)
    noisy = replace(sensor, noise_m_s=2.0 * sensor.noise_m_s)
    return (
        *braking_otherwise(plant),
        Wrong("path noise × 2", replace(plant, friction=rough)),
        Wrong("sensor noise × 2", replace(plant, sensor=noisy)),
        Wrong("gauge + 15 %", plant, 1.15),
        Wrong("gauge − 15 %", plant, 0.85),
        Wrong(LOST, plant, fault=LostForGood(at_random(seed))),
    )


def braking_otherwise(plant: Plant) -> tuple[Wrong, ...]:
    """The plant that the tables were made for, and plants that brake their cuts more or less than it."""
    spread = replace(plant.friction, common_cv=1.7 * plant.friction.common_cv)
    return (
        Wrong("as it is", plant),
        *(Wrong(f"friction × {share:g}", braking(plant, share)) for share in (0.7, 0.8, 0.9, 1.1, 1.2, 1.3)),
        Wrong("friction CV × 1.7", replace(plant, friction=spread)),
        Wrong("mass + 15 %", weighing(plant, 1.15)),
        Wrong("mass − 15 %", weighing(plant, 0.85)),
    )


def weighing(plant: Plant, share: float) -> Plant:
    """`plant` whose cut has `share` of its mass."""
    return times("cut.mass_t", share)(plant)


def braking(plant: Plant, share: float) -> Plant:
    """`plant` whose retarders brake with `share` of their force."""
    return friction(share, 1.0)(plant)


def simulated(wrong: Wrong, controller: Controller, passes: RandomPasses, transit_s: Floats) -> ExitSample:
    """All passes with the fault, some at a time; `transit_s` (n,): how long each takes where nothing is wrong."""
    parts = []
    for start in range(0, len(passes), TOGETHER):
        stop = min(start + TOGETHER, len(passes))
        faulty = wrong.fault(passes.part(start, stop), wrong.plant, transit_s[start:stop])
        parts.append(simulate(wrong.plant, controller, faulty))
    return ExitSample(**{name: np.concatenate([getattr(part, name) for part in parts]) for name in vars(parts[0])})


@dataclass(frozen=True)
class Options:
    """What is studied."""

    config: Path | None = option(None, "configuration; the built-in default book without it")
    masses_t: tuple[float, ...] = option((36.0, 52.0), "only cuts of these masses, t")
    targets_m_s: tuple[float, ...] = option((2.0, 3.0), "exit speeds, m/s", (0.1, 20.0))
    passes: int = option(40_000, "fresh passes of each case", (200, 10**7))


@dataclass(frozen=True)
class CaseRow:
    """One case: figures by what is wrong.

    `without_reserve`: the same for lines that are designed for a mean friction that is known, `friction.mean_cv` = 0.
    """

    case: str
    by_wrong: dict[str, Compared]
    without_reserve: dict[str, Compared]


@dataclass(frozen=True)
class Misled(Findings):
    """All cases."""

    config_sha256: str
    seed: int
    passes: int
    cases: tuple[CaseRow, ...]

    def tables(self) -> Mapping[str, MarkdownTable]:
        """`wrong`: a row for what is wrong, a column a case; `lost`: a row a case, the sensor lost for good."""
        names = [name for name in self.cases[0].by_wrong if name != LOST]
        rows = [(name, *(ratio_cell(case.without_reserve[name], case.by_wrong[name]) for case in self.cases))
                for name in names]  # fmt: skip
        heads = ("case", "rms, m/s, without → with", "stalled, %", "too fast by 0.3 m/s, %", "outside 0.3 m/s, %")
        return {
            "wrong": table(
                "rms with / without estimator, without reserve → with it [95 %]; share outside 0.3 m/s, %: without "
                "estimator, with it, with it and a reserve",
                ("plant", *(case.case for case in self.cases)), rows,
            ),
            "lost": table("A sensor that is lost for good", heads, map(lost_cells, self.cases)),
        }  # fmt: skip

    def sentences(self) -> tuple[str, ...]:
        """How much was simulated."""
        return (f"{self.passes} fresh stratified passes each, seed {self.seed}",)


def ratio_cell(before: Compared, found: Compared) -> str:
    """'**1.245** → 0.960 [0.951, 0.970]; 0.79, 1.53, 0.77': bold where worse beyond the interval."""
    first, last = (f"**{x.ratio:.3f}**" if x.ratio_ci95[0] > 1.0 else f"{x.ratio:.3f}" for x in (before, found))
    shares = ", ".join(f"{100.0 * share:.2f}" for share in (found.outside[0], before.outside[1], found.outside[1]))
    return f"{first} → {last} {span(found.ratio_ci95, 3)}; {shares}"


def lost_cells(case: CaseRow) -> tuple[str, ...]:
    """The cells of one case."""
    found = case.by_wrong[LOST]
    rms = f"{found.rms_m_s[0]:.2f} → {found.rms_m_s[1]:.2f}"
    return case.case, rms, percent(found.stalled, 1), percent(found.overspeed, 1), percent(found.outside, 0)


def percent(shares: Both, digits: int) -> str:
    """'3.79 → 6.01'."""
    return " → ".join(f"{100.0 * share:.{digits}f}" for share in shares)


def run(options: Options, tell: Tell) -> Misled:
    """Tune both tables, simulate both on every plant."""
    config = load_config(options.config)
    seed = config.validation.seed + FRESH
    passes = stratified_passes(seed, 0, options.passes)

    def row_of(case: Case) -> CaseRow:
        known = replace(case.plant, friction=replace(case.plant.friction, mean_cv=0.0))
        aim = Aim(case.target_m_s, config.criterion)
        before, pair = (as_tuned(Problem(plant, aim), config, case.label) for plant in (known, case.plant))
        transit_s = simulate(case.plant, pair.plain, passes).transit_time_s.astype(np.float64)
        found: tuple[dict[str, Compared], dict[str, Compared]] = ({}, {})
        for wrong in wrongs(case.plant, seed):
            plain = simulated(wrong, pair.plain, passes, transit_s)
            for figures, each in zip(found, (before, pair), strict=True):
                estimated = simulated(wrong, each.misled(wrong.gauge), passes, transit_s)
                figures[wrong.name] = compared(case.target_m_s, plain, estimated)
        tell(f"{case.name}: {len(found[0])} plants and faults")
        return CaseRow(case.name, found[1], found[0])

    rows = side_by_side(row_of, class_cases(config, options.masses_t, options.targets_m_s))
    return Misled(config.sha256, seed, options.passes, rows)


METHOD = Method(Options, Options(masses_t=(52.0,), targets_m_s=(3.0,), passes=400), Misled, run)
