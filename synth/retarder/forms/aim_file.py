"""Aim tables from whatever the user points at: a JSON file, or a directory with some."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from synth.retarder.forms.table_mark import is_table_of
from tuning_tables.aim.aim_table import AimTable
from tuning_tables.json_file import read_json


@dataclass(frozen=True)
class AimFile:
    """The aim table of one file; reading it has checked its sum."""

    path: Path
    table: AimTable


def read_aims(path: Path) -> tuple[AimFile, ...]:
    """The aim tables at `path`: a file, or those of a directory, in tables/ if it has that; empty where there is none.

    `TableError` where one is damaged.
    """
    folder = path / "tables" if (path / "tables").is_dir() else path
    files = sorted(folder.glob("*.json")) if path.is_dir() else [path]
    return tuple(AimFile(file, read_json(file, AimTable)) for file in files if is_table_of(AimTable, file))
