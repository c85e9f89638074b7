"""The forms that tables of any kind are exported in: for each the files, by name, with their bytes; and the files of
the on-line correction that go with them.
"""

from __future__ import annotations

import math
import statistics
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any, Final, TypeAlias

from synth.frame.faults import InputError
from synth.retarder.forms.code_options import FMU_NAMES, PLAIN, PLC_NAMES, CodeOptions
from synth.retarder.forms.tables_at import file_stem
from tuning_tables import ControllerTable, TableBook, to_csv, to_json
from tuning_tables.aim.aim_tables import AimTable, AimTables
from tuning_tables.correction import Correction
from tuning_tables.document import AnyTable
from tuning_tables.passages.passage_book import PassageBook
from tuning_tables.passages.passage_table import PassageTable

Files: TypeAlias = Mapping[str, bytes]
Form: TypeAlias = Callable[[Sequence[AnyTable], CodeOptions], Files]
"""Of one table or more, all of one kind."""


def json_form(tables: Sequence[AnyTable], _options: CodeOptions = PLAIN) -> Files:
    """One JSON file a table."""
    return one_each(tables, to_json, ".json")


def csv_form(tables: Sequence[AnyTable], _options: CodeOptions = PLAIN) -> Files:
    """One CSV file a table."""
    return one_each(tables, to_csv, ".csv")


def c_form(tables: Sequence[AnyTable], options: CodeOptions = PLAIN) -> Files:
    """C99 source of all tables together, self-test and golden answers. Raises as `bound`."""
    match bound(tables):
        case AimTables() as aims:
            from tuning_tables.aim.exports import aim_c_files

            return aim_c_files(aims, options.prefix, options.self_test)
        case PassageBook() as points:
            from tuning_tables.passages.exports import passage_c_files

            return passage_c_files(points, options.prefix, options.self_test)
        case TableBook() as lines:
            from tuning_tables.exports import c_files

            return c_files(lines, options.prefix, options.self_test)


def plc_form(name: str, tables: Sequence[AnyTable], options: CodeOptions = PLAIN) -> Files:
    """Structured Text of all tables together and its self-test, in a form of `PLC_FORMS`. Raises as `bound`."""
    from synth.retarder.forms.code_options import PLC_FORMS

    match bound(tables):
        case AimTables() as aims:
            from tuning_tables.aim.exports import aim_export

            export = aim_export(aims, options.prefix, options.self_test)
        case PassageBook() as points:
            from tuning_tables.passages.exports import passage_export

            export = passage_export(points, options.prefix, options.self_test)
        case TableBook() as lines:
            from tuning_tables.exports import line_export

            export = line_export(lines, options.prefix, options.self_test)
    return PLC_FORMS[name].files(export, options)


def fmu_form(name: str, tables: Sequence[AnyTable], options: CodeOptions = PLAIN) -> Files:
    """The controller of tables with lines as a unit, a form of `FMU_NAMES`; `InputError` for others, or as `bound`."""
    from synth.retarder.fmi.controller_unit import controller_unit
    from synth.retarder.fmi.description import INTERFACES

    match bound(tables):
        case TableBook() as lines:
            unit = controller_unit(lines, options.prefix)
            return {f"{unit.identifier}.fmu": unit.archive(INTERFACES[name])}
    raise InputError(
        f"--format {name} is for tables with lines, not for aim tables or tables for point sensors; give c"
    )


FORMS: Mapping[str, Form] = {
    "json": json_form,
    "csv": csv_form,
    "c": c_form,
    **{name: partial(plc_form, name) for name in PLC_NAMES},
    **{name: partial(fmu_form, name) for name in FMU_NAMES},
}


def bound(tables: Sequence[Any]) -> TableBook | PassageBook | AimTables:
    """Tables of one kind together, as controllers hold them; `InvalidTable` if they do not go together.

    Aim tables stand by category, that by category alone first, whatever their files are called.
    """
    match tables[0]:
        case AimTable():
            return AimTables(tuple(sorted(tables, key=lambda table: (table.category.number, table.is_measured))))
        case PassageTable():
            return PassageBook(tuple(tables))
    return TableBook(tuple(tables))


def one_each(tables: Sequence[AnyTable], write: Callable[[AnyTable], bytes], suffix: str) -> Files:
    """A file a table, called by its id; `InputError` if two would have one name."""
    files: dict[str, bytes] = {}
    for table in tables:
        name = f"{file_stem(table)}{suffix}"
        if name in files:
            raise InputError(f"two of the tables would both be written to {name}; their ids are too alike")
        files[name] = write(table)
    return files


EXIT_READING_STD_M_S: Final = 0.05
"""Of a measured exit speed: one reading of the library's Doppler radar; engineering judgement for any other sensor."""


def correction_files(form: str, tables: Sequence[AnyTable], options: CodeOptions) -> Files:
    """The code in `form` of a correction up to `options.correction_m_s`; no file where none is asked for.

    The spread of exits is the median of what the tables predict of theirs, with that of a reading. `InputError` without
    tables with lines: aim tables regulate nothing, and a passage over sensors has no samples to judge it by.
    """
    if options.correction_m_s is None:
        return {}
    with_lines = [table for table in tables if isinstance(table, ControllerTable)]
    if not with_lines:
        raise InputError(
            "--correction is for tables with lines, and these are aim tables or tables for point sensors; leave it out"
        )
    correction = correction_of(with_lines, options.correction_m_s)
    if form == "c":
        from tuning_tables.exports import correction_c_files

        return correction_c_files(correction, options.prefix)
    from synth.retarder.forms.code_options import PLC_FORMS
    from tuning_tables.exports import correction_export, correction_st_unit_files

    if options.split:
        return correction_st_unit_files(correction, options.prefix)
    return PLC_FORMS[form].files(correction_export(correction, options.prefix), options)


def correction_of(tables: Sequence[ControllerTable], limit_m_s: float) -> Correction:
    """The correction of a position with these tables."""
    rms = statistics.median(table.predicted.rms_m_s for table in tables)
    return Correction(limit_m_s, spread_m_s=min(math.hypot(rms, EXIT_READING_STD_M_S), 0.5))
