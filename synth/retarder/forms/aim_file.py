"""Aim tables from whatever the user points at: a JSON file, or a directory with some."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from tuning_tables.aim.aim_table import AimTable
from tuning_tables.aim.json_file import read_aim_json
from tuning_tables.json_text import LARGEST_FILE_BYTES
from tuning_tables.regular_file import first_bytes

MARK: Final = re.compile(rb'"format"\s*:\s*"aim-table"')
"""No text in a JSON document can hold this: its quotes would be escaped."""


@dataclass(frozen=True)
class AimFile:
    """The aim table of one file; reading it has checked its sum."""

    path: Path
    table: AimTable


def is_aim_table(file: Path) -> bool:
    """Whether a file says that it is an aim table; what cannot be read does not."""
    try:
        return file.suffix not in (".h5", ".hdf5") and MARK.search(first_bytes(file, LARGEST_FILE_BYTES)) is not None
    except OSError:  # whoever reads it for its tables tells why
        return False


def read_aims(path: Path) -> tuple[AimFile, ...]:
    """The aim tables at `path`: a file, or those of a directory, in tables/ if it has that; empty where there is none.

    `TableError` where one is damaged.
    """
    folder = path / "tables" if (path / "tables").is_dir() else path
    files = sorted(folder.glob("*.json")) if path.is_dir() else [path]
    return tuple(AimFile(file, read_aim_json(file)) for file in files if is_aim_table(file))
