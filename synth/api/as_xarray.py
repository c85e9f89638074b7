"""Tables and passes as datasets of xarray: every array with its axes, its unit and what it is, as they are declared."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Final, TypeAlias

import numpy as np
from numpy.typing import NDArray

from plant_models.frozen_arrays import Floats
from synth.api.passes import Simulated
from synth.frame.faults import InputError
from synth.logs.fitting_passes import FittingPasses
from synth.simulation.passes import PassTrace
from synth.solver.tabulate import lines_of
from tuning_tables import ControllerTable
from tuning_tables.aim import AimTable
from tuning_tables.book_layout import AXES, COORDINATES, book_layout
from tuning_tables.declared.columns import columns_of, told_sections
from tuning_tables.document import StageTable
from tuning_tables.pass_log import PassLog
from tuning_tables.pass_log.pass_log import PASSES, ROWS
from tuning_tables.passages.passage_table import PassageTable
from tuning_tables.units import NO_UNIT, ending_of, unit_of

if TYPE_CHECKING:
    import xarray

Labelled: TypeAlias = StageTable | AimTable | Sequence[StageTable] | Simulated | PassTrace | PassLog | FittingPasses
"""What has arrays with axes."""

Variable: TypeAlias = tuple[tuple[str, ...], NDArray[Any], dict[str, str]]
"""Axes, values, and attributes."""

PATH: Final = "path_m"
PATHS_A_METRE: Final = 10
"""At how many places of each metre lines are told."""


def to_xarray(value: Labelled) -> xarray.Dataset:
    """Give a table or passes as a dataset of xarray, with units in its attributes.

    Parameters
    ----------
    value
        A table; or several with switching lines, or several for point sensors; what `simulate`, `trace` or `log_passes`
        gives; measured passes.

    Returns
    -------
    xarray.Dataset
        Each variable has the attributes `long_name` and, where it has a unit, `units`, as UDUNITS writes them.

        Of tables with lines and for point sensors everything that they hold, as in an HDF5 book; several lie along
        `table`, by their ids. Lines besides as speeds over `path_m` and `stage`: `lower_m_s` and `upper_m_s`, NaN where
        there is none; in tables with slopes they are those of a silent gauge. The attribute `config_sha256` is
        the hash of the configuration. Of an aim table everything over `cars`, `free_distance_m` and, where it was
        measured, `resistance_n_per_kn`. Simulated passes lie along `pass_number`, those of a log along `pass_number`
        and `sample`, NaN behind their last; a trace lies along `event`.

    Raises
    ------
    InputError
        xarray is not installed.
    InvalidTable
        Tables of two kinds, or an id that two of them have.

    Examples
    --------
    With `problem` and `table` from the example of `tabulate`:

    >>> import synth
    >>> lines = synth.to_xarray(table)
    >>> lines.upper_m_s.dims, lines.upper_m_s.attrs["units"], lines.path_m.attrs["units"]
    (('stage', 'path_m'), 'm/s', 'm')
    >>> speed = lines.upper_m_s.sel(stage=1).interp(path_m=5.0)
    >>> bool(speed > problem.target_speed_m_s)
    True
    """
    require_installed("to_xarray")
    import xarray

    match value:
        case ControllerTable() | PassageTable():
            return to_xarray([value]).isel(table=0)
        case [ControllerTable() | PassageTable(), *_]:
            hashes = dict.fromkeys(table.generator.config_sha256 for table in value)
            found = xarray.Dataset(table_variables(value), attrs={"config_sha256": ", ".join(hashes)})
            return found.set_index(table="id").set_coords(COORDINATES[1:])
        case AimTable():
            variables = dict(aim_variables(value))
            return xarray.Dataset(variables, attrs={"config_sha256": value.generator.config_sha256})
        case Simulated():
            return xarray.Dataset(named(vars(value.sample), ("pass_number",)))
        case PassTrace():
            arrays = dict(vars(value))
            stalled = named({"stalled": arrays.pop("stalled")}, ())
            return xarray.Dataset({**named(arrays, ("event",)), **stalled}).set_coords("time_s")
        case FittingPasses():
            return to_xarray(value.log)
        case PassLog():
            rows = named({name: by_sample(value, getattr(value, name)) for name in ROWS}, ("pass_number", "sample"))
            passes = {name: np.asarray(getattr(value, name)) for name in PASSES}
            return xarray.Dataset({**rows, **named(passes, ("pass_number",))}).set_coords("cut_id")
    raise TypeError(f"{type(value).__name__} is neither a table nor passes; see help(synth.to_xarray)")


def require_installed(name: str) -> None:
    """`InputError` from the function `name` where the libraries of the extra [xarray] are not there."""
    try:
        import xarray  # noqa: F401
    except ImportError:
        raise InputError(f"{name} needs xarray: pip install 'retarder-synth[xarray]'") from None


def named(arrays: Mapping[str, NDArray[Any]], axes: tuple[str, ...]) -> dict[str, Variable]:
    """Variables along `axes` whose names tell their units; copies, as those of results are read-only."""
    return {name: (axes, np.array(array), told(unit_of(name), words(name))) for name, array in arrays.items()}


def told(unit: str, meaning: str) -> dict[str, str]:
    """Attributes by the conventions CF: what has no unit has no such attribute."""
    return {"long_name": meaning} if unit == NO_UNIT else {"units": unit, "long_name": meaning}


def words(name: str) -> str:
    """A name without its unit, in words."""
    return name.removesuffix(f"_{ending_of(name)}").replace("_", " ")


def table_variables(tables: Sequence[StageTable]) -> dict[str, Variable]:
    """Everything that tables of one kind hold, each axis as a variable of its name, and switching lines as speeds."""
    layout = book_layout(tables)
    arrays = layout.arrays_of(tables)
    variables: dict[str, Variable] = {
        axis: ((axis,), np.arange(layout.length(axis, arrays)), {"long_name": axis, "comment": AXES[axis]})
        for axis in layout.axes
        if axis != "table"
    }
    for column in layout.columns:
        values = arrays[column.name]
        text = np.char.decode(values, "utf-8") if column.dtype == "S" else values
        variables[column.name] = (column.axes, text, told(column.unit, column.meaning))
    lines = [table for table in tables if isinstance(table, ControllerTable)]
    return variables | line_variables(lines) if lines else variables


def line_variables(tables: Sequence[ControllerTable]) -> dict[str, Variable]:
    """The lines as speeds over the path of all tables, NaN where a table has none."""
    low, high = (float(end([each.valid.s_m for each in tables])) for end in (np.min, np.max))
    round_places = np.arange(math.ceil(low * PATHS_A_METRE), high * PATHS_A_METRE) / PATHS_A_METRE
    path_m = np.union1d(round_places, (low, high))
    speeds = np.full((2, len(tables), max(len(each.stages) for each in tables), len(path_m)), np.nan)
    for number, table in enumerate(tables):
        first_m, last_m = table.valid.s_m
        is_valid, lines = (first_m <= path_m) & (path_m <= last_m), lines_of(table, path_m)
        for side, line in enumerate((lines.lower_m_s, lines.upper_m_s)):
            speeds[side, number, : len(line)] = np.where(is_valid & np.isfinite(line), line, np.nan)
    axes = ("table", "stage", PATH)
    return named({PATH: path_m}, (PATH,)) | named(dict(zip(("lower_m_s", "upper_m_s"), speeds, strict=True)), axes)


def aim_variables(table: AimTable) -> Iterator[tuple[str, Variable]]:
    """Everything that an aim table holds, over its axes by their names."""
    axes = ("cars", "free_distance_m", "resistance_n_per_kn")
    for column in columns_of(AimTable, told_sections(AimTable, [table])):
        content, axis = column.content(table), column.name.removeprefix("axes_")
        if content is None:
            continue
        values = np.asarray(content.decode() if isinstance(content, bytes) else content)
        attributes = told(column.unit, column.meaning)
        if axis in axes:
            yield axis, ((axis,), values, attributes)
        else:
            yield column.name, (column.axes[1:] or axes[: values.ndim], values, attributes)


def by_sample(log: PassLog, values: NDArray[Any]) -> Floats:
    """One entry a row as (passes, samples), NaN behind the last row of a pass."""
    counts = np.diff(log.first_row)
    wide = np.full((len(log), int(counts.max(initial=0))), np.nan)
    wide[np.arange(wide.shape[1]) < counts[:, None]] = values
    return wide
