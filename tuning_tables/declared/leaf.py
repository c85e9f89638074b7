"""What stands at a key without further keys below it: a text, a number, or numbers in rows."""

from __future__ import annotations

from typing import Any, Protocol

from tuning_tables.declared.place import Place

Json = dict[str, Any]


class Leaf(Protocol):
    """What stands at a key without further keys below it.

    `dtype` and `axes` tell how a book holds it: a numpy type, "S" for text, and the axes beside those of its section.
    """

    @property
    def meaning(self) -> str:
        """What it is, without its unit, which its name tells."""
        ...

    @property
    def unit(self) -> str:
        """Its unit where its name does not tell it, else ""."""
        ...

    @property
    def allowed(self) -> str:
        """Its limits in words."""
        ...

    @property
    def axes(self) -> tuple[str, ...] | None:
        """The axes of its numbers; None where they are those of the whole table, so that no book holds it."""
        ...

    @property
    def dtype(self) -> str:
        """Its type in a book."""
        ...

    def check(self, value: Any, key: str) -> None:
        """Raise `InvalidTable` unless `value`, which stands at `key`, is allowed."""
        ...

    def written(self, value: Any) -> object:
        """`value` as JSON holds it."""
        ...

    def read(self, value: object, place: Place) -> Any:
        """What the JSON `value` at `place` is; raises `DamagedTable` for another type."""
        ...

    def schema(self) -> Json:
        """Its JSON Schema."""
        ...

    def cells(self, value: Any) -> Any:
        """`value` as a book holds it: a number, a text, or numbers in rows."""
        ...

    def of_cells(self, cells: Any) -> Any:
        """The value in the cells of a book, less what fills them up; raises `InvalidTable`."""
        ...
