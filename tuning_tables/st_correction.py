"""The on-line correction as IEC 61131-3 Structured Text, with its self-test, beside that of the tables."""

from __future__ import annotations

from collections.abc import Mapping

from tuning_tables.controller_code.correction_code import correction_code
from tuning_tables.controller_code.st_export import st_export
from tuning_tables.correction import Correction
from tuning_tables.export_prefix import RETARDER, ExportPrefix
from tuning_tables.language.st_unit import Export
from tuning_tables.plc_forms.iec import unit_files


def correction_export(correction: Correction, prefix: ExportPrefix = RETARDER) -> Export:
    """The blocks and the self-test, to be laid out in any form."""
    return st_export(correction_code(correction), prefix)


def correction_st_unit_files(correction: Correction, prefix: ExportPrefix = RETARDER) -> Mapping[str, bytes]:
    """The same units, a file each; by their names in the order in which they need each other."""
    # Behind the name, so that they sort beside, not among, the numbered units of the tables.
    units = unit_files(correction_export(correction, prefix))
    return {f"correction_{name}": text for name, text in units.items()}
