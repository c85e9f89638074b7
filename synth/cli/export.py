"""`retarder-synth export`: tables in another form."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from synth.cli import say
from synth.faults.input_error import InputError

if TYPE_CHECKING:
    from tuning_tables import ControllerTable


@dataclass(frozen=True)
class AskedCode:
    """The options of controller code as the user gave them, None for what was not given."""

    prefix: str | None
    self_test: str | None
    split: bool
    correction_m_s: float | None = None


def export_command(source: Path, form: str, output: Path, asked: AskedCode, as_json: bool) -> int:
    """Write the tables in `source` as `form` into the directory `output`, and print the names of the files."""
    from synth.book.forms.aim_file import read_aims
    from synth.book.forms.aim_forms import AIM_FORMS
    from synth.book.forms.code_options import code_options
    from synth.book.forms.correction_form import correction_files
    from synth.book.forms.table_file import read_tables
    from synth.book.forms.table_forms import FORMS
    from synth.book.output_directory import make_directory
    from tuning_tables import InvalidTable, write_atomically

    if form not in FORMS:
        raise InputError(f"--format {form}: there is no such form; give {', '.join(FORMS)}")
    options = code_options(form, asked.prefix, asked.self_test, asked.split, asked.correction_m_s)
    aims = [file.table for file in read_aims(source)]
    tables = () if aims else read_tables(source)[0].tables
    try:
        files = {
            **(AIM_FORMS[form](aims, options) if aims else FORMS[form](tables, options)),
            **correction_files(form, tables, options),
        }
    except (InputError, InvalidTable) as fault:  # each table is right, but together they make no export
        raise InputError(f"{source}: {fault}") from None
    if form in ("c", "st") and tables:
        warn_of_shadows(source, tables)
    make_directory(output)
    for name, content in files.items():
        write_atomically(output / name, content)
    names = [str(output / name) for name in files]
    print(json.dumps({"files": names}, indent=1, ensure_ascii=False) if as_json else "\n".join(names))
    return 0


def warn_of_shadows(source: Path, tables: tuple[ControllerTable, ...]) -> None:
    """Say which tables a controller will never choose."""
    from tuning_tables.table_book import TableBook

    for table in TableBook(tables).shadowed():
        say(
            f"warning: {source}: {table.id} is never chosen, for another table of category {table.cut.category} on "
            f"{len(table.cut.axle_offsets_m)} axles is heavier or comes first; give it a category or book of its own"
        )
