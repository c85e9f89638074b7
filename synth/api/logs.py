"""Measured passes of a position, and what they say of its numbers."""

from __future__ import annotations

import warnings
from pathlib import Path

from plant_models.pressure_regulator import USUAL_NOISE_KPA, PressureGauge
from synth.api.as_a_command import as_a_command
from synth.api.problems import Config, resolved
from synth.frame.machine import available
from synth.logs.fitting_passes import FittingPasses, loaded_passes
from synth.logs.identify import Identified, require_enough
from synth.logs.identify import identify as identify_passes
from synth.problem.problem import Problem
from synth.simulation.closed_loop import TableController
from synth.simulation.sampled_pass import logged_passes
from tuning_tables import ControllerTable
from tuning_tables.pass_log import PassLog

USUAL_GAUGE = PressureGauge(USUAL_NOISE_KPA)


def load_passes(*logs: Path | str, config: Config = None, mapping: Path | str | None = None) -> FittingPasses:
    """Read the measured passes of one position.

    Parameters
    ----------
    *logs
        Files (.csv, .txt, .h5, .hdf5), or folders of such files.
    config
        The configuration of the position, its file, or None for the built-in one.
    mapping
        A file that names foreign columns.

    Returns
    -------
    FittingPasses
        The sound passes, each with its cut class; `log` is all of them as arrays.

    Warns
    -----
    UserWarning
        A sentence for each file and each pass that is left out.

    Raises
    ------
    InputError
        No pass is sound, or no cut class fits one.

    Examples
    --------
    With `problem` and `table` from the example of `tabulate`:

    >>> import synth
    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> from tuning_tables.pass_log import write_log
    >>> with TemporaryDirectory() as folder:
    ...     write_log(
    ...         synth.log_passes(table, problem, passes=3), Path(folder, "passes.csv")
    ...     )
    ...     passes = synth.load_passes(folder)
    >>> len(passes)
    3
    """

    def warn(sentence: str) -> None:
        warnings.warn(sentence, stacklevel=4)

    known, names = resolved(config), None if mapping is None else Path(mapping)
    return loaded_passes([Path(log) for log in logs], names, known, "the configuration", warn)


@as_a_command
def identify(passes: FittingPasses, config: Config = None) -> Identified:
    """Estimate the numbers of a position from its measured passes.

    Parameters
    ----------
    passes
        40 passes or more, as `load_passes` gives them.
    config
        The configuration that they were loaded with.

    Returns
    -------
    Identified
        `findings`: each number with its 95 % interval and whether the passes tell it; `tests` and `wrong`: whether the
        model holds; `reasons`: why some numbers cannot be told.

    Raises
    ------
    InputError
        Too few passes.

    Notes
    -----
    Maximum likelihood with sandwich intervals; see the page on `identify`.

    Examples
    --------
    With `problem` and `table` from the example of `tabulate`:

    >>> import synth
    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> from tuning_tables.pass_log import write_log
    >>> with TemporaryDirectory() as folder:
    ...     write_log(
    ...         synth.log_passes(table, problem, passes=40), Path(folder, "passes.csv")
    ...     )
    ...     found = synth.identify(synth.load_passes(folder))
    >>> noise = next(
    ...     finding for finding in found.findings if finding.key == "sensor.noise_m_s"
    ... )
    >>> noise.interval[0] < problem.plant.sensor.noise_m_s < noise.interval[1]
    True
    """
    require_enough(passes)
    return identify_passes(passes, resolved(config), available())


@as_a_command
def log_passes(
    table: ControllerTable,
    problem: Problem,
    passes: int = 100,
    seed: int = 1,
    gauge: PressureGauge | None = USUAL_GAUGE,
) -> PassLog:
    """Simulate passes as a controller would log them, to try things before there is a log.

    Parameters
    ----------
    table
        The table that the controller runs.
    problem
        The plant, and the target that is logged.
    passes
        How many, 1 or more; as cuts come, not stratified.
    seed
        Which passes.
    gauge
        The pressure gauge on the drive, or None for none.

    Returns
    -------
    tuning_tables.pass_log.PassLog
        A row at every sample of the sensor. `tuning_tables.pass_log.write_log` writes it.

    Raises
    ------
    ValueError
        No pass is asked for, a negative seed, or a table with stages that the position lacks.

    Examples
    --------
    With `problem` and `table` from the example of `tabulate`:

    >>> import synth
    >>> log = synth.log_passes(table, problem, passes=3)
    >>> log
    PassLog(3 passes, 334 rows)
    """
    return logged_passes(problem.plant, TableController(table), problem.target_speed_m_s, seed, 0, passes, gauge)
