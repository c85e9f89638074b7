"""The on-line correction as C99 source, with a self-test and golden exits: a library text beside that of the tables."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

import numpy as np
import numpy.typing as npt

from tuning_tables.c_source import c_texts
from tuning_tables.controller_code.correction_code import correction_code
from tuning_tables.correction import Correction
from tuning_tables.export_prefix import RETARDER, ExportPrefix
from tuning_tables.golden_exits import NUMBERS, golden_exits

EXITS_FILE: Final = "golden_exits.csv"


def correction_c_files(correction: Correction, prefix: ExportPrefix = RETARDER) -> Mapping[str, bytes]:
    """The files by name: four of C99, ASCII, and all golden exits as CSV. Equal corrections give equal bytes."""
    exits = exits_csv(golden_exits(correction))
    return {**c_texts(correction_code(correction), prefix), prefix.data_file(EXITS_FILE): exits}


def exits_csv(exits: npt.NDArray[np.void]) -> bytes:
    """All golden exits, CR LF: credible (0 or 1), then every number as bits and as a number; m/s."""
    rows = [",".join(("credible", *(f"{name}_bits" for name in NUMBERS), *NUMBERS))]
    for row in exits:
        values = [row[name] for name in NUMBERS]
        fields = [*(f"{int(each.view(np.uint32)):08x}" for each in values), *(f"{each:.9g}" for each in values)]
        rows.append(f"{int(row['credible'])},{','.join(fields)}")
    return ("\r\n".join(rows) + "\r\n").encode("ascii")
