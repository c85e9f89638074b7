"""A table beside the laws that it has to beat."""

from __future__ import annotations

from synth.api.as_a_command import as_a_command
from synth.api.passes import FEWEST_PASSES, PASSES
from synth.frame.input_error import InputError
from synth.problem.problem import Problem
from synth.retarder.class_setup import TUNING_PASSES
from synth.retarder.comparison.compared_laws import compared_laws, permitted
from synth.retarder.comparison.measured import Measured
from synth.simulation.closed_loop import TableController
from synth.simulation.common_passes import common_passes
from synth.simulation.random_passes import random_passes
from synth.simulation.stratified_passes import stratified_passes
from tuning_tables import ControllerTable


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
