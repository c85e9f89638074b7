"""Which names each tool takes: how long they may be, and the words that it keeps for itself.

The lists were put together by hand, from the standard, from the sources of MATIEC, and from the manuals of the tools.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

from tuning_tables.errors import IllegalName
from tuning_tables.language.st_unit import Export, units_of
from tuning_tables.plc_forms.words import CODESYS_WORDS, IEC_WORDS, MATIEC_WORDS, TIA_WORDS, TWINCAT_WORDS


@dataclass(frozen=True)
class Tool:
    """A tool that imports an export: `words` in capitals, which no name may be, and `longest`, characters of a name."""

    title: str
    words: frozenset[str]
    longest: int


def _words(*texts: str) -> frozenset[str]:
    return frozenset(word for text in texts for word in text.split())


LATCH_INPUTS: Final = " ".join(f"{letter}1" for letter in "RS")
"""Of the standard's blocks SR and RS."""
IEC: Final = Tool("IEC 61131-3", _words(IEC_WORDS, LATCH_INPUTS), 32)
"""The standard sets no length; compilers are known that keep 32 characters."""
CODESYS: Final = Tool("CODESYS", _words(IEC_WORDS, CODESYS_WORDS), 255)
MATIEC: Final = Tool("MATIEC (Beremiz, OpenPLC)", _words(IEC_WORDS, MATIEC_WORDS), 255)
TWINCAT: Final = Tool("TwinCAT", _words(IEC_WORDS, CODESYS_WORDS, TWINCAT_WORDS), 255)
TIA: Final = Tool("the TIA Portal", _words(IEC_WORDS, TIA_WORDS), 125)
"""STEP 7 before it took 24 characters; our names are longer, so it is not among the tools."""

TOOLS: Final = (IEC, CODESYS, MATIEC, TWINCAT, TIA)


def names_in(export: Export) -> Iterator[str]:
    """All names that an export declares, some more than once."""
    for unit in units_of(export):
        yield unit.name
        yield from (each.name for each in unit.variables)


def require_legal(export: Export, *tools: Tool) -> None:
    """`IllegalName` if a name of the export is none that one of `tools` takes."""
    for name in dict.fromkeys(names_in(export)):
        for tool in tools:
            if len(name) > tool.longest:
                raise IllegalName(f"{name} has {len(name)} characters, but {tool.title} takes {tool.longest} at most")
            if name.upper() in tool.words or "__" in name or name.endswith("_"):
                raise IllegalName(f"{name} is a word that {tool.title} keeps for itself")
