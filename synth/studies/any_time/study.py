"""What is gained when a command may be given at every sample, also during a pressure transient.

On the same fresh passes: stage-locked lines of the solver, stage-locked polished cubics, the same taken through a
direct search on simulated passes, the unlocked surfaces, the compact unlocked form (cubic in path, linear in pressure),
and cubics without pressure after the same search, and the energy rule.
"""

from __future__ import annotations

import time
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from plant_models import Plant
from synth.book.comparison.baselines import tune_baselines
from synth.configuration.resolved_config import ResolvedConfig
from synth.problem.aim import Aim
from synth.problem.resolution import Resolution
from synth.simulation.closed_loop import LineController
from synth.simulation.common_passes import common_passes
from synth.simulation.exit_statistics import exit_statistics, rms_ratio
from synth.simulation.passes import ExitSample
from synth.simulation.random_passes import RandomPasses, random_passes
from synth.simulation.stratified_passes import stratified_passes
from synth.solver.backward_induction import solve
from synth.solver.chain.chain import persistent_chain
from synth.solver.polynomial_lines import PolynomialLines
from synth.studies.cases import Case, named_cases
from synth.studies.entrance import from_the_entrance
from synth.studies.near_target import near_ratio, near_target
from synth.studies.options import option
from synth.studies.side_by_side import side_by_side
from synth.studies.study import Method, Tell
from synth.studies.tuned_table import lines_of_solution
from synth.studies.unlocked.compact import LINE_NODES, SLOPES_M_S, Compact, Form, fit_surfaces, search, search_locked
from synth.studies.unlocked.evolution import Vector
from synth.studies.unlocked.findings import (
    COMPACT,
    CUBIC,
    ENERGY,
    FITTED,
    LINES,
    PLAIN,
    SEARCHED,
    SURFACES,
    CaseRow,
    Ratio,
    SurfaceMap,
    Told,
    Unlocked,
)
from synth.studies.unlocked.laws import CompactController, SurfaceController
from synth.studies.unlocked.loop import UnlockedLoop, unlocked_loop
from synth.studies.unlocked.solution import UnlockedSolution, solve_unlocked, unlocked_plant
from synth.studies.unlocked.surfaces import SwitchingSurfaces

FRESH, TUNING, TUNING_PASSES, BASELINE_PASSES, FIT_PASSES = 49979687, 67867967, 2000, 1000, 200
PATH_STEP_S, SPEED_STEP_M_S, RESISTANCE_NODES = 0.05, 0.0125, 2
"""Path step by target speed (half a sampling period); speed step at the target; running resistances of a light cut."""

SURFACE_NODES = 60
"""Places of the path at which kept surfaces are told."""


@dataclass(frozen=True)
class Options:
    """What is studied."""

    config: Path | None = option(None, "configuration; the built-in default book without it")
    cases: tuple[str, ...] = option(
        ("22:2", "52:3", "66:3", "85:4", "66:2", "85:2", "85:3"), "mass, t : target, m/s"
    )  # fmt: skip
    valves: tuple[float, ...] = option((1.0,), "times as fast: delays and time constants divided", (0.5, 10.0))
    passes: int = option(20_000, "fresh passes of each controller", (200, 10**6))
    evaluations: int = option(800, "of each direct search", (1, 10**5))
    coarser: float = option(1.0, "times the steps of the grid of the surfaces", (0.5, 8.0))
    shown: str = option("52:3", "case whose surfaces are kept, with the first valves")
    shown_stage: int = option(2, "stage whose surfaces are kept", (0, 7))


@dataclass(frozen=True)
class Bench:
    """One case with its valves: closed loops, passes to search on, locked lines, and the price of things."""

    case: Case
    config: ResolvedConfig
    loop: UnlockedLoop
    rehearsal: RandomPasses
    lines: LineController
    cubics: PolynomialLines
    options: Options

    @property
    def compact_form(self) -> Compact:
        """Cubic in path, linear in pressure."""
        return Compact(self.case.plant.exit_m, Form((self.config.fit.degree, 0)), self.cubics.has_line)

    @property
    def plain_form(self) -> Compact:
        """Cubic in path alone."""
        return Compact(self.case.plant.exit_m, Form((self.config.fit.degree,)), self.cubics.has_line)

    def searched(self, form: Compact, starts: list[Vector]) -> CompactController:
        """The best of `starts`, taken through the direct search."""
        tuning = self.loop.draws(self.rehearsal)
        target, criterion = self.case.target_m_s, self.config.criterion
        vector, _ = search(form, starts, self.loop, tuning, target, criterion, self.options.evaluations)
        return form.controller(vector)


def run(options: Options, tell: Tell) -> Unlocked:
    """All cases with all valves."""
    config = from_the_entrance(options.config)
    seed = config.validation.seed + FRESH
    fresh = stratified_passes(seed, 0, options.passes)

    def row_of(order: tuple[float, str]) -> tuple[CaseRow, SurfaceMap | None]:
        valves, name = order
        (case,) = named_cases(config, (name,))
        kept = name == options.shown and valves == options.valves[0]
        row, surface = studied(replace(case, plant=quicker(case.plant, valves)), valves, config, options, fresh)
        tell(f"{row.case}, valves × {valves:g}: {row.seconds:.0f} s")
        return row, surface if kept else None

    found = side_by_side(row_of, [(valves, name) for valves in options.valves for name in options.cases])
    surface = next((each for _, each in found if each is not None), None)
    rows = tuple(row for row, _ in found)
    return Unlocked(config.sha256, seed, options.passes, options.evaluations, rows, surface)


def quicker(plant: Plant, times: float) -> Plant:
    """`plant` with all delays and time constants of its valves divided."""
    valves = plant.position.pneumatics
    names = [name for name in vars(valves) if name.endswith(("_delay_s", "_constant_s"))]
    faster = replace(valves, **{name: getattr(valves, name) / times for name in names})
    return replace(plant, position=replace(plant.position, pneumatics=faster))


def studied(
    case: Case, valves: float, config: ResolvedConfig, options: Options, fresh: RandomPasses
) -> tuple[CaseRow, SurfaceMap]:
    """All controllers of one case, and its surfaces."""
    started = time.perf_counter()
    bench = bench_of(case, config, options)
    solved = surfaces_of(bench)
    fit = fit_surfaces(bench.compact_form, solved.surfaces, bench.loop, bench.rehearsal.part(0, FIT_PASSES))
    slopes = [bench.compact_form.of_lines(bench.cubics, slope) for slope in SLOPES_M_S]
    compact = bench.searched(bench.compact_form, [fit, *slopes])
    samples = samples_of(bench, solved, fit, compact, fresh)
    target = case.target_m_s
    told = {name: told_of(sample, samples[CUBIC], target) for name, sample in samples.items()}
    others = {name: Ratio(*rms_ratio(samples[COMPACT], samples[name], target)) for name in (SEARCHED, ENERGY, PLAIN)}
    seconds = time.perf_counter() - started
    row = CaseRow(case.name, valves, solved.cost_m2_s2, seconds, told, others)
    return row, surface_map(case, solved.surfaces, compact, options.shown_stage)


def bench_of(case: Case, config: ResolvedConfig, options: Options) -> Bench:
    """The case with its stage-locked lines."""
    rehearsal = random_passes(config.validation.seed + TUNING, 0, TUNING_PASSES)
    solution = solve(persistent_chain(case.plant, config.resolution), Aim(case.target_m_s, config.criterion))
    cubics = lines_of_solution(solution, config.fit.degree)
    return Bench(
        case, config, unlocked_loop(case.plant), rehearsal, LineController(solution.lines), cubics, options
    )  # fmt: skip


def surfaces_of(bench: Bench) -> UnlockedSolution:
    """The unlocked surfaces of the solver."""
    target, coarser = bench.case.target_m_s, bench.options.coarser
    steps = Resolution(
        coarser * PATH_STEP_S * target, coarser * SPEED_STEP_M_S, target, resistance_nodes=RESISTANCE_NODES
    )
    return solve_unlocked(unlocked_plant(bench.case.plant, steps), target, bench.config.criterion)


def samples_of(
    bench: Bench, solved: UnlockedSolution, fit: Vector, compact: CompactController, fresh: RandomPasses
) -> dict[str, ExitSample]:
    """The fresh passes by every controller."""
    case, loop, locked = bench.case, bench.loop, bench.loop.locked
    plain = bench.plain_form
    bare = fit_surfaces(plain, solved.surfaces, loop, bench.rehearsal.part(0, FIT_PASSES))
    without_pressure = bench.searched(plain, [plain.of_lines(bench.cubics, 0.0), bare])
    searched = search_locked(
        bench.cubics, locked, loop.draws(bench.rehearsal), case.target_m_s, bench.config.criterion,
        bench.options.evaluations,
    )  # fmt: skip
    baselines = tune_baselines(common_passes(case.plant, bench.rehearsal.part(0, BASELINE_PASSES)), case.target_m_s)
    energy = next(baseline for baseline in baselines if baseline.name == ENERGY)
    nodes, draws = np.linspace(0.0, case.plant.exit_m, LINE_NODES), loop.draws(fresh)
    return {
        LINES: locked.run(bench.lines, draws),
        CUBIC: locked.run(LineController(bench.cubics.at(nodes)), draws),
        SEARCHED: locked.run(searched, draws),
        SURFACES: loop.run(SurfaceController(solved.surfaces), draws),
        FITTED: loop.run(bench.compact_form.controller(fit), draws),
        COMPACT: loop.run(compact, draws),
        PLAIN: loop.run(without_pressure, draws),
        ENERGY: locked.run(energy.controller, draws),
    }


def told_of(sample: ExitSample, reference: ExitSample, target_m_s: float) -> Told:
    """What is told of one controller."""
    found = exit_statistics(sample, target_m_s)
    return Told(
        found.rms_m_s, found.rms_ci95_m_s, near_target(sample, target_m_s), found.bias_m_s, found.switchings,
        found.stalled, Ratio(*rms_ratio(sample, reference, target_m_s)),
        Ratio(*near_ratio(sample, reference, target_m_s)),
    )  # fmt: skip


def surface_map(case: Case, surfaces: SwitchingSurfaces, compact: CompactController, stage: int) -> SurfaceMap:
    """Both surfaces of one stage at some places of the path, rounded to a tenth of a millimetre a second."""
    pressure, modes = surfaces.of_stage(stage)
    every = np.unique(np.linspace(0, len(surfaces.nodes_m) - 1, SURFACE_NODES).round().astype(int))

    def rows(lines: NDArray[np.float64]) -> tuple[tuple[float | None, ...], ...]:
        return tuple(
            tuple(round(v, 4) if np.isfinite(v) else None for v in row) for row in lines[modes][:, every].tolist()
        )

    def series(side: int) -> tuple[tuple[float, ...], ...] | None:
        powers = compact.coefficients[stage, side]
        return tuple(tuple(row) for row in powers.tolist()) if compact.has_line[stage, side] else None

    return SurfaceMap(
        case.name, case.plant.exit_m, stage, case.plant.position.stage_pressures_kpa[stage],
        surfaces.modes.drive.band_kpa, tuple(surfaces.nodes_m[every].tolist()), tuple(pressure.tolist()),
        rows(surfaces.lower_m_s), rows(surfaces.upper_m_s), (series(0), series(1)),
    )  # fmt: skip


METHOD = Method(Options, Options(None, ("52:3",), (1.0,), 200, 1, 4.0), Unlocked, run)
