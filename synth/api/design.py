"""From a problem to its table: the steps that the command line takes, with the same defaults, to the same numbers."""

from __future__ import annotations

from dataclasses import dataclass

from synth.api.as_a_command import as_a_command
from synth.api.problems import Config, load_problem, problem_sha256, resolved, usual_resolution
from synth.frame.faults import InputError
from synth.frame.version import creation_time
from synth.problem.problem import Problem
from synth.problem.requirement import Finding
from synth.problem.resolution import Resolution, finer_for_check
from synth.retarder.checked_design import checked_design
from synth.retarder.class_setup import class_setup, origin_of, validation_passes
from synth.retarder.configuration.settings import FitSettings
from synth.retarder.tuned_table import solutions, tuned_table, with_prediction
from synth.solver.backward_induction import Solution
from synth.solver.backward_induction import solve as solve_chain
from synth.solver.chain.chain import Chain, check_chain, persistent_chain
from synth.solver.descent import Descent
from synth.solver.switching_lines import PolynomialLines
from synth.solver.tabulate import UNPREDICTED
from synth.solver.tabulate import tabulate as tabulate_lines
from tuning_tables import ControllerTable
from tuning_tables.stage import HIGHEST_DEGREE

DEGREE = FitSettings().degree


@dataclass(frozen=True)
class FittedLines:
    """Polynomial lines of a problem, as `fit` found them.

    Attributes
    ----------
    problem
        What they are for.
    lines
        The polynomials; `lines.degree` is their degree.
    polish
        How they were polished: `polish.status` in words.
    finding
        What a requirement of the criterion took; None without a requirement.
    check
        The finer chain that a table is predicted on.

    Examples
    --------
    With `lines` from the example of `tabulate`:

    >>> lines.lines.degree, lines.finding
    (2, None)
    """

    problem: Problem
    lines: PolynomialLines
    polish: Descent[PolynomialLines]
    finding: Finding | None
    check: Chain

    def __repr__(self) -> str:
        target = f"{self.problem.target_speed_m_s:g} m/s"
        return f"FittedLines(degree {self.lines.degree}, to {target}, {self.polish.status})"


@as_a_command
def solve(problem: Problem, resolution: Resolution | None = None) -> Solution:
    """Find the switching lines of a problem by stochastic dynamic programming.

    Parameters
    ----------
    problem
        Plant and aim.
    resolution
        The grid, or None for that of the built-in configuration.

    Returns
    -------
    Solution
        The best policy on the grid, as lines over the path.

    Raises
    ------
    PlantError
        The grid is too coarse or too large for the plant.

    Notes
    -----
    Backward induction over the quanta of the path; see the page "Method", sections 3 and 4.

    Examples
    --------
    With `problem` and `coarse` from the example of `tabulate`:

    >>> import synth
    >>> synth.solve(problem, coarse)
    Solution(to 3 m/s, 42 nodes of the path, 3 stages)
    """
    chain = persistent_chain(problem.plant, resolution or usual_resolution(problem))
    return solve_chain(chain, problem.aim)


@as_a_command
def fit(solution: Solution, degree: int = DEGREE) -> FittedLines:
    """Fit polynomials to a solution, and polish them until their expected cost is least.

    Parameters
    ----------
    solution
        What `solve` found.
    degree
        Degree of the polynomials, 0 to 9.

    Returns
    -------
    FittedLines
        Lines that keep what the criterion requires. Where the grid of the solution proves too coarse for them, they are
        designed again on a finer one.

    Raises
    ------
    InputError
        A degree that no table has.
    PlantError
        The finer grid is too coarse as well.
    InvalidTable
        Rounding to float32 would let two lines touch.

    Examples
    --------
    With `problem` and `solution` from the example of `tabulate`:

    >>> import synth
    >>> lines = synth.fit(solution, degree=2)
    >>> lines.problem == problem
    True
    """
    if not 0 <= degree <= HIGHEST_DEGREE:
        raise InputError(f"degree is {degree}; it must be a whole number from 0 to {HIGHEST_DEGREE}")
    problem = Problem(solution.chain.plant, solution.aim)
    check = check_chain(problem.plant, finer_for_check(solution.chain.resolution))
    kept = checked_design(
        solution, check, degree, lambda lines: with_prediction(check, _rounded(problem, lines, "", None))
    ).kept
    return FittedLines(problem, kept.lines, kept.polish, kept.finding, check)


@as_a_command
def tabulate(lines: FittedLines, name: str = "", config: Config = None) -> ControllerTable:
    """Round lines as a controller holds them, and predict what the table comes to.

    Parameters
    ----------
    lines
        What `fit` found.
    name
        The id of the table. By default it is made of position, mass and target.
    config
        The configuration that the problem is from, whose hash the table then carries. By default it carries the hash
        of the problem.

    Returns
    -------
    ControllerTable
        The table with its prediction, not simulated yet.

    Raises
    ------
    InvalidTable
        Rounding to float32 would let two lines touch.

    Examples
    --------
    >>> import synth
    >>> problem = synth.load_problem("gondola-4-22t", target_m_s=3.0)
    >>> coarse = synth.Resolution(
    ...     path_step_m=1.0, speed_step_m_s=0.05, friction_nodes=2, resistance_nodes=1
    ... )
    >>> solution = synth.solve(problem, coarse)  # coarse: for an example that is quick
    >>> lines = synth.fit(solution, degree=2)
    >>> table = synth.tabulate(lines)
    >>> table.id, round(table.predicted.rms_m_s, 3)
    ('knp-5-bunch-22t-to-3-m-s', 0.035)
    """
    return with_prediction(lines.check, _rounded(lines.problem, lines.lines, name, config)).table


@as_a_command
def tune(cut: str, target_m_s: float, config: Config = None) -> ControllerTable:
    r"""Make a table as the command `tune` makes it, with everything that the configuration permits its regulator.

    That is `solve`, `fit` and `tabulate` in one; and, where the configuration asks for them, an estimator of speed and
    friction, and commands at any time.

    Parameters
    ----------
    cut
        The label of the cut class.
    target_m_s
        The commanded exit speed, m/s.
    config
        A configuration, its file, or None for the built-in one.

    Returns
    -------
    ControllerTable
        The table with its prediction, not simulated yet.

    Raises
    ------
    InputError
        There is no such class, or the file is at fault.
    PlantError
        Plant, target and grid do not fit each other.
    InvalidTable
        Rounding to float32 would let two lines touch.

    Examples
    --------
    >>> import synth
    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     plain = Path(folder, "plain.toml")
    ...     _ = plain.write_text("regulator.estimator = false\n")
    ...     synth.tune("gondola-4-52t", 3.0, plain)
    ControllerTable(gondola-4-52t-to-3-m-s: degree 3, 5 stages, predicted rms 0.02... m/s)
    """
    known = resolved(config)
    problem = load_problem(cut, target_m_s, known)
    origin = origin_of(known.sha256, creation_time())
    setup = class_setup(known, cut, problem.plant, validation_passes(known), origin)
    (solution,) = solutions(setup.design, [problem.aim])
    return tuned_table(setup, solution).table


def _rounded(problem: Problem, lines: PolynomialLines, name: str, config: Config) -> ControllerTable:
    """The table of `lines`, not yet predicted; `name` and `config` as of `tabulate`."""
    plant, target = problem.plant, problem.target_speed_m_s
    stamp = origin_of(problem_sha256(problem) if config is None else resolved(config).sha256, creation_time())
    table_id = name or f"{plant.position.name}-{plant.cut.mass_t:g}t-to-{target:g}-m-s"
    return tabulate_lines(plant, lines, target, UNPREDICTED, stamp.generator, table_id, stamp.created)
