"""The on-line correction as C99 source, with a self-test and golden exits: a library text beside that of the tables.

The C text itself is in `c99/retarder_correction*.in`; here its blanks are filled.
"""

from __future__ import annotations

import zlib
from collections.abc import Mapping
from typing import Final

import numpy as np
import numpy.typing as npt

from tuning_tables.c_literals import hex_float
from tuning_tables.c_template import filled
from tuning_tables.correction import (
    FEWEST_SAMPLES,
    LARGEST_ERROR_M_S,
    LARGEST_EXCESS_M_S,
    MOST_MISSING,
    Correction,
)
from tuning_tables.export_prefix import RETARDER, ExportPrefix
from tuning_tables.golden_exits import COUNTS, FLAGS, INPUT_FIELDS, OUTPUT_FIELDS, golden_exits, golden_passes

TEMPLATES: Final = (
    "retarder_correction.h",
    "retarder_correction.c",
    "retarder_correction_self_test.h",
    "retarder_correction_self_test.c",
)
EXITS_FILE: Final = "golden_exits.csv"

CONSTANTS: Final = (
    "GAIN", "THRESHOLD_SQUARED", "LIMIT", "REACH", "CLIP", "STEP", "LARGEST_ERROR", "LARGEST_EXCESS", "LARGEST_SPEED",
    "NOUGHT", "ONE", "MOST_LEARNT",
)  # fmt: skip
"""Names of `Correction.parameters`, as far as they are numbers of the recursion."""


def correction_c_files(correction: Correction, prefix: ExportPrefix = RETARDER) -> Mapping[str, bytes]:
    """The files by name: four of C99, ASCII, and all golden exits as CSV. Equal corrections give equal bytes."""
    exits = golden_exits(correction)
    blanks = correction_blanks(correction, exits)
    sources = {prefix.renamed(name): prefix.renamed(filled(name, blanks)).encode("ascii") for name in TEMPLATES}
    return {**sources, prefix.data_file(EXITS_FILE): exits_csv(exits)}


def correction_blanks(correction: Correction, exits: npt.NDArray[np.void]) -> Mapping[str, str]:
    """What the templates ask for, by the names of their blanks."""
    passes = golden_passes(correction)
    exact = {f"{name}_HEX": hex_float(value) for name, value in zip(CONSTANTS, correction.parameters[:12], strict=True)}
    return {
        **exact,
        **correction_words(correction),
        "EXPORT": f"0x{zlib.crc32(b'correction' + correction.parameters.astype('<f4').tobytes()):08x}u",
        "EXITS": f"{len(exits)}",
        "PASSES": f"{len(passes)}",
        "GOLDEN_EXITS": ",\n".join(map(_exit_text, exits)),
        "GOLDEN_PASSES": ",\n".join(map(_pass_text, passes)),
    }


def correction_words(correction: Correction) -> Mapping[str, str]:
    """The numbers of a correction for the eye, by their blanks in both languages."""
    return {
        "LIMIT": f"{correction.limit_m_s:g}",
        "STEP": f"{correction.step_m_s:g}",
        "SPREAD": f"{correction.spread_m_s:g}",
        "MEMORY": f"{correction.memory_passes:g}",
        "FEWEST_SAMPLES": f"{FEWEST_SAMPLES}",
        "MOST_MISSING": f"{MOST_MISSING}",
        "LARGEST_ERROR": f"{LARGEST_ERROR_M_S:g}",
        "LARGEST_EXCESS": f"{LARGEST_EXCESS_M_S:g}",
    }


def bits(value: np.float32) -> int:
    """The 32 bits of a number."""
    return int(value.view(np.uint32))


def _exit_text(row: np.void) -> str:
    words = {name: f"0x{bits(row[name]):08x}u" for name in (*INPUT_FIELDS, *OUTPUT_FIELDS)}
    before, after = (", ".join(words[name] for name in names[:3]) for names in (INPUT_FIELDS, OUTPUT_FIELDS))
    error, speed, corrected = words["error_m_s"], words["speed_m_s"], words["corrected_m_s"]
    return f"    {{{int(row['credible'])}, {{{before}}}, {error}, {speed}, {{{after}}}, {corrected}}}"


def _pass_text(row: np.void) -> str:
    counts, flags = (", ".join(str(int(row[name])) for name in names) for names in (COUNTS, FLAGS))
    return f"    {{{{{counts}}}, {{{flags}}}, 0x{bits(row['error_m_s']):08x}u, {int(row['usable'])}}}"


def exits_csv(exits: npt.NDArray[np.void]) -> bytes:
    """All golden exits, CR LF: credible (0 or 1), then every number as bits and as a number; m/s."""
    names = (*INPUT_FIELDS, *OUTPUT_FIELDS)
    rows = [",".join(("credible", *(f"{name}_bits" for name in names), *names))]
    for row in exits:
        fields = [*(f"{bits(row[name]):08x}" for name in names), *(f"{row[name]:.9g}" for name in names)]
        rows.append(f"{int(row['credible'])},{','.join(fields)}")
    return ("\r\n".join(rows) + "\r\n").encode("ascii")
