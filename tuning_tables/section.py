"""One object of a JSON document, read strictly: exactly the keys it should have, each of exactly the right type."""

from __future__ import annotations

import math
from typing import NoReturn

from tuning_tables.errors import DamagedTable
from tuning_tables.excerpt import excerpt


class Section:
    """The object `value` found at `path` (dotted, "" for the document) of the file `source`.

    Every method raises `DamagedTable`, naming file and key, where the content is of another type; the constructor does
    where a key of `required` is missing or one of neither `required` nor `optional` is there.
    """

    def __init__(
        self, value: object, source: str, path: str, required: tuple[str, ...], optional: tuple[str, ...] = ()
    ) -> None:
        self._source = source
        self._path = path
        if not isinstance(value, dict):
            self._refuse(path, value, "an object")
        self._members: dict[str, object] = value
        for key in required:
            if key not in value:
                raise DamagedTable(f"{source}: {self._dotted(key)} is missing; export the table again.")
        for key in value:
            if key not in required and key not in optional:
                known = ", ".join(required + optional)
                found = excerpt(repr(key))
                raise DamagedTable(
                    f"{source}: {path or 'the document'} has the unknown key {found}; allowed are {known}."
                )

    def __contains__(self, key: str) -> bool:
        return key in self._members

    def value(self, key: str) -> object:
        """Whatever stands at `key`."""
        return self._members[key]

    def section(self, key: str, required: tuple[str, ...], optional: tuple[str, ...] = ()) -> Section:
        """The object at `key`."""
        return Section(self._members[key], self._source, self._dotted(key), required, optional)

    def sections(self, key: str, required: tuple[str, ...]) -> list[Section]:
        """The array of objects at `key`."""
        return [
            Section(item, self._source, f"{self._dotted(key)}[{index}]", required)
            for index, item in enumerate(self._array(self._members[key], self._dotted(key)))
        ]

    def text(self, key: str) -> str:
        """The string at `key`."""
        value = self._members[key]
        if not isinstance(value, str):
            self._refuse(self._dotted(key), value, "a string")
        return value

    def count(self, key: str) -> int:
        """The integer at `key`, written without a decimal point."""
        return self._count(self._members[key], self._dotted(key))

    def counts(self, key: str) -> tuple[int, ...]:
        """The array of integers at `key`, each written without a decimal point."""
        path = self._dotted(key)
        items = enumerate(self._array(self._members[key], path))
        return tuple(self._count(item, f"{path}[{index}]") for index, item in items)

    def number(self, key: str) -> float:
        """The number at `key`; -0.0 is none."""
        return self._number(self._members[key], self._dotted(key))

    def number_or_null(self, key: str) -> float | None:
        """The number at `key`, None for null."""
        return None if self._members[key] is None else self.number(key)

    def numbers(self, key: str) -> tuple[float, ...]:
        """The array of numbers at `key`."""
        return self._numbers(self._members[key], self._dotted(key))

    def numbers_or_null(self, key: str) -> tuple[float, ...] | None:
        """The array of numbers at `key`, None for null."""
        return None if self._members[key] is None else self.numbers(key)

    def pair(self, key: str) -> tuple[float, float]:
        """The array of two numbers at `key`."""
        return self._pair(self._members[key], self._dotted(key))

    def pairs(self, key: str) -> tuple[tuple[float, float], ...]:
        """The array of arrays of two numbers at `key`."""
        path = self._dotted(key)
        items = self._array(self._members[key], path)
        return tuple(self._pair(item, f"{path}[{index}]") for index, item in enumerate(items))

    def rows_or_nulls(self, key: str) -> tuple[tuple[float | None, ...], ...]:
        """The array of arrays of numbers at `key`, None for each null in them."""
        path = self._dotted(key)
        return tuple(
            tuple(
                None if item is None else self._number(item, f"{path}[{row}][{column}]")
                for column, item in enumerate(self._array(items, f"{path}[{row}]"))
            )
            for row, items in enumerate(self._array(self._members[key], path))
        )

    def _pair(self, value: object, path: str) -> tuple[float, float]:
        numbers = self._numbers(value, path)
        if len(numbers) != 2:
            self._refuse(path, value, "an array of two numbers")
        return numbers[0], numbers[1]

    def _numbers(self, value: object, path: str) -> tuple[float, ...]:
        return tuple(self._number(item, f"{path}[{index}]") for index, item in enumerate(self._array(value, path)))

    def _number(self, value: object, path: str) -> float:
        # JSON's true is no number, though Python's is.
        if not isinstance(value, int | float) or isinstance(value, bool):
            self._refuse(path, value, "a number")
        number = float(value)
        if number == 0.0 and math.copysign(1.0, number) < 0.0:
            # The canonical form, and so the checksum, does not tell it from 0.0.
            self._refuse(path, value, "0.0, without a sign")
        return number

    def _count(self, value: object, path: str) -> int:
        if not isinstance(value, int) or isinstance(value, bool):
            self._refuse(path, value, "a whole number")
        return value

    def _array(self, value: object, path: str) -> list[object]:
        if not isinstance(value, list):
            self._refuse(path, value, "an array")
        return value

    def _dotted(self, key: str) -> str:
        return f"{self._path}.{key}" if self._path else key

    def _refuse(self, path: str, value: object, wanted: str) -> NoReturn:
        found = excerpt(repr(value))
        raise DamagedTable(f"{self._source}: {path or 'the document'} is {found}, but it must be {wanted}.")
