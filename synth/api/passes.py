"""What a table is worth: predicted without sampling, simulated, and beside the laws that it has to beat."""

from __future__ import annotations

from dataclasses import dataclass

from synth.api.as_a_command import as_a_command
from synth.api.problems import usual_resolution
from synth.frame.faults import InputError
from synth.problem.problem import Problem
from synth.problem.resolution import Resolution, finer_for_check
from synth.retarder.class_setup import TUNING_PASSES
from synth.retarder.comparison.baselines import compared_laws, permitted
from synth.retarder.comparison.measured import Measured
from synth.retarder.tuned_table import with_prediction
from synth.simulation.closed_loop import TableController, simulate_many
from synth.simulation.closed_loop import trace as trace_of
from synth.simulation.common_passes import common_passes
from synth.simulation.exit_statistics import ExitStatistics, exit_statistics
from synth.simulation.passes import ExitSample, PassTrace
from synth.simulation.random_passes import random_passes
from synth.simulation.stratified_passes import stratified_passes
from synth.solver.chain.chain import check_chain
from tuning_tables import ControllerTable, Predicted

PASSES, FEWEST_PASSES = 20_000, 1_000
"""Passes of a simulation unless told otherwise, and the fewest that figures with intervals need."""

MOST_FRICTION = 5.0
"""No cut has more; the friction of one is drawn around 1."""


@dataclass(frozen=True)
class Simulated:
    """Passes of a table in the closed loop.

    Attributes
    ----------
    target_speed_m_s
        The exit speed that was commanded, m/s.
    seed
        Which passes they are.
    sample
        How each ended, arrays (n,): `exit_speed_m_s` (0 after a stall), `stalled`, `switchings` (commands),
        `transit_time_s`, and `weight`, how many cuts a pass stands for: use it in averages of your own.

    Examples
    --------
    With `problem` and `table` from the example of `tabulate`:

    >>> import synth
    >>> synth.simulate(table, problem, passes=1000)
    Simulated(1000 passes, seed 1: rms 0.0329 [0.0309, 0.0350] m/s, bias +0.0079 m/s)
    """

    target_speed_m_s: float
    seed: int
    sample: ExitSample

    @property
    def statistics(self) -> ExitStatistics:
        """Rms, bias, quantiles and shares of the exit-speed error, each with its 95 % interval.

        Examples
        --------
        With `problem` and `table` from the example of `tabulate`:

        >>> import synth
        >>> found = synth.simulate(table, problem, passes=1000).statistics
        >>> found.passes, round(found.rms_m_s, 3), [round(end, 3) for end in found.rms_ci95_m_s]
        (1000, 0.033, [0.031, 0.035])
        """
        return exit_statistics(self.sample, self.target_speed_m_s)

    def __repr__(self) -> str:
        found = self.statistics
        return f"Simulated({found.passes} passes, seed {self.seed}: {found.rms_text}, bias {found.bias_m_s:+.4f} m/s)"


@as_a_command
def predict(table: ControllerTable, problem: Problem, resolution: Resolution | None = None) -> Predicted:
    """Compute what a table comes to on a plant, without sampling.

    Parameters
    ----------
    table
        A table of lines without an estimator.
    problem
        The plant that it runs on.
    resolution
        The grid of the design, or None for that of the built-in configuration. The prediction takes a finer one.

    Returns
    -------
    Predicted
        Rms and bias of the exit-speed error, over-speed, commands and stalls.

    Raises
    ------
    InputError
        The table has an estimator: its figures cannot be computed so; `simulate` it.
    PlantError
        The grid does not fit the plant.

    Notes
    -----
    The law of the state is carried forward over the path; see the page "Method", sections 5 and 7.

    Examples
    --------
    With `problem` and `table` from the example of `tabulate`:

    >>> import synth
    >>> synth.predict(table, problem, coarse) == table.predicted
    True
    """
    if table.estimator is not None:
        raise InputError(
            f"{table.id} has an estimator, so its figures cannot be computed without sampling; simulate it"
        )
    check = check_chain(problem.plant, finer_for_check(resolution or usual_resolution(problem)))
    return with_prediction(check, table).table.predicted


@as_a_command
def simulate(table: ControllerTable, problem: Problem, passes: int = PASSES, seed: int = 1) -> Simulated:
    """Run a table in the closed loop with the plant of a problem.

    Parameters
    ----------
    table
        Any table of lines; it is run as it is, whatever plant it was made for.
    problem
        The plant, and the target that exits are compared with.
    passes
        How many, 1000 at least. They are stratified, as those of `retarder-synth validate`, and the same with the
        same seed.
    seed
        Which passes, 0 or more.

    Returns
    -------
    Simulated
        The passes, and the figures of their exits.

    Raises
    ------
    InputError
        Fewer passes than intervals need.
    ValueError
        A negative seed, or a table with stages that the position lacks.

    Examples
    --------
    With `problem` and `table` from the example of `tabulate`:

    >>> import synth
    >>> passes = synth.simulate(table, problem, passes=1000, seed=2)
    >>> passes.statistics.stalled
    0.0
    """
    if passes < FEWEST_PASSES:
        raise InputError(f"passes is {passes}; intervals need {FEWEST_PASSES} at least")
    return Simulated(problem.target_speed_m_s, seed, simulate_many(problem.plant, TableController(table), seed, passes))


@as_a_command
def trace(
    table: ControllerTable, problem: Problem, friction: float | None = None, seed: int = 1, index: int = 0
) -> PassTrace:
    """Run one pass of `simulate`, and keep everything that happens in it.

    Parameters
    ----------
    table
        The table.
    problem
        The plant.
    friction
        Friction factor of the cut, 0 to 5 (1: as usual), in place of the one that was drawn.
    seed, index
        Pass `index`, from 0 on, of those that `simulate` runs with this seed.

    Returns
    -------
    PassTrace
        The pass, event by event.

    Raises
    ------
    InputError
        A friction factor that no cut has.
    ValueError
        A negative seed or index, or a table with stages that the position lacks.

    Examples
    --------
    With `problem` and `table` from the example of `tabulate`:

    >>> import synth
    >>> one = synth.trace(table, problem, friction=0.8)
    >>> one.stalled, bool(one.exit_speed_m_s == one.speed_m_s[-1])
    (False, True)
    """
    if friction is not None and not 0.0 <= friction <= MOST_FRICTION:
        raise InputError(f"friction is {friction!r}; it must be a factor from 0 to {MOST_FRICTION:g}")
    drawn = stratified_passes(seed, index, 1)
    return trace_of(problem.plant, TableController(table), drawn, 0, cut_factor=friction)


@as_a_command
def compare_with_baselines(
    table: ControllerTable, problem: Problem, passes: int = PASSES, seed: int = 1
) -> tuple[Measured, ...]:
    """Tune classical laws for a problem, and run them on the passes of a table.

    Parameters
    ----------
    table
        The table.
    problem
        The plant, and the target that exits are compared with.
    passes, seed
        As of `simulate`. The laws are tuned on other passes.

    Returns
    -------
    tuple of Measured
        The relay and the energy rule, each with `name`, `statistics`, and `table_ratio`: rms of the table over rms of
        the law on the same passes, with its 95 % interval `table_ratio_ci95`. Below 1 the table is better.

    Raises
    ------
    InputError
        Fewer passes than intervals need.

    Examples
    --------
    With `problem` and `table` from the example of `tabulate`:

    >>> import synth
    >>> for law in synth.compare_with_baselines(table, problem, passes=1000):
    ...     print(law.name, law.table_ratio < 1.0)
    relay True
    energy rule True
    """
    if passes < FEWEST_PASSES:
        raise InputError(f"passes is {passes}; intervals need {FEWEST_PASSES} at least")
    common, target = common_passes(problem.plant, stratified_passes(seed, 0, passes)), problem.target_speed_m_s
    rehearsal = common.of_others(random_passes(seed + 1, 0, TUNING_PASSES))
    sample = common.run(TableController(table))
    laws = compared_laws(rehearsal, common, sample, target, permitted(table))
    return tuple(law.measured for law in laws)
