"""The exports of aim tables in a directory, each against the same tables."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Final

from synth.checker.aim import code_export, csv_export
from synth.checker.aim.reading import Aim
from synth.checker.code_file import AIM_UNITS, unit_files
from synth.checker.csv_export import read_rows
from synth.checker.export_check import Check, Differences
from synth.checker.finding import DamagedError
from synth.checker.source_file import content_of, text_of

FOLDERS: Final = ("", "c", "st")


@dataclass(frozen=True)
class AimCode:
    """An export of controller code at `path`, in whose names `prefix` and "_" stand before AIM_; "" for none."""

    path: Path
    prefix: str

    def text(self, path: Path) -> str:
        """The text of a file of the export, as if it had no prefix."""
        if not self.prefix:
            return text_of(path)
        return re.sub(rf"\b{re.escape(self.prefix)}_(?=aim_)", "", text_of(path), flags=re.IGNORECASE)

    def units(self) -> str:
        """The text of all units that hold tables: one file, or several in the order of their names."""
        if self.path.name.endswith("_table.st"):
            return self.text(self.path)
        prefix = f"{self.prefix}_AIM" if self.prefix else "AIM"
        return "\n".join(self.text(file) for file in unit_files(self.path.parent, prefix, AIM_UNITS))


def check_aim_exports(aims: tuple[Aim, ...], folder: Path, check: Check) -> None:
    """Compare every export of aim tables that there is in `folder`, where `aims` are all that it holds."""
    for place in FOLDERS:
        for code in code_files(folder / place, r"(?:(\w+)_)?aim_table\.c"):
            check(code.path, partial(c_differences, code, aims))
        for file in sorted((folder / place).glob("*golden_aims.csv")):
            check(file, partial(golden_differences, file, aims))
        for code in code_files(folder / place, r"(?:(\w+)_)?aim_table\.st|\d{4}_(?:(\w+)_)?AIM_LOAD\.st"):
            check(code.path, partial(st_differences, code, aims))
    by_id = {aim.id: aim for aim in aims}
    for file in aim_csv_files(folder):
        check(file, partial(csv_differences, file, by_id))


def code_files(folder: Path, pattern: str) -> Iterator[AimCode]:
    """The exports in `folder` whose names are like `pattern`, with their prefixes."""
    for file in sorted(folder.iterdir()) if folder.is_dir() else ():
        found = re.fullmatch(pattern, file.name)
        if found:
            yield AimCode(file, next((group for group in found.groups() if group), ""))


def aim_csv_files(folder: Path) -> list[Path]:
    """The CSV files of aim tables, beside the tables."""
    tables = folder / "tables" if (folder / "tables").is_dir() else folder
    return [file for file in sorted(tables.glob("*.csv")) if is_aim_csv(file)]


def is_aim_csv(file: Path) -> bool:
    """Whether a CSV file says that it is of an aim table."""
    try:
        return re.search(rb"^text,kind,aim,", content_of(file), re.MULTILINE) is not None
    except DamagedError:
        return False


def c_differences(code: AimCode, aims: tuple[Aim, ...]) -> Differences:
    """The C export in a file, and the header beside it."""
    yield from code_export.c_differences(code.text(code.path), code.text(code.path.with_suffix(".h")), aims)


def st_differences(code: AimCode, aims: tuple[Aim, ...]) -> Differences:
    """The Structured Text of an export."""
    yield from code_export.st_differences(code.units(), aims)


def golden_differences(file: Path, aims: tuple[Aim, ...]) -> Differences:
    """The golden aims in `file`."""
    yield from csv_export.golden_differences(content_of(file), aims)


def csv_differences(file: Path, by_id: dict[str, Aim]) -> Differences:
    """The CSV table in `file`."""
    rows = read_rows(content_of(file))
    name = (rows.get(("text", "id")) or ("",))[0]
    if name not in by_id:
        yield "", f"it is of the aim table {name!r}, which no other file holds"
        return
    yield from ((name, sentence) for sentence in csv_export.differences(rows, by_id[name]))
