"""The forms that tables of any kind are exported in: for each the files, by name, with their bytes."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any, TypeAlias

from synth.frame.input_error import InputError
from synth.retarder.forms.code_options import FMU_NAMES, PLAIN, PLC_NAMES, CodeOptions
from synth.retarder.forms.table_file import file_stem
from tuning_tables import TableBook, to_csv, to_json
from tuning_tables.aim.aim_table import AimTable
from tuning_tables.aim.aim_tables import AimTables
from tuning_tables.passages.passage_book import PassageBook
from tuning_tables.passages.passage_table import PassageTable
from tuning_tables.table_kinds import AnyTable

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
            from tuning_tables.aim.c_source import aim_c_files

            return aim_c_files(aims, options.prefix, options.self_test)
        case PassageBook() as points:
            from tuning_tables.passages.c_source import passage_c_files

            return passage_c_files(points, options.prefix, options.self_test)
        case TableBook() as lines:
            from tuning_tables.c_source import c_files

            return c_files(lines, options.prefix, options.self_test)


def plc_form(name: str, tables: Sequence[AnyTable], options: CodeOptions = PLAIN) -> Files:
    """Structured Text of all tables together and its self-test, in a form of `PLC_FORMS`. Raises as `bound`."""
    from synth.retarder.forms.plc_forms import PLC_FORMS

    match bound(tables):
        case AimTables() as aims:
            from tuning_tables.aim.st_source import aim_export

            export = aim_export(aims, options.prefix, options.self_test)
        case PassageBook() as points:
            from tuning_tables.passages.st_source import passage_export

            export = passage_export(points, options.prefix, options.self_test)
        case TableBook() as lines:
            from tuning_tables.st_source import line_export

            export = line_export(lines, options.prefix, options.self_test)
    return PLC_FORMS[name].files(export, options)


def fmu_form(name: str, tables: Sequence[AnyTable], options: CodeOptions = PLAIN) -> Files:
    """The controller of tables with lines as a unit, a form of `FMU_NAMES`; `InputError` for others, or as `bound`."""
    from synth.retarder.fmi.controller_unit import controller_unit
    from synth.retarder.fmi.interfaces import INTERFACES

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
