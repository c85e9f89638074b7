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

    from synth.retarder.forms.code_options import CodeOptions
    from synth.retarder.forms.table_forms import Files
    from tuning_tables import ControllerTable, PassageTable
    from tuning_tables.aim import AimTable


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
    from synth.retarder.forms.aim_file import read_aims
    from synth.retarder.forms.code_options import CODE_NAMES, code_options
    from synth.retarder.forms.configuration_beside import configuration_file
    from synth.retarder.forms.passage_file import read_passages
    from synth.retarder.forms.table_file import files_at, tables_at
    from synth.retarder.forms.table_forms import FORMS
    from tuning_tables import InvalidTable
    from tuning_tables.aim.c_source import KIND

    if form not in FORMS:
        raise InputError(f"--format {form}: there is no such form; give {', '.join(FORMS)}")
    options = code_options(form, asked.prefix, asked.self_test, asked.split, asked.correction_m_s)
    aims = [file.table for file in read_aims(source)]
    passages = () if aims else read_passages(source)
    tables = () if aims or passages else tables_at(source)
    try:
        files = exported_files(form, aims, passages, tables, options)
        if form in CODE_NAMES:
            made: Sequence[AimTable | PassageTable | ControllerTable] = [*aims, *passages, *tables]
            sha256s = {each.generator.config_sha256 for each in made}
            prefix = options.prefix.of_kind(KIND) if aims else options.prefix
            files = {**files, **configuration_file(source, sha256s, prefix)}
    except (InputError, InvalidTable) as fault:  # each table is right, but together they make no export
        raise InputError(f"{source}: {fault}") from None
    if form in CODE_NAMES:
        warn_of_shadows(source, passages, tables)
    with results_directory(output, "export", files_at(source)) as directory:
        names = [str(file) for file in directory.write_all(files)]
    print(json.dumps({"files": names}, indent=1, ensure_ascii=False) if as_json else "\n".join(names))
    return 0


def exported_files(
    form: str,
    aims: Sequence[AimTable],
    passages: Sequence[PassageTable],
    tables: Sequence[ControllerTable],
    options: CodeOptions,
) -> Files:
    """The files in `form` of the tables, which are of one of the three kinds, and of a correction if one is asked."""
    from synth.retarder.forms.aim_forms import AIM_FORMS
    from synth.retarder.forms.correction_form import correction_files
    from synth.retarder.forms.passage_forms import PASSAGE_FORMS
    from synth.retarder.forms.table_forms import FORMS

    if aims:
        files = AIM_FORMS[form](aims, options)
    elif passages:
        files = PASSAGE_FORMS[form](passages, options)
    else:
        files = FORMS[form](tables, options)
    return {**files, **correction_files(form, tables, options)}


def warn_of_shadows(source: Path, passages: Sequence[PassageTable], tables: Sequence[ControllerTable]) -> None:
    """Say which tables a controller will never choose."""
    from tuning_tables import TableBook
    from tuning_tables.passages.passage_book import PassageBook

    shadowed: list[PassageTable | ControllerTable] = []
    if passages:
        shadowed += PassageBook(tuple(passages)).shadowed()
    if tables:
        shadowed += TableBook(tuple(tables)).shadowed()
    for table in shadowed:
        say(
            f"warning: {source}: {table.id} is never chosen, for another table of category {table.cut.category} on "
            f"{len(table.cut.axle_offsets_m)} axles is heavier or comes first; give it a category or book of its own"
        )
