"""`retarder-synth export`: tables in another form."""

from __future__ import annotations

import json
from pathlib import Path

from synth.input_error import InputError

FORMS = ("json", "csv")
FORMS_TO_COME = ("c", "st")


def export_command(source: Path, form: str, output: Path, as_json: bool) -> int:
    """Write the tables in `source` as `form` into `output`, one file each, and print their names."""
    if form in FORMS_TO_COME:
        raise InputError(f"--format {form}: this version writes {' and '.join(FORMS)}; {form} comes in a later one")
    if form not in FORMS:
        raise InputError(f"--format {form}: there is no such form; give {' or '.join(FORMS)}")
    from synth.output_directory import make_directory
    from synth.table_file import file_stem, read_tables
    from tuning_tables import write_csv, write_json

    (file,) = read_tables(source)
    paths = [output / f"{file_stem(table)}.{form}" for table in file.tables]
    for path in paths:
        if paths.count(path) > 1:
            raise InputError(f"{source}: two of its tables would both be written to {path}; their ids are too alike")
    make_directory(output)
    for table, path in zip(file.tables, paths, strict=True):
        (write_json if form == "json" else write_csv)(table, path)
    names = [str(path) for path in paths]
    print(json.dumps({"files": names}, indent=1, ensure_ascii=False) if as_json else "\n".join(names))
    return 0
