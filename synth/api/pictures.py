"""Pictures of tables and results."""

from __future__ import annotations

from typing import TYPE_CHECKING

from synth.api.as_a_command import as_a_command
from synth.frame.exhibits import Chart, exhibits_of
from synth.hump.trains.humped_trial import HumpedTrial
from synth.logs.identify import Identified
from synth.problem.problem import Problem
from tuning_tables import ControllerTable
from tuning_tables.aim import AimTables

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@as_a_command
def plot_table(table: ControllerTable, problem: Problem | None = None, seed: int = 1) -> Figure:
    """Draw the lines of a table over the path, one panel a stage.

    Parameters
    ----------
    table
        The table.
    problem
        A plant: passes of three cuts of different friction are drawn, too.
    seed
        Which passes.

    Returns
    -------
    matplotlib.figure.Figure
        A figure of its own; `savefig` writes it.

    Examples
    --------
    With `problem` and `table` from the example of `tabulate`:

    >>> import synth
    >>> type(synth.plot_table(table)).__name__
    'Figure'
    """
    from synth.retarder.pictures.table_picture import drawn_passes, table_lines

    return table_lines(table, None if problem is None else drawn_passes(table, problem.plant, seed))


@as_a_command
def plot_passes(table: ControllerTable, problem: Problem, seed: int = 1) -> Figure:
    """Draw three passes over path and time, and the histogram of the exit speeds of 5000.

    Parameters
    ----------
    table
        The table.
    problem
        The plant that it runs on.
    seed
        Which passes.

    Returns
    -------
    matplotlib.figure.Figure
        A figure of its own; `savefig` writes it.

    Examples
    --------
    With `problem` and `table` from the example of `tabulate`:

    >>> import synth
    >>> synth.plot_passes(table, problem).axes[0].get_xlabel()
    'path of the first axle, m'
    """
    from synth.retarder.pictures.table_picture import drawn_passes, table_passes

    return table_passes(table, drawn_passes(table, problem.plant, seed))


@as_a_command
def figures(result: Identified | HumpedTrial | AimTables) -> dict[str, Figure]:
    """Draw every picture that a command shows of a result.

    Parameters
    ----------
    result
        What `identify`, `hump_trains` or `aim_tables` gives.

    Returns
    -------
    dict of matplotlib.figure.Figure
        By the names that the files of the command have.

    Raises
    ------
    TypeError
        Something else was given.

    Examples
    --------
    >>> import synth
    >>> trains = synth.hump_trains(synth.load_trial("dumper"), trains=2)
    >>> sorted(synth.figures(trains))[:2]
    ['hump-contacts', 'hump-couplings']
    """
    match result:
        case Identified():
            from synth.logs.identify_shown import numbers

            exhibits = numbers(result)
        case HumpedTrial():
            from synth.hump.trains.simulate_command import COMMAND

            exhibits = exhibits_of(tuple(COMMAND.show(result)))
        case AimTables():
            from synth.aim.pictures import aim_figures

            return dict(aim_figures(result.tables))
        case _:
            raise TypeError(f"{type(result).__name__} is no result with pictures; see help(synth.figures)")
    return {each.name: each.draw() for each in exhibits if isinstance(each, Chart)}
