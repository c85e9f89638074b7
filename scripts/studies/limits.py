"""What limits the accuracy: sources of error and of delay switched off or changed one at a time.

For every change the lines are designed anew, knowing of it, and simulated on the same fresh passes: so what is told is
what the source costs a controller that knows of it, not what a surprise does. One cut in a thousand saturates the brake
and leaves far too fast, whatever the lines; so the rms of the others stands first.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from plant_models import Plant
from scripts.studies.cases import THOROUGH, Case, named_cases, side_by_side, simulate_told, thorough, told_friction
from scripts.studies.near_target import NEAR_M_S, NearTarget, near_target
from scripts.studies.study import Findings, MarkdownTable, Method, Tell, around, option, table
from synth.problem.criterion import Criterion
from synth.problem.problem import Aim
from synth.retarder.checked_design import finer
from synth.retarder.configuration.config_file import load_config
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.retarder.estimation.estimated_lines import estimate_chain, estimated_lines
from synth.retarder.estimation.estimated_table import controller_of
from synth.retarder.estimation.tuning_days import tuning_days
from synth.simulation.closed_loop import LineController, simulate
from synth.simulation.passes import ExitSample
from synth.simulation.random_passes import RandomPasses, random_passes
from synth.simulation.replicates import rms_of
from synth.simulation.stratified_passes import stratified_passes
from synth.solver.backward_induction import solve
from synth.solver.chain.chain import persistent_chain
from synth.solver.switching_lines import PolynomialLines
from synth.solver.told_lines import Effort
from synth.solver.tuned_lines import tuned_lines

QUIET_M_S, STEP_SHARE = 0.02, 0.65
"""Noise of the quiet sensor, and how much of it the speed grid's step may be."""

FREE_DEGREE = 9
FASTER = 4.0
NO_SPREAD_CV = 0.01


@dataclass(frozen=True)
class Change:
    """A plant that lacks one source; `degree` of its lines; the speed step that a quieter sensor needs."""

    name: str
    plant: Plant
    degree: int
    speed_step_m_s: float | None = None


def changes(plant: Plant, degree: int) -> tuple[Change, ...]:
    """What is switched off or changed, one at a time, the plant as it is first."""
    sensor, drive = plant.sensor, plant.position.pneumatics
    names = ("brake_delay_s", "touch_delay_s", "release_delay_s", "fill_time_constant_s", "exhaust_time_constant_s")
    fast = replace(drive, **{name: getattr(drive, name) / FASTER for name in names})
    even = replace(plant.friction, common_cv=NO_SPREAD_CV)
    smooth = replace(plant.friction, path_std=0.0)
    quiet = replace(sensor, noise_m_s=QUIET_M_S, resolution_m_s=0.0)
    often = replace(sensor, sample_period_s=sensor.sample_period_s / 2)
    prompt = replace(sensor, computing_delay_s=0.0)
    rolling = replace(plant.resistance, std_n_per_kn=0.0)
    return (
        Change("as it is", plant, degree),
        Change(f"lines of degree {FREE_DEGREE}", plant, FREE_DEGREE),
        Change("no spread of friction between cuts", replace(plant, friction=even), degree),
        Change("no friction noise along the path", replace(plant, friction=smooth), degree),
        Change("no spread of rolling resistance", replace(plant, resistance=rolling), degree),
        Change("sampled twice as often", replace(plant, sensor=often), degree),
        Change("no computing delay", replace(plant, sensor=prompt), degree),
        Change(f"measured speed with {QUIET_M_S:g} m/s of noise", replace(plant, sensor=quiet), degree,
               STEP_SHARE * QUIET_M_S),
        Change("valves four times as fast", replace(plant, position=replace(plant.position, pneumatics=fast)), degree),
    )  # fmt: skip


FRESH, TUNING, TUNING_PASSES = 49979687, 32452843, 3000
LINE_NODES = 301


@dataclass(frozen=True)
class Options:
    """What is studied."""

    config: Path | None = option(None, "configuration; the built-in default book without it")
    cases: tuple[str, ...] = option(("22:2", "22:3", "52:3", "85:4"), "mass, t : target, m/s")
    passes: int = option(20_000, "passes of each change", (200, 10**7))
    told_nodes: int = option(THOROUGH.frictions, "factors of friction with lines of their own", (1, 31))
    told_iterations: int = option(THOROUGH.iterations[0], "of a polish with the friction told", (1, 10_000))


@dataclass(frozen=True)
class Row:
    """One change in one case: rms of all passes, and of those near the target."""

    case: str
    change: str
    rms_m_s: float
    near: NearTarget


@dataclass(frozen=True)
class Limits(Findings):
    """All changes of all cases."""

    config_sha256: str
    seed: int
    passes: int
    rows: tuple[Row, ...]

    def tables(self) -> Mapping[str, MarkdownTable]:
        """`changes`: a row a change, a column a case."""
        cases = tuple(dict.fromkeys(row.case for row in self.rows))
        names = tuple(dict.fromkeys(row.change for row in self.rows))
        cells = {(row.case, row.change): cell(row) for row in self.rows}
        rows = [(name, *(cells[case, name] for case in cases)) for name in names]
        title = f"rms within {NEAR_M_S:g} m/s of the target [95 %], mm/s; rms of all, share outside"
        return {"changes": table(title, ("change", *cases), rows)}

    def sentences(self) -> tuple[str, ...]:
        """How much was simulated."""
        return (f"{self.passes} stratified passes each, seed {self.seed}",)


def cell(row: Row) -> str:
    """'31.9 [31.5, 32.4]; 41, 0.08 %'."""
    near = around(row.near.rms_m_s, row.near.ci95_m_s, 1, 1e3)
    return f"{near}; {1e3 * row.rms_m_s:.0f}, {100.0 * row.near.outside:.2f} %"


def run(options: Options, tell: Tell) -> Limits:
    """Design anew for every change, and simulate."""
    config = load_config(options.config)
    seed = config.validation.seed + FRESH
    passes = stratified_passes(seed, 0, options.passes)
    effort = thorough(options.told_nodes, options.told_iterations)

    def rows_of(case: Case) -> list[Row]:
        rows = [changed(case, change, config, passes) for change in changes(case.plant, config.fit.degree)]
        rows.append(told(case, config, passes, effort))
        rows.append(estimated(case, config, passes))
        tell(f"{case.name}: {len(rows)} changes")
        return rows

    found = side_by_side(rows_of, named_cases(config, options.cases))
    return Limits(config.sha256, seed, options.passes, tuple(row for rows in found for row in rows))


def free(config: ResolvedConfig) -> Criterion:
    """The criterion of `config` without a price on switchings."""
    return replace(config.criterion, switching_tolerance_m2_s2=0.0)


def changed(case: Case, change: Change, config: ResolvedConfig, passes: RandomPasses) -> Row:
    """Lines designed for the changed plant, simulated on it."""
    resolution = config.resolution
    if change.speed_step_m_s is not None:
        resolution = replace(resolution, speed_step_m_s=min(resolution.speed_step_m_s, change.speed_step_m_s))
    design = finer(persistent_chain(change.plant, resolution))  # without a spread the polish would live on the grid
    lines = tuned_lines(design, Aim(case.target_m_s, free(config)), change.degree).best
    return simulated(case, change, controller_for(case, lines), passes)


def controller_for(case: Case, lines: PolynomialLines) -> LineController:
    """The regulator of these lines."""
    return LineController(lines.at(lines.nodes_m(LINE_NODES)))


def simulated(case: Case, change: Change, controller: LineController, passes: RandomPasses) -> Row:
    """Errors of simulated passes on the changed plant."""
    return row_of(case, change.name, simulate(change.plant, controller, passes))


def row_of(case: Case, change: str, sample: ExitSample) -> Row:
    """Errors of a sample."""
    rms = rms_of(sample.exit_speed_m_s - case.target_m_s, sample.weight)[0]
    return Row(case.name, change, rms, near_target(sample, case.target_m_s))


def told(case: Case, config: ResolvedConfig, passes: RandomPasses, effort: Effort) -> Row:
    """The regulator is told the friction of every cut."""
    quiet = replace(config.resolution, speed_step_m_s=min(config.resolution.speed_step_m_s, QUIET_M_S))
    design = persistent_chain(case.plant, quiet)
    found = told_friction(design, case.target_m_s, config.fit.degree, effort)
    return row_of(case, "told the friction of every cut", simulate_told(case.plant, found, passes))


def estimated(case: Case, config: ResolvedConfig, passes: RandomPasses) -> Row:
    """Lines for the estimated speed, with the estimator."""
    tuning = random_passes(config.validation.seed + TUNING, 0, TUNING_PASSES)
    chain = estimate_chain(case.plant, config.resolution, case.target_m_s)
    solution = solve(chain, Aim(case.target_m_s, free(config)))
    days = tuning_days(case.plant, tuning)
    _, made = estimated_lines(case.plant, solution, config.fit.degree, tuning, days)
    change = Change("with the estimator", case.plant, config.fit.degree)
    return simulated(case, change, controller_of(made.lines, made.estimator), passes)


METHOD = Method(Options, Options(cases=("52:3",), passes=400, told_nodes=1, told_iterations=1), Limits, run)
