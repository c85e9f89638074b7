"""`retarder-synth export`: tables in another form."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from synth.frame.input_error import InputError
from synth.frame.terminal.telling import say

if TYPE_CHECKING:
    from collections.abc import Sequence

    from tuning_tables.table_kinds import AnyTable


@dataclass(frozen=True)
class AskedCode:
    """The options of controller code as the user gave them, None for what was not given."""

    prefix: str | None
    self_test: str | None
    split: bool
    correction_m_s: float | None = None


def export_command(source: Path, form: str, output: Path, asked: AskedCode, as_json: bool) -> int:
    """Write the tables in `source` as `form` into the directory `output`, and print the names of the files."""
    from synth.frame.results_directory import results_directory
    from synth.retarder.forms.code_options import CONTROLLER_NAMES, FMU, code_options
    from synth.retarder.forms.configuration_beside import configuration_file
    from synth.retarder.forms.correction_form import correction_files
    from synth.retarder.forms.table_file import files_at
    from synth.retarder.forms.table_forms import FORMS
    from tuning_tables import InvalidTable

    if form not in FORMS:
        raise InputError(f"--format {form}: there is no such form; give {', '.join(FORMS)}")
    options = code_options(form, asked.prefix, asked.self_test, asked.split, asked.correction_m_s)
    tables = exported_tables(source)
    try:
        files = {**FORMS[form](tables, options), **correction_files(form, tables, options)}
    except (InputError, InvalidTable) as fault:  # each table is right, but together they make no export
        raise InputError(f"{source}: {fault}") from None
    if form in CONTROLLER_NAMES:
        files |= configuration_file(source, tables, options.prefix)
        warn_of_shadows(source, tables)
    if form == FMU:
        from synth.retarder.forms.position_form import position_files

        files |= position_files(source, tables, options.prefix)
    with results_directory(output, "export", files_at(source)) as directory:
        names = [str(file) for file in directory.write_all(files)]
    print(json.dumps({"files": names}, indent=1, ensure_ascii=False) if as_json else "\n".join(names))
    return 0


def exported_tables(source: Path) -> Sequence[AnyTable]:
    """The tables of one kind in `source`: aim tables, without any those for point sensors, else those with lines."""
    from synth.retarder.forms.aim_file import read_aims
    from synth.retarder.forms.passage_file import read_passages
    from synth.retarder.forms.table_file import tables_at

    return [file.table for file in read_aims(source)] or read_passages(source) or tables_at(source)


def warn_of_shadows(source: Path, tables: Sequence[AnyTable]) -> None:
    """Say which tables a controller will never choose."""
    from synth.retarder.forms.table_forms import bound
    from tuning_tables.aim import AimTables

    together = bound(tables)
    for table in () if isinstance(together, AimTables) else together.shadowed():
        say(
            f"warning: {source}: {table.id} is never chosen, for another table of category {table.cut.category} on "
            f"{len(table.cut.axle_offsets_m)} axles is heavier or comes first; give it a category or book of its own"
        )
