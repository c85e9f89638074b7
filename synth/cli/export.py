"""`retarder-synth export`: tables in another form."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from synth.frame.faults import InputError
from synth.frame.printed_numbers import counted
from synth.frame.terminal.manner import Manner

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from tuning_tables.document import AnyTable


@dataclass(frozen=True)
class AskedCode:
    """The options of controller code as the user gave them, None for what was not given."""

    prefix: str | None
    self_test: str | None
    split: bool
    correction_m_s: float | None = None


def export_command(source: Path, form: str, output: Path, asked: AskedCode, manner: Manner) -> int:
    """Write the tables in `source` as `form` into the directory `output`, and print the names of the files."""
    from synth.frame.results_directory import results_directory
    from synth.retarder.configured import configuration_file
    from synth.retarder.forms.code_options import CONTROLLER_NAMES, FMU_NAMES, code_options
    from synth.retarder.forms.table_forms import FORMS, correction_files
    from synth.retarder.forms.tables_at import files_at, tables_at
    from tuning_tables import InvalidTable

    if form not in FORMS:
        raise InputError(f"--format {form}: there is no such form; give {', '.join(FORMS)}")
    options = code_options(form, asked.prefix, asked.self_test, asked.split, asked.correction_m_s)
    tables = tables_at(source).of_one_kind
    manner.step(f"read: {counted(len(tables), 'table')}")
    try:
        files = {**FORMS[form](tables, options), **correction_files(form, tables, options)}
    except (InputError, InvalidTable) as fault:  # each table is right, but together they make no export
        raise InputError(f"{source}: {fault}") from None
    if form in CONTROLLER_NAMES:
        files |= configuration_file(source, tables, options.prefix)
        for sentence in shadows(source, tables):
            manner.warn(f"warning: {sentence}")
    if form in FMU_NAMES:
        from synth.retarder.fmi.description import INTERFACES
        from synth.retarder.fmi.position_unit import position_files

        files |= position_files(source, tables, INTERFACES[form], options.prefix, manner.warn)
    with results_directory(output, "export", files_at(source)) as directory:
        names = [str(file) for file in directory.write_all(files)]
    manner.give(lambda: {"files": names}, lambda: names)
    return 0


def shadows(source: Path, tables: Sequence[AnyTable]) -> Iterator[str]:
    """Which tables a controller will never choose, a sentence each."""
    from synth.retarder.forms.table_forms import bound
    from tuning_tables.aim import AimTables

    together = bound(tables)
    for table in () if isinstance(together, AimTables) else together.shadowed():
        yield (
            f"{source}: {table.id} is never chosen, for another table of category {table.cut.category} on "
            f"{len(table.cut.axle_offsets_m)} axles is heavier or comes first; give it a category or book of its own"
        )
