"""The forms that aim tables are exported in: for each the files, by name, with their bytes."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from synth.retarder.forms.code_options import PLAIN, CodeOptions
from synth.retarder.forms.table_forms import Files, one_each
from tuning_tables.aim.aim_table import AimTable
from tuning_tables.aim.aim_tables import AimTables
from tuning_tables.csv_file import to_csv
from tuning_tables.json_file import to_json

AimForm = Callable[[Sequence[AimTable], CodeOptions], Files]


def aim_json_form(tables: Sequence[AimTable], _options: CodeOptions = PLAIN) -> Files:
    """One JSON file a table."""
    return one_each(tables, to_json, ".json")


def aim_csv_form(tables: Sequence[AimTable], _options: CodeOptions = PLAIN) -> Files:
    """One CSV file a table."""
    return one_each(tables, to_csv, ".csv")


def aim_c_form(tables: Sequence[AimTable], options: CodeOptions = PLAIN) -> Files:
    """C99 source of all tables together, self-test and golden aims; `InvalidTable` if they make no set."""
    from tuning_tables.aim.c_source import aim_c_files

    return aim_c_files(in_order(tables), options.prefix, options.self_test.aims)


def aim_st_form(tables: Sequence[AimTable], options: CodeOptions = PLAIN) -> Files:
    """Structured Text of all tables together and its self-test; `InvalidTable` if they make no set."""
    from tuning_tables.aim.st_source import aim_st_files, aim_st_unit_files

    write = aim_st_unit_files if options.split else aim_st_files
    return write(in_order(tables), options.prefix, options.self_test.aims)


AIM_FORMS: Mapping[str, AimForm] = {"json": aim_json_form, "csv": aim_csv_form, "c": aim_c_form, "st": aim_st_form}


def in_order(tables: Sequence[AimTable]) -> AimTables:
    """The set of the tables by category, that by category alone first: whatever their files are called."""
    return AimTables(tuple(sorted(tables, key=lambda table: (table.category.number, table.is_measured))))
