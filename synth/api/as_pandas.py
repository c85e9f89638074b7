"""Results as data frames of pandas: figures as the tables of the commands declare them, with intervals and units."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any, Final, TypeAlias, cast

from synth.api.as_xarray import Labelled, require_installed, to_xarray
from synth.frame.exhibits import Column, Row
from synth.frame.exhibits import Table as ShownTable
from synth.frame.sheet import sheet_rows
from synth.hump.trains.humped_trial import HumpedTrial
from synth.hump.trains.shown.figures import MEANS, mean_row, titles_of
from synth.logs.identify import Identified
from synth.logs.identify_shown import NUMBERS, number_row
from synth.retarder.comparison.measured import Measured
from synth.retarder.exit_figures import LOOP, loop_row
from synth.retarder.shown.results import CONTROLLER, controller_row
from synth.simulation.exit_statistics import ExitStatistics
from tuning_tables import ControllerTable
from tuning_tables.aim import AimTable
from tuning_tables.passages.passage_table import PassageTable

if TYPE_CHECKING:
    import pandas
    import xarray

Figures: TypeAlias = ExitStatistics | Sequence[Measured] | Identified | HumpedTrial
"""What has figures, each of them perhaps with an interval."""

ENDS: Final = {"_low95": "lower end of the 95 % interval", "_high95": "upper end of the 95 % interval"}


def to_pandas(value: Figures | Labelled) -> pandas.DataFrame:
    """Give figures, tables or passes as a data frame of pandas, with units in its attributes.

    Parameters
    ----------
    value
        `statistics` of `simulate`; what `compare_with_baselines`, `identify` or `hump_trains` gives; or anything that
        `to_xarray` takes.

    Returns
    -------
    pandas.DataFrame
        Of results a row for each controller, number or figure. A figure with a 95 % interval has four columns:
        `rms_m_s`, its ends `rms_m_s_low95` and `rms_m_s_high95`, and `rms_m_s_n`, from how many it is told. Of what
        `to_xarray` takes a row for each table, pass of many, or event of one, and of an aim table for each node.

        `attrs["units"]` and `attrs["long_name"]` are by column.

    Raises
    ------
    InputError
        pandas is not installed.

    Examples
    --------
    With `problem` and `table` from the example of `tabulate`:

    >>> import synth
    >>> laws = synth.compare_with_baselines(table, problem, passes=1000)
    >>> frame = synth.to_pandas(laws)
    >>> frame.attrs["units"]["rms_m_s"], frame.attrs["long_name"]["rms_m_s"]
    ('m/s', 'rms')
    >>> bool((frame.table_ratio_high95 < 1.0).all())
    True
    """
    require_installed("to_pandas")
    match value:
        case ExitStatistics():
            return frame_of(LOOP, [loop_row(value)])
        case [Measured(), *_]:
            return frame_of(CONTROLLER, [controller_row(each) for each in value if isinstance(each, Measured)])
        case Identified():
            return frame_of(NUMBERS, [number_row(each, len(value.passes)) for each in value.findings])
        case HumpedTrial():
            titles = titles_of(value.trial.couplings)
            rows = [mean_row(each, titles) for each in value.figures]
            return frame_of((*MEANS, Column("n", "trains, shifts or cuts")), rows)
        case ControllerTable() | PassageTable():
            return to_pandas([value])
    dataset = to_xarray(cast(Labelled, value))
    first = next(iter(dataset.data_vars.values()))
    return frame_along(dataset, dataset.exit_speed_m_s.dims if isinstance(value, AimTable) else first.dims[:1])


def frame_of(columns: Sequence[Column], rows: Sequence[Row]) -> pandas.DataFrame:
    """The rows of a table of declared columns, as its CSV file has them."""
    import pandas

    head, *cells = sheet_rows(ShownTable("", "", columns, rows))
    frame = pandas.DataFrame(cells, columns=list(head))
    told = {name: each for column in columns for name, each in attributes_of(column) if name in head}
    return with_attributes(frame, told)


def attributes_of(column: Column) -> Iterator[tuple[str, dict[str, str]]]:
    """Unit and heading of a figure, by the names of the columns that it may have."""
    # A share is printed in per cent; its value is a plain number.
    units = {"units": column.unit} if column.unit not in ("", "%") else {}
    yield column.key, {**units, "long_name": column.heading}
    for end, words in ENDS.items():
        yield f"{column.key}{end}", {**units, "long_name": f"{column.heading}, {words}"}


def frame_along(dataset: xarray.Dataset, axes: tuple[Any, ...]) -> pandas.DataFrame:
    """What lies along exactly these axes, a row for each place."""
    others = [name for name, variable in dataset.variables.items() if variable.dims != axes and name not in axes]
    along = dataset.drop_vars(others)
    return with_attributes(along.to_dataframe(), {str(name): each.attrs for name, each in along.variables.items()})


def with_attributes(frame: pandas.DataFrame, told: dict[str, dict[str, str]]) -> pandas.DataFrame:
    """`frame` with the attributes of its columns."""
    for attribute in ("units", "long_name"):
        frame.attrs[attribute] = {name: each[attribute] for name, each in told.items() if attribute in each}
    return frame
