"""The on-line correction as IEC 61131-3 Structured Text, with its self-test, beside that of the tables."""

from __future__ import annotations

from collections.abc import Mapping

from tuning_tables.controller_code.correction_code import correction_code
from tuning_tables.correction import Correction
from tuning_tables.export_prefix import RETARDER, ExportPrefix
from tuning_tables.st_source import st_texts, st_unit_texts


def correction_st_files(correction: Correction, prefix: ExportPrefix = RETARDER) -> Mapping[str, bytes]:
    """The files by name, ASCII with LF: the blocks, and the self-test. Equal corrections give equal bytes."""
    return st_texts(correction_code(correction), prefix)


def correction_st_unit_files(correction: Correction, prefix: ExportPrefix = RETARDER) -> Mapping[str, bytes]:
    """The same units, a file each; by their names in the order in which they need each other."""
    # Behind the name, so that they sort beside, not among, the numbered units of the tables.
    return {f"correction_{name}": text for name, text in st_unit_texts(correction_code(correction), prefix).items()}
