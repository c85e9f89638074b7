"""The files of the on-line correction that go with an export of controller tables."""

from __future__ import annotations

import math
import statistics
from collections.abc import Sequence
from typing import Final

from synth.frame.input_error import InputError
from synth.retarder.forms.code_options import CodeOptions
from synth.retarder.forms.table_forms import Files
from tuning_tables import ControllerTable
from tuning_tables.correction import Correction
from tuning_tables.table_kinds import AnyTable

EXIT_READING_STD_M_S: Final = 0.05
"""Of a measured exit speed: one reading of the library's Doppler radar; engineering judgement for any other sensor."""


def correction_files(form: str, tables: Sequence[AnyTable], options: CodeOptions) -> Files:
    """The code in `form` of a correction up to `options.correction_m_s`; no file where none is asked for.

    The spread of exits is the median of what the tables predict of theirs, with that of a reading. `InputError` without
    tables with lines: aim tables regulate nothing, and a passage over sensors has no samples to judge it by.
    """
    if options.correction_m_s is None:
        return {}
    with_lines = [table for table in tables if isinstance(table, ControllerTable)]
    if not with_lines:
        raise InputError(
            "--correction is for tables with lines, and these are aim tables or tables for point sensors; leave it out"
        )
    correction = correction_of(with_lines, options.correction_m_s)
    if form == "c":
        from tuning_tables.c_correction import correction_c_files

        return correction_c_files(correction, options.prefix)
    from synth.retarder.forms.plc_forms import PLC_FORMS
    from tuning_tables.st_correction import correction_export, correction_st_unit_files

    if options.split:
        return correction_st_unit_files(correction, options.prefix)
    return PLC_FORMS[form].files(correction_export(correction, options.prefix), options)


def correction_of(tables: Sequence[ControllerTable], limit_m_s: float) -> Correction:
    """The correction of a position with these tables."""
    rms = statistics.median(table.predicted.rms_m_s for table in tables)
    return Correction(limit_m_s, spread_m_s=min(math.hypot(rms, EXIT_READING_STD_M_S), 0.5))
