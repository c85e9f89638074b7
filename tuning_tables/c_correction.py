"""The on-line correction as C99 source, with a self-test and golden exits: a library text beside that of the tables."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from tuning_tables.c_source import c_texts
from tuning_tables.controller_code.correction_code import correction_code
from tuning_tables.correction import Correction
from tuning_tables.export_prefix import RETARDER, ExportPrefix
from tuning_tables.golden_csv import golden_csv
from tuning_tables.golden_exits import NUMBERS, golden_exits

EXITS_FILE: Final = "golden_exits.csv"


def correction_c_files(correction: Correction, prefix: ExportPrefix = RETARDER) -> Mapping[str, bytes]:
    """The files by name: four of C99, ASCII, and all golden exits as CSV. Equal corrections give equal bytes."""
    exits = golden_exits(correction)
    columns = {"credible": exits["credible"].astype(int), **{name: exits[name] for name in NUMBERS}}
    return {**c_texts(correction_code(correction), prefix), prefix.data_file(EXITS_FILE): golden_csv(columns)}
