"""What is gained when a command may be given at every sample, also during a pressure transient.

On the same fresh passes: cubics for commands at rest, polished surfaces for commands at any time (cubic in path, linear
in pressure; and without pressure), and the energy rule.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from plant_models import Plant, PlantError
from scripts.studies.any_time.findings import (
    CUBIC,
    ENERGY,
    ENERGY_AT_ANY_TIME,
    PLAIN,
    POLISHED,
    RULES,
    AnyTime,
    CaseRow,
    PermissionRow,
    Ratio,
    SilentGauge,
    StuckFigures,
    Told,
)
from scripts.studies.any_time.wrong_plants import ratios_to_rest, where_stuck, with_a_silent_gauge
from scripts.studies.cases import OTHER_PLANTS, Case, from_the_entrance, lines_of_solution, named_cases, rounded
from scripts.studies.near_target import near_ratio
from scripts.studies.study import Method, Tell, option
from synth.frame.workers.engine import Teller
from synth.problem.problem import Aim
from synth.problem.resolution import design_resolution
from synth.retarder.comparison.baselines import FAMILIES, tune
from synth.retarder.configuration.config_file import load_config, parse_config
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.retarder.permissions.case_permissions import permissions_of
from synth.retarder.permissions.permission import Permission
from synth.simulation.closed_loop import LineController, TableController
from synth.simulation.common_passes import CommonPasses, common_passes
from synth.simulation.controllers import Regulator
from synth.simulation.exit_statistics import exit_statistics, rms_ratio
from synth.simulation.passes import ExitSample
from synth.simulation.random_passes import RandomPasses, random_passes
from synth.simulation.stratified_passes import stratified_passes
from synth.solver.any_time.polynomial_surfaces import (
    CUBIC_ALONE,
    CUBIC_AND_SLOPE,
    PolynomialSurfaces,
    surfaces_of_lines,
)
from synth.solver.any_time.sampled_chain import sampled_chain
from synth.solver.any_time.surface_evaluation import SurfaceEvaluation
from synth.solver.any_time.surface_polish import polish_surfaces
from synth.solver.backward_induction import solve
from synth.solver.chain.chain import persistent_chain
from synth.solver.switching_lines import PolynomialLines
from tuning_tables import Decisions

FRESH, TUNING, BASELINE_PASSES = 49979687, 67867967, 1000

NO_DATE = "2000-01-01T00:00:00Z"
"""Tables of a study are kept nowhere."""

GAUGE_FACTORS = (0.85, 0.95, 1.05, 1.15)
"""Pressures that a wrong gauge shows, over the true one."""


@dataclass(frozen=True)
class Options:
    """What is studied."""

    config: Path | None = option(None, "configuration; the built-in default book without it")
    cases: tuple[str, ...] = option(
        ("22:2", "52:3", "66:3", "85:4", "66:2", "85:2", "85:3"), "mass, t : target, m/s"
    )  # fmt: skip
    valves: tuple[float, ...] = option((1.0, 2.0), "times as fast: delays and time constants divided", (0.5, 10.0))
    passes: int = option(20_000, "fresh passes of each controller", (200, 10**6))
    coarser: float = option(1.0, "times the steps of the grid of the surfaces", (0.5, 8.0))
    threads: int = option(2, "scenarios followed side by side; no figure depends on it", (1, 64))
    books: int = option(len(OTHER_PLANTS) + 1, "plants whose permissions are told, the one given as the last to join",
                        (0, len(OTHER_PLANTS) + 1))  # fmt: skip


@dataclass(frozen=True)
class Bench:
    """One case with its valves: the cubics for commands at rest, and the evaluation of surfaces for it."""

    case: Case
    config: ResolvedConfig
    cubics: PolynomialLines
    evaluation: SurfaceEvaluation

    @property
    def at_rest(self) -> LineController:
        """The regulator of the cubics."""
        return LineController(self.cubics.at(self.cubics.nodes_m(301)))

    def polished(self, degrees: tuple[int, ...]) -> PolynomialSurfaces:
        """Surfaces polished from the stage-locked cubics."""
        stages = np.asarray(self.case.plant.position.stage_pressures_kpa[: len(self.cubics.has_line)])
        aim = Aim(self.case.target_m_s, self.config.criterion)
        return polish_surfaces(surfaces_of_lines(self.cubics, stages, degrees), self.evaluation, aim).best

    def controller(self, surfaces: PolynomialSurfaces, gauge_factor: float = 1.0) -> TableController:
        """The table of `surfaces` with a gauge that shows so many times the pressure."""
        table = rounded(self.config, self.case.plant, surfaces, self.case.target_m_s)
        return TableController(table, gauge_factor)

    def where_wrong(
        self, surfaces: PolynomialSurfaces, passes: CommonPasses
    ) -> tuple[dict[str, Ratio], SilentGauge, dict[str, StuckFigures]]:
        """What `surfaces` lose beside the cubics at rest where something is wrong, the gauge silent, a valve stuck."""
        case, at_rest = self.case, self.at_rest
        seed, target = self.config.validation.seed + FRESH, case.target_m_s
        table = rounded(self.config, case.plant, surfaces, target)
        return (
            ratios_to_rest(case.plant, target, TableController(table), at_rest, passes.passes, seed),
            with_a_silent_gauge(target, table, at_rest, passes),
            where_stuck(target, TableController(table), at_rest, passes, seed),
        )


def run(options: Options, tell: Tell) -> AnyTime:
    """All cases with all valves, one after the other: scenarios of a case keep the processors busy."""
    config = from_the_entrance(options.config)
    seed = config.validation.seed + FRESH
    fresh = stratified_passes(seed, 0, options.passes)
    rows: list[CaseRow] = []
    for valves in options.valves:
        for name in options.cases:
            (case,) = named_cases(config, (name,))
            bench = bench_of(replace(case, plant=quicker(case.plant, valves)), config, options)
            rows.append(studied(bench, valves, fresh))
            tell(f"{case.name}, valves × {valves:g}")
    books = [load_config(options.config), *(parse_config(text, name) for name, text in OTHER_PLANTS)]
    permissions = [row for book in books[len(books) - options.books :] for row in permission_rows(book, options, tell)]
    return AnyTime(config.sha256, seed, options.passes, tuple(rows), tuple(permissions))


def permission_rows(config: ResolvedConfig, options: Options, tell: Tell) -> list[PermissionRow]:
    """What permissions give in the cases of a configuration, on so many passes of its own validation."""
    few = replace(config, validation=config.validation.model_copy(update={"passes": options.passes}))
    found = permissions_of(few, NO_DATE, options.threads, Teller(tell))
    if not found.complete:
        raise PlantError(f"permissions of {config.title}: what was told above cannot be")
    rows = []
    for case in found.cases:
        any_time = next(each for each in case.results if each.permission is Permission.ANY_TIME)
        rows.append(
            PermissionRow(
                f"{case.label} to {case.target_speed_m_s:g} m/s", case.table.rms_m_s, case.table.switchings,
                {each.permission.value: Ratio(each.ratio, each.ratio_ci95) for each in case.results},
                any_time.predicted_rms_m_s / any_time.statistics.rms_m_s,
                {each.permission.value: each.statistics.switchings for each in case.results},
            )
        )  # fmt: skip
    return rows


def quicker(plant: Plant, times: float) -> Plant:
    """`plant` with all delays and time constants of its valves divided."""
    valves = plant.position.pneumatics
    names = [name for name in vars(valves) if name.endswith(("_delay_s", "_constant_s"))]
    faster = replace(valves, **{name: getattr(valves, name) / times for name in names})
    return replace(plant, position=replace(plant.position, pneumatics=faster))


def bench_of(case: Case, config: ResolvedConfig, options: Options) -> Bench:
    """The case with its stage-locked lines."""
    solution = solve(persistent_chain(case.plant, config.resolution), Aim(case.target_m_s, config.criterion))
    cubics = lines_of_solution(solution, config.fit.degree)
    steps = design_resolution(case.plant, case.target_m_s, options.coarser)
    evaluation = SurfaceEvaluation(sampled_chain(case.plant, steps), options.threads)
    return Bench(case, config, cubics, evaluation)


def studied(bench: Bench, valves: float, fresh: RandomPasses) -> CaseRow:
    """All controllers of one case."""
    polished, plain = bench.polished(CUBIC_AND_SLOPE), bench.polished(CUBIC_ALONE)
    passes, target = common_passes(bench.case.plant, fresh), bench.case.target_m_s
    samples = samples_of(bench, polished, plain, passes)
    told = {name: told_of(sample, samples[CUBIC], target) for name, sample in samples.items()}
    others = {rule: Ratio(*rms_ratio(samples[POLISHED], samples[rule], target)) for rule in RULES}
    shown = {factor: passes.run(bench.controller(polished, factor)) for factor in GAUGE_FACTORS}
    gauge = {f"{factor:g}": Ratio(*rms_ratio(each, samples[POLISHED], target)) for factor, each in shown.items()}
    wrong = bench.where_wrong(polished, passes) if valves == 1.0 else ({}, None, {})
    return CaseRow(bench.case.name, valves, told, others, gauge, *wrong)


def samples_of(
    bench: Bench, polished: PolynomialSurfaces, plain: PolynomialSurfaces, passes: CommonPasses
) -> dict[str, ExitSample]:
    """The `passes` by every controller."""
    rehearsal = random_passes(bench.config.validation.seed + TUNING, 0, BASELINE_PASSES)
    (rule,) = (family for family in FAMILIES if family.name == ENERGY)
    energy = {
        when: tune(rule.deciding(when), passes.of_others(rehearsal), bench.case.target_m_s).controller
        for when in Decisions
    }
    controllers: dict[str, Regulator] = {
        CUBIC: bench.at_rest,
        POLISHED: bench.controller(polished),
        PLAIN: bench.controller(plain),
        ENERGY: energy[Decisions.AT_REST],
        ENERGY_AT_ANY_TIME: energy[Decisions.AT_ANY_TIME],
    }
    return {name: passes.run(controller) for name, controller in controllers.items()}


def told_of(sample: ExitSample, reference: ExitSample, target_m_s: float) -> Told:
    """What is told of one controller."""
    found = exit_statistics(sample, target_m_s)
    return Told(
        found.rms_m_s, found.rms_ci95_m_s, found.switchings, Ratio(*rms_ratio(sample, reference, target_m_s)),
        Ratio(*near_ratio(sample, reference, target_m_s)),
    )  # fmt: skip


METHOD = Method(Options, Options(None, ("22:3",), (1.0,), 200, 3.0, 2, 0), AnyTime, run)
