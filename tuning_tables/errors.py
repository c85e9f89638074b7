"""Why a table was refused, what one value of a table must be, and a long text cut to what a message can show.

Each class is one answer to "what do I do now?": correct the values, export again, take another file, or take another
version of the tool. Every message is one sentence that names the file, the key, the value and what is allowed. The
functions raise `InvalidTable` with these. They check and change nothing, so a frozen dataclass holds exactly what its
caller gave.
"""

from __future__ import annotations

import math
import re
from itertools import pairwise
from typing import Final

import numpy as np


class TableError(ValueError):
    """A controller table, or a file that should hold one, was refused."""


class InvalidTable(TableError):
    """The values handed over make no table that a controller may run: correct them where they are computed."""


class DamagedTable(TableError):
    """The file is not what was exported (cut off, changed, incomplete, of another shape): export it again."""


class UnknownFormat(TableError):
    """The file is sound in its own right, but it is not a table or book of this project."""


class OtherKind(TableError):
    """The file is sound, but its table is of another kind than is needed here: give another."""


class NewerVersion(TableError):
    """The file was written to a later version of the format than this reader knows: update the reader."""


class IllegalName(ValueError):
    """A name of the export is none that a tool takes: choose another prefix."""


class InvalidLog(ValueError):
    """A file of measured passes, or its mapping, cannot be used: correct the file, the mapping, or leave it out."""


def excerpt(text: str, longest: int = 60) -> str:
    """`text` itself, or its beginning and its end around "..." where it has more than `longest` (>= 5) characters."""
    if len(text) <= longest:
        return text
    kept = longest - len("...")
    return f"{text[: kept - kept // 2]}...{text[len(text) - kept // 2 :]}"


UTC_INSTANT: Final = r"^[0-9]{4}-[0-9]{2}-[0-9]{2}T[0-9]{2}:[0-9]{2}:[0-9]{2}(\.[0-9]{1,9})?Z$"
SHA256_HEX: Final = r"^[0-9a-f]{64}$"
LARGEST_EXACT_INTEGER: Final = 2**53


def require_text(value: object, key: str) -> None:
    """`value` is a non-empty printable string (so it survives JSON, CSV, HDF5 and a C comment alike)."""
    if not isinstance(value, str) or not value or not value.isprintable():
        raise InvalidTable(f"{key} is {value!r}, but it must be a non-empty string of printable characters.")


def require_match(value: object, key: str, pattern: str, example: str) -> None:
    """`value` is a string that matches `pattern` as a whole."""
    # `$` alone would let a closing line feed through.
    if not isinstance(value, str) or re.fullmatch(pattern, value) is None:
        raise InvalidTable(f"{key} is {value!r}, but it must have the form {example}.")


def require_finite(value: object, key: str) -> None:
    """`value` is a Python number (no bool, no numpy scalar but float64), finite as a double, and not -0.0.

    The canonical form of a table writes -0.0 as 0, so its checksum could not tell the two apart.
    """
    if not _is_finite(value):
        raise InvalidTable(f"{key} is {value!r:.60}, but it must be a finite number of type float.")
    if value == 0 and math.copysign(1.0, value) < 0.0:
        raise InvalidTable(f"{key} is -0.0, but a zero must have no sign; add 0.0 to it.")


def require_between(value: object, key: str, smallest: float, largest: float = math.inf) -> None:
    """`value` is finite and smallest <= value <= largest."""
    require_finite(value, key)
    if not smallest <= value <= largest:  # type: ignore[operator]  # a number, as it is finite
        raise InvalidTable(f"{key} is {value!r}, but it must lie in [{smallest!r}, {largest!r}].")


def require_positive(value: object, key: str) -> None:
    """`value` is finite and > 0."""
    require_finite(value, key)
    if not value > 0:  # type: ignore[operator]  # a number, as it is finite
        raise InvalidTable(f"{key} is {value!r}, but it must be greater than 0.")


def require_count(value: object, key: str, smallest: int, largest: int = LARGEST_EXACT_INTEGER) -> None:
    """`value` is a Python int (no bool) and smallest <= value <= largest."""
    if not isinstance(value, int) or isinstance(value, bool) or not smallest <= value <= largest:
        raise InvalidTable(f"{key} is {value!r}, but it must be a whole number in [{smallest}, {largest}].")


def require_float32(value: float, key: str) -> None:
    """`value`, which is finite, is a float32 number."""
    with np.errstate(over="ignore"):
        nearest = float(np.float32(value))
    if nearest != value:
        raise InvalidTable(
            f"{key} is {value!r}, which float32 cannot hold (nearest: {nearest!r}); round it with round_coefficients."
        )


def require_tuple(value: object, key: str, length: int | None = None) -> None:
    """`value` is a tuple, of `length` entries if a length is given (a list would leave the table mutable)."""
    if not isinstance(value, tuple) or (length is not None and len(value) != length):
        wanted = "a tuple" if length is None else f"a tuple of {length} entries"
        raise InvalidTable(f"{key} is {value!r}, but it must be {wanted}.")


def require_rising(values: tuple[float, ...], key: str) -> None:
    """`values` is a non-empty tuple of finite numbers, each greater than the one before."""
    require_tuple(values, key)
    for index, value in enumerate(values):
        require_finite(value, f"{key}[{index}]")
    if not values or any(not earlier < later for earlier, later in pairwise(values)):
        raise InvalidTable(f"{key} is {values!r}, but it must hold at least one number and rise strictly.")


def require_kind(value: object, key: str, kind: type) -> None:
    """`value` is an instance of the class `kind`."""
    if not isinstance(value, kind):
        raise InvalidTable(f"{key} is {value!r}, but it must be a {kind.__name__}.")


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _is_finite(value: object) -> bool:
    try:
        return _is_number(value) and math.isfinite(value)  # type: ignore[arg-type]  # a number
    except OverflowError:  # a whole number beyond the doubles
        return False
