"""The way from a problem to a validated table, as a few functions for Python programs and notebooks.

They are thin: each calls the steps that the command line calls, with the same defaults, so the numbers are the same.
What does not fit raises `InputError`, `PlantError` or `TableError`, all of them a `ValueError` with one sentence.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from dataclasses import dataclass, fields, is_dataclass
from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Any, ParamSpec, TypeVar

import numpy as np
from numpy.typing import NDArray

from plant_models.library.near_miss import near_miss
from synth.frame.creation_time import creation_time
from synth.frame.input_error import InputError
from synth.kernels.cache import guarded
from synth.problem.aim import Aim
from synth.problem.problem import Problem
from synth.problem.requirement_found import Finding
from synth.problem.resolution import Resolution, finer_for_check
from synth.retarder.checked_design import checked_design
from synth.retarder.class_setup import origin_of
from synth.retarder.configuration.config_file import load_config as load_config_file
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.retarder.configuration.settings import FitSettings, GridSettings
from synth.retarder.rounded_table import with_prediction
from synth.simulation.closed_loop import TableController, simulate_many
from synth.simulation.closed_loop import trace as trace_of
from synth.simulation.exit_statistics import ExitStatistics, exit_statistics
from synth.simulation.passes import ExitSample, PassTrace
from synth.simulation.stratified_passes import stratified_passes
from synth.solver.backward_induction import Solution
from synth.solver.backward_induction import solve as solve_chain
from synth.solver.chain.chain import Chain, check_chain, persistent_chain
from synth.solver.descent import Descent
from synth.solver.one_blas_thread import one_blas_thread
from synth.solver.polynomial_lines import PolynomialLines
from synth.solver.tabulate import UNPREDICTED
from synth.solver.tabulate import tabulate as tabulate_lines
from tuning_tables import ControllerTable, Predicted
from tuning_tables.canonical import canonical_json

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_P = ParamSpec("_P")
_R = TypeVar("_R")

PASSES, FEWEST_PASSES = 20_000, 1_000
"""Passes of a simulation unless told otherwise, and the fewest that figures with intervals need."""

DEGREE = FitSettings().degree

Config = ResolvedConfig | Path | str | None
"""A configuration, the file that it is in, or None for the built-in one."""


def _as_a_command(call: Callable[_P, _R]) -> Callable[_P, _R]:
    """`call` as a command makes it: with one BLAS thread, and once more where the kernel cache was damaged."""

    @wraps(call)
    def made(*args: _P.args, **kwargs: _P.kwargs) -> _R:
        with one_blas_thread():
            return guarded(call, *args, **kwargs)

    return made


@dataclass(frozen=True)
class FittedLines:
    """Polynomial lines of a problem: those to make a table of, and how they were found.

    `polish`: what the polish came to, `finding`: what a requirement of the criterion took; `check`: the finer chain
    that a table is predicted on.
    """

    problem: Problem
    lines: PolynomialLines
    polish: Descent[PolynomialLines]
    finding: Finding | None
    check: Chain

    def __repr__(self) -> str:
        target = f"{self.problem.target_speed_m_s:g} m/s"
        return f"FittedLines(degree {self.lines.degree}, to {target}, {self.polish.status})"


@dataclass(frozen=True)
class Simulated:
    """Passes of a table in the closed loop; the exits are compared with `target_speed_m_s`."""

    target_speed_m_s: float
    seed: int
    sample: ExitSample

    @property
    def statistics(self) -> ExitStatistics:
        """rms, bias, quantiles, shares, each with its 95 % interval."""
        return exit_statistics(self.sample, self.target_speed_m_s)

    def columns(self) -> dict[str, NDArray[np.generic]]:
        """One array a property of the passes, by name: what `pandas.DataFrame` takes."""
        return dict(vars(self.sample))

    def __repr__(self) -> str:
        found = self.statistics
        low, high = found.rms_ci95_m_s
        rms = f"rms {found.rms_m_s:.4f} [{low:.4f}, {high:.4f}] m/s"
        return f"Simulated({found.passes} passes, seed {self.seed}: {rms}, bias {found.bias_m_s:+.4f} m/s)"


def load_config(path: Path | str | None = None) -> ResolvedConfig:
    """The configuration in the TOML file `path`, or the built-in one."""
    return load_config_file(None if path is None else Path(path))


def resolved(config: Config) -> ResolvedConfig:
    """The configuration itself, read where only its file is given."""
    return config if isinstance(config, ResolvedConfig) else load_config(config)


def load_problem(cut: str, target_m_s: float, config: Config = None) -> Problem:
    """The problem of the cut class `cut` (its label) of `config`, to be left with `target_m_s`.

    The criterion is that of the configuration; the target need not be one of it.
    """
    known = resolved(config)
    plants = dict(known.plants())
    if cut not in plants:
        raise InputError(f"the configuration has no cut class {cut!r}; {near_miss(cut, plants)}")
    return Problem(plants[cut], Aim(target_m_s, known.criterion))


@_as_a_command
def solve(problem: Problem, resolution: Resolution | None = None) -> Solution:
    """The switching lines of `problem`, by backward induction; by default on the grid of the built-in configuration."""
    chain = persistent_chain(problem.plant, resolution or usual_resolution(problem))
    return solve_chain(chain, problem.aim)


@_as_a_command
def fit(solution: Solution, degree: int = DEGREE) -> FittedLines:
    """Polynomial lines of `degree` for a solution: fitted, polished, and made to keep what the criterion requires."""
    problem = Problem(solution.chain.plant, solution.aim)
    check = check_chain(problem.plant, finer_for_check(solution.chain.resolution))
    kept = checked_design(
        solution, check, degree, lambda lines: with_prediction(check, _rounded(problem, lines, "", None))
    ).kept
    return FittedLines(problem, kept.lines, kept.polish, kept.finding, check)


@_as_a_command
def tabulate(lines: FittedLines, name: str = "", config: Config = None) -> ControllerTable:
    """The table of `lines`: rounded as a controller holds it, then predicted.

    `name`: the table's id, by default told from position, mass and target. `config`: the configuration that the problem
    is from, whose hash the table then carries; by default the hash of the problem itself.
    """
    return with_prediction(lines.check, _rounded(lines.problem, lines.lines, name, config)).table


def _rounded(problem: Problem, lines: PolynomialLines, name: str, config: Config) -> ControllerTable:
    """The table of `lines`, not yet predicted; `name` and `config` as of `tabulate`."""
    plant, target = problem.plant, problem.target_speed_m_s
    stamp = origin_of(problem_sha256(problem) if config is None else resolved(config).sha256, creation_time())
    table_id = name or f"{plant.position.name}-{plant.cut.mass_t:g}t-to-{target:g}-m-s"
    return tabulate_lines(plant, lines, target, UNPREDICTED, stamp.generator, table_id, stamp.created)


@_as_a_command
def predict(table: ControllerTable, problem: Problem, resolution: Resolution | None = None) -> Predicted:
    """What `table` comes to on `problem`, computed without sampling; `resolution` is that of the design.

    Where the table has an estimator this is unknown: `simulate` it.
    """
    if table.estimator is not None:
        raise InputError(
            f"{table.id} has an estimator, so its figures cannot be computed without sampling; simulate it"
        )
    check = check_chain(problem.plant, finer_for_check(resolution or usual_resolution(problem)))
    return with_prediction(check, table).table.predicted


@_as_a_command
def simulate(table: ControllerTable, problem: Problem, passes: int = PASSES, seed: int = 1) -> Simulated:
    """`table` in the closed loop with the plant of `problem`: stratified passes 0 … `passes` − 1 of `seed`.

    The same passes as those of a tune or of `retarder-synth validate` with this seed.
    """
    if passes < FEWEST_PASSES:
        raise InputError(f"passes is {passes}; intervals need {FEWEST_PASSES} at least")
    return Simulated(problem.target_speed_m_s, seed, simulate_many(problem.plant, TableController(table), seed, passes))


@_as_a_command
def trace(
    table: ControllerTable, problem: Problem, friction: float | None = None, seed: int = 1, index: int = 0
) -> PassTrace:
    """Pass `index` of `simulate`, event by event; `friction`: factor of the cut instead of the one drawn."""
    drawn = stratified_passes(seed, index, 1)
    return trace_of(problem.plant, TableController(table), drawn, 0, cut_factor=friction)


@_as_a_command
def plot_table(table: ControllerTable, problem: Problem | None = None, seed: int = 1) -> Figure:
    """Lines of `table`, one panel a stage; with a problem also passes of three cuts of different friction."""
    from synth.retarder.pictures.table_picture import drawn_passes, table_lines

    return table_lines(table, None if problem is None else drawn_passes(table, problem.plant, seed))


@_as_a_command
def plot_passes(table: ControllerTable, problem: Problem, seed: int = 1) -> Figure:
    """Three passes over path and time, and the histogram of the exit speeds of 5000."""
    from synth.retarder.pictures.table_picture import drawn_passes, table_passes

    return table_passes(table, drawn_passes(table, problem.plant, seed))


def usual_resolution(problem: Problem) -> Resolution:
    """The grid of the built-in configuration, with the transients of this sensor's sampling period."""
    return GridSettings().resolution_for(problem.plant)


def problem_sha256(problem: Problem) -> str:
    """SHA-256 of the canonical form of everything that `problem` consists of."""
    return hashlib.sha256(canonical_json(tree_of(problem))).hexdigest()


def tree_of(value: Any) -> Any:
    """A value of values as dictionaries and lists, with the names of the types."""
    if is_dataclass(value):
        parts = {field.name: tree_of(getattr(value, field.name)) for field in fields(value)}
        return {"type": type(value).__name__, **parts}
    if isinstance(value, tuple | np.ndarray):
        return [tree_of(part) for part in value]
    return value.item() if isinstance(value, np.generic) else value
