"""The forms that Structured Text is exported in: how each is laid out, and for which tools its names must be legal."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

from synth.frame.input_error import InputError
from synth.retarder.forms.code_options import CodeOptions
from tuning_tables.errors import IllegalName
from tuning_tables.language.st_unit import Export
from tuning_tables.plc_forms.iec import Layout, part_files, unit_files
from tuning_tables.plc_forms.names import CODESYS, IEC, MATIEC, TIA, TWINCAT, Tool, require_legal
from tuning_tables.plc_forms.plcopen import plcopen_files
from tuning_tables.plc_forms.scl import scl_files
from tuning_tables.plc_forms.twincat import twincat_files


@dataclass(frozen=True)
class PlcForm:
    """How an export is laid out: whole, and with a file each unit where `--split` asks for that."""

    tools: tuple[Tool, ...]
    whole: Layout
    split: Layout | None = None

    def files(self, export: Export, options: CodeOptions) -> Mapping[str, bytes]:
        """The files by name; `InputError` where the prefix gives a name that a tool does not take."""
        try:
            require_legal(export, *self.tools)
        except IllegalName as fault:
            raise InputError(f"--prefix {options.prefix.text}: {fault}; give another prefix") from None
        return (self.split or self.whole)(export) if options.split else self.whole(export)


PLC_FORMS: Final[Mapping[str, PlcForm]] = {
    "st": PlcForm((IEC,), part_files, unit_files),
    "plcopen": PlcForm((CODESYS, MATIEC), plcopen_files),
    "twincat": PlcForm((TWINCAT,), twincat_files),
    "scl": PlcForm((TIA,), scl_files),
}
