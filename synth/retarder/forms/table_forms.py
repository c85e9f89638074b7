"""The forms that tables are exported in: for each the files, by name, with their bytes."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import TypeVar

from synth.frame.input_error import InputError
from synth.retarder.forms.code_options import PLAIN, PLC_NAMES, CodeOptions
from synth.retarder.forms.table_file import file_stem
from tuning_tables import ControllerTable, to_csv, to_json
from tuning_tables.aim.aim_table import AimTable
from tuning_tables.passages.passage_table import PassageTable

_Table = TypeVar("_Table", ControllerTable, AimTable, PassageTable)
Files = Mapping[str, bytes]
Form = Callable[[Sequence[ControllerTable], CodeOptions], Files]


def json_form(tables: Sequence[_Table], _options: CodeOptions = PLAIN) -> Files:
    """One JSON file a table."""
    return one_each(tables, to_json, ".json")


def csv_form(tables: Sequence[_Table], _options: CodeOptions = PLAIN) -> Files:
    """One CSV file a table."""
    return one_each(tables, to_csv, ".csv")


def c_form(tables: Sequence[ControllerTable], options: CodeOptions = PLAIN) -> Files:
    """C99 source of all tables together, self-test and golden vectors; `InvalidTable` if they make no book."""
    from tuning_tables.c_source import c_files
    from tuning_tables.table_book import TableBook

    return c_files(TableBook(tuple(tables)), options.prefix, options.self_test)


def plc_form(name: str, tables: Sequence[ControllerTable], options: CodeOptions = PLAIN) -> Files:
    """Structured Text of all tables together and its self-test, in a form of `PLC_FORMS`.

    `InvalidTable` if they make no book.
    """
    from synth.retarder.forms.plc_forms import PLC_FORMS
    from tuning_tables.st_source import line_export
    from tuning_tables.table_book import TableBook

    return PLC_FORMS[name].files(line_export(TableBook(tuple(tables)), options.prefix, options.self_test), options)


FORMS: Mapping[str, Form] = {
    "json": json_form,
    "csv": csv_form,
    "c": c_form,
    **{name: partial(plc_form, name) for name in PLC_NAMES},
}


def one_each(tables: Sequence[_Table], write: Callable[[_Table], bytes], suffix: str) -> Files:
    """A file a table, called by its id; `InputError` if two would have one name."""
    files: dict[str, bytes] = {}
    for table in tables:
        name = f"{file_stem(table)}{suffix}"
        if name in files:
            raise InputError(f"two of the tables would both be written to {name}; their ids are too alike")
        files[name] = write(table)
    return files
