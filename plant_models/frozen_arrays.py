"""Frozen values whose arrays are read-only too, which `dataclass(frozen=True)` alone does not see to; their words."""

from __future__ import annotations

from dataclasses import dataclass, field, fields
from functools import cache, wraps
from typing import Any, TypeVar, dataclass_transform

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]
"""What annotations call arrays of numbers, of whole numbers, of truth values."""

_T = TypeVar("_T")


def read_only(array: NDArray[Any]) -> NDArray[Any]:
    """`array`, made so."""
    array.setflags(write=False)
    return array


@dataclass_transform(frozen_default=True, eq_default=False, field_specifiers=(field,))
def frozen_arrays(cls: type[_T]) -> type[_T]:
    """Make `cls` a frozen dataclass, unless it is one, and every array that is a field of it read-only: when it is
    made, unpickled or copied.

    It is `dataclass(frozen=True, eq=False)`: `eq=False` because `==` of two arrays is no truth value: such
    values are equal if they are the same object, and can be keys. The array that the maker hands over becomes
    read-only itself, no copy is made: hand over a copy of what you want to go on writing. `repr` tells type and shape
    of an array, not its numbers, unless the class has its own.
    """
    if "__dataclass_fields__" not in vars(cls):
        cls = dataclass(frozen=True, eq=False)(cls)
    made = cls.__init__

    @wraps(made)
    def init(self: _T, *args: Any, **kwargs: Any) -> None:
        made(self, *args, **kwargs)
        freeze(self)

    def restore(self: _T, state: dict[str, Any]) -> None:
        vars(self).update(state)
        freeze(self)

    def shown(self: _T) -> str:
        shown_fields = [field.name for field in fields(self) if field.repr]  # type: ignore[arg-type]  # a dataclass
        parts = [f"{name}={brief(getattr(self, name))}" for name in shown_fields]
        return f"{type(self).__name__}({', '.join(parts)})"

    # A decorator changes the class; mypy forbids this to everybody.
    cls.__init__ = init  # type: ignore[method-assign, assignment]  # see above
    if hasattr(cls.__repr__, "__wrapped__"):  # that of `dataclass`, which guards it against endless recursion
        cls.__repr__ = shown  # type: ignore[method-assign, assignment]  # see above
    cls.__setstate__ = restore  # type: ignore[attr-defined]  # see above
    return cls


def brief(value: Any) -> str:
    """`float64 (210,)` for an array, the `repr` of anything else."""
    return f"{value.dtype} {value.shape}" if isinstance(value, np.ndarray) else repr(value)


def freeze(value: Any) -> None:
    """Make the arrays among the fields of the dataclass instance `value` read-only, also those in a tuple."""
    for name in _field_names(value.__class__):
        held = getattr(value, name)
        if isinstance(held, np.ndarray):
            held.setflags(write=False)
        elif isinstance(held, tuple):
            for array in held:
                if isinstance(array, np.ndarray):
                    array.setflags(write=False)


@cache
def _field_names(cls: Any) -> tuple[str, ...]:
    # `fields` goes through all of them at every call, and a train makes a hundred thousand such values.
    return tuple(field.name for field in fields(cls))
