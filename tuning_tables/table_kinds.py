"""The kinds of tables: what each is called in files, and the class that declares its members."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Final, TypeAlias

from tuning_tables.aim.aim_table import AimTable
from tuning_tables.passages.passage_table import PassageTable
from tuning_tables.table import ControllerTable

StageTable: TypeAlias = ControllerTable | PassageTable
"""A table from which a controller takes stages."""
AnyTable: TypeAlias = StageTable | AimTable

KINDS: Final[Mapping[str, type[AnyTable]]] = MappingProxyType(
    {"lines": ControllerTable, "passages": PassageTable, "aim": AimTable}
)
"""By the word at "kind"."""
MEANINGS: Final[Mapping[str, str]] = MappingProxyType({
    "lines": "switching lines over the path",
    "passages": "switching speeds at passages over point sensors",
    "aim": "exit speeds by cars and free distance",
})  # fmt: skip
"""What a table of each kind has."""
BOOK_KINDS: Final = ("lines", "passages")
"""The kinds of which there are books."""


def kind_of(table: type[object]) -> str:
    """The word of a class of tables."""
    return next(kind for kind, each in KINDS.items() if each is table)
