"""Pictures of a table."""

from __future__ import annotations

from typing import TYPE_CHECKING

from synth.api.as_a_command import as_a_command
from synth.problem.problem import Problem
from tuning_tables import ControllerTable

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
