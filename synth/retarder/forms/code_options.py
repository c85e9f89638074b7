"""What may be asked of an export of controller code, from the words of the command line; and the forms of Structured
Text: how each is laid out, and for which tools its names must be legal.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

from synth.frame.faults import InputError
from tuning_tables.correction import LARGEST_LIMIT_M_S, LEAST_LIMIT_M_S
from tuning_tables.errors import IllegalName
from tuning_tables.export_names import RETARDER, ExportPrefix
from tuning_tables.language.st_layout import Layout, part_files, unit_files
from tuning_tables.language.st_unit import Export
from tuning_tables.plc_forms.makers import scl_files, twincat_files
from tuning_tables.plc_forms.names import CODESYS, IEC, MATIEC, TIA, TWINCAT, Tool, require_legal
from tuning_tables.plc_forms.plcopen import plcopen_files
from tuning_tables.self_test_size import FULL, SMALL, SelfTestSize

SELF_TESTS: Mapping[str, SelfTestSize] = {"full": FULL, "small": SMALL}
PLC_NAMES: Final = ("st", "plcopen", "twincat", "scl")
"""The forms of Structured Text."""
CODE_NAMES: Final = ("c", *PLC_NAMES)
"""The forms of code."""
FMU_NAMES: Final = ("fmu", "fmu2")
"""The forms of units of the Functional Mock-up Interface, versions 3.0 and 2.0."""
CONTROLLER_NAMES: Final = (*CODE_NAMES, *FMU_NAMES)
"""The forms that hold a controller: all tables together, with the rule."""
OPTIONS: Mapping[str, tuple[str, ...]] = {
    "--prefix": CONTROLLER_NAMES,
    "--self-test": CODE_NAMES,
    "--split": ("st",),
    "--correction": CODE_NAMES,
}
"""The forms that have each option."""


@dataclass(frozen=True)
class CodeOptions:
    """`prefix` of all names, what the `self_test` asks; `split`: a file each unit of Structured Text.

    `correction_m_s`: limit of the on-line correction whose code comes with the tables, None for none.
    """

    prefix: ExportPrefix = RETARDER
    self_test: SelfTestSize = FULL
    split: bool = False
    correction_m_s: float | None = None


PLAIN = CodeOptions()


def code_options(
    form: str, prefix: str | None, self_test: str | None, split: bool, correction_m_s: float | None = None
) -> CodeOptions:
    """The options as given, None for those that were not; `InputError` where `form` has no such option or value."""
    given = {
        "--prefix": prefix is not None,
        "--self-test": self_test is not None,
        "--split": split,
        "--correction": correction_m_s is not None,
    }
    for name in given:
        if given[name] and form not in OPTIONS[name]:
            raise InputError(f"{name} is for --format {', '.join(OPTIONS[name])}, not for {form}; leave it out")
    if self_test is not None and self_test not in SELF_TESTS:
        raise InputError(f"--self-test {self_test}: there is no such self-test; give {', '.join(SELF_TESTS)}")
    try:
        named = RETARDER if prefix is None else ExportPrefix(prefix)
    except ValueError as fault:
        raise InputError(f"--prefix {prefix}: {fault}") from None
    if correction_m_s is not None and not LEAST_LIMIT_M_S <= correction_m_s <= LARGEST_LIMIT_M_S:
        raise InputError(
            f"--correction {correction_m_s:g}: the limit of the correction must lie between {LEAST_LIMIT_M_S:g} and "
            f"{LARGEST_LIMIT_M_S:g} m/s; give 0.15"
        )
    return CodeOptions(named, SELF_TESTS[self_test or "full"], split, correction_m_s)


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
