"""The forms that aim tables are exported in: for each the files, by name, with their bytes."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial

from synth.retarder.forms.code_options import PLAIN, PLC_NAMES, CodeOptions
from synth.retarder.forms.table_forms import Files, csv_form, json_form
from tuning_tables.aim.aim_table import AimTable
from tuning_tables.aim.aim_tables import AimTables

AimForm = Callable[[Sequence[AimTable], CodeOptions], Files]


def aim_c_form(tables: Sequence[AimTable], options: CodeOptions = PLAIN) -> Files:
    """C99 source of all tables together, self-test and golden aims; `InvalidTable` if they make no set."""
    from tuning_tables.aim.c_source import aim_c_files

    return aim_c_files(in_order(tables), options.prefix, options.self_test.aims)


def aim_plc_form(name: str, tables: Sequence[AimTable], options: CodeOptions = PLAIN) -> Files:
    """Structured Text of all tables together and its self-test, in a form of `PLC_FORMS`.

    `InvalidTable` if they make no set.
    """
    from synth.retarder.forms.plc_forms import PLC_FORMS
    from tuning_tables.aim.st_source import aim_export

    return PLC_FORMS[name].files(aim_export(in_order(tables), options.prefix, options.self_test.aims), options)


AIM_FORMS: Mapping[str, AimForm] = {
    "json": json_form,
    "csv": csv_form,
    "c": aim_c_form,
    **{name: partial(aim_plc_form, name) for name in PLC_NAMES},
}


def in_order(tables: Sequence[AimTable]) -> AimTables:
    """The set of the tables by category, that by category alone first: whatever their files are called."""
    return AimTables(tuple(sorted(tables, key=lambda table: (table.category.number, table.is_measured))))
