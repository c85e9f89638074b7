"""Where in a JSON document a value stands, for the sentence that refuses it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NoReturn

from tuning_tables.errors import DamagedTable
from tuning_tables.excerpt import excerpt


@dataclass(frozen=True)
class Place:
    """The value at `path` (dotted, "" for the document) of the file `source`."""

    source: str
    path: str = ""

    def key(self, name: str) -> Place:
        """The member `name` of the object here."""
        return Place(self.source, f"{self.path}.{name}" if self.path else name)

    def item(self, index: int) -> Place:
        """The entry `index` of the array here."""
        return Place(self.source, f"{self.path}[{index}]")

    def refuse(self, value: object, wanted: str) -> NoReturn:
        """Raise `DamagedTable`: `value` stands here, but it must be `wanted`."""
        named = self.path or "the document"
        raise DamagedTable(f"{self.source}: {named} is {excerpt(repr(value))}, but it must be {wanted}.")

    def members(self, value: object, keys: Sequence[str]) -> dict[str, object]:
        """`value`, an object with exactly these keys; raises `DamagedTable`."""
        if not isinstance(value, dict):
            self.refuse(value, "an object")
        for key in keys:
            if key not in value:
                raise DamagedTable(f"{self.source}: {self.key(key).path} is missing; export the table again.")
        for key in value:
            if key not in keys:
                named, found = self.path or "the document", excerpt(repr(key))
                raise DamagedTable(
                    f"{self.source}: {named} has the unknown key {found}; allowed are {', '.join(keys)}."
                )
        return value

    def array(self, value: object) -> list[object]:
        """`value`, an array; raises `DamagedTable`."""
        if not isinstance(value, list):
            self.refuse(value, "an array")
        return value
