"""How a foreign log names and measures its columns: a small TOML file.

delimiter = ";"
decimal = ","
path = "from speed"

[columns]
time_s = "t"

[units]
speed_m_s = "km/h"

[constant]
mass_t = 80.0
"""

from __future__ import annotations

import os
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Final

from tuning_tables.errors import DamagedTable, InvalidLog, excerpt
from tuning_tables.pass_log.log_columns import COLUMNS, LONGEST_TEXT, RANGES, TEXTS, WHOLE
from tuning_tables.whole_file import read_regular_file

LARGEST_MAPPING_BYTES: Final = 100_000

SPEEDS: Final = {"m/s": 1.0, "km/h": 1.0 / 3.6, "mph": 0.44704, "ft/s": 0.3048}
UNITS: Final[Mapping[str, Mapping[str, float]]] = {
    "time_s": {"s": 1.0, "ms": 1e-3, "min": 60.0},
    "path_m": {"m": 1.0, "cm": 0.01, "ft": 0.3048},
    "speed_m_s": SPEEDS,
    "pressure_kpa": {"kPa": 1.0, "bar": 100.0, "MPa": 1000.0, "psi": 6.894757293168361},
    "mass_t": {"t": 1.0, "kg": 1e-3, "lb": 0.00045359237},
    "target_m_s": SPEEDS,
}
"""Of each column, how much of its own unit one of another is."""

PATHS: Final = {"independent": True, "from speed": False}
DELIMITERS: Final = (",", ";", "\t", "|")
KEYS: Final = ("columns", "units", "constant", "delimiter", "decimal", "path")


@dataclass(frozen=True)
class LogMapping:
    """How a foreign log names and measures its columns; `read_mapping` makes no other than right ones.

    `columns`: foreign name by own name; `factors`: by own name, what the file's numbers are multiplied with;
    `constant`: values, in own units, of columns that the file lacks; `path_is_independent`: None leaves it to the file.
    `delimiter`: between cells, `decimal`: in numbers.

    Examples
    --------
    >>> from tuning_tables.pass_log import LogMapping
    >>> LogMapping(
    ...     columns={"speed_m_s": "v"}, factors={"speed_m_s": 1.0 / 3.6}, delimiter=";"
    ... ).decimal
    '.'
    """

    columns: Mapping[str, str] = field(default_factory=dict)
    factors: Mapping[str, float] = field(default_factory=dict)
    constant: Mapping[str, float | str] = field(default_factory=dict)
    delimiter: str = ","
    decimal: str = "."
    path_is_independent: bool | None = None


def read_mapping(path: str | os.PathLike[str]) -> LogMapping:
    """Read a mapping; the page on pass logs shows one.

    Parameters
    ----------
    path
        A TOML file.

    Returns
    -------
    LogMapping
        What the file says.

    Raises
    ------
    InvalidLog
        Anything unknown in it.
    OSError
        There is no such file.

    Examples
    --------
    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> from tuning_tables.pass_log import read_mapping
    >>> with TemporaryDirectory() as folder:
    ...     file = Path(folder, "mapping.toml")
    ...     _ = file.write_text('columns.speed_m_s = "v"\\nunits.speed_m_s = "km/h"')
    ...     read_mapping(file).columns
    {'speed_m_s': 'v'}
    """
    source = os.fspath(path)
    try:
        tree = tomllib.loads(read_regular_file(path, LARGEST_MAPPING_BYTES).decode())
        repr(tree)  # a hexadecimal number is read in any length, but not told
    except DamagedTable as fault:
        raise InvalidLog(str(fault)) from fault
    except (ValueError, RecursionError) as fault:  # no UTF-8, no TOML, or a number of thousands of digits
        raise InvalidLog(f"{source}: no TOML file ({excerpt(str(fault), 200)}); correct it there.") from fault
    _require_known(source, "", tree, KEYS)
    delimiter = _one_of(source, "delimiter", tree.get("delimiter", ","), DELIMITERS)
    decimal = _one_of(source, "decimal", tree.get("decimal", "."), (".", ","))
    if delimiter == decimal:
        raise InvalidLog(f'{source}: decimal and delimiter are both ","; give another delimiter, such as ";".')
    constant = {name: _constant(source, name, value) for name, value in _section(source, tree, "constant", COLUMNS)}
    columns = {
        name: _text(source, f"columns.{name}", value) for name, value in _section(source, tree, "columns", COLUMNS)
    }
    if both := sorted(constant.keys() & columns.keys()):
        raise InvalidLog(f"{source}: {both[0]} stands in [columns] and in [constant]; leave one of them.")
    units = {
        name: UNITS[name][_one_of(source, f"units.{name}", unit, tuple(UNITS[name]))]
        for name, unit in _section(source, tree, "units", tuple(UNITS))
    }
    path_key = tree.get("path")
    independent = None if path_key is None else PATHS[_one_of(source, "path", path_key, tuple(PATHS))]
    return LogMapping(columns, units, constant, delimiter, decimal, independent)


def _section(source: str, tree: Mapping[str, Any], name: str, known: tuple[str, ...]) -> list[tuple[str, Any]]:
    section = tree.get(name, {})
    if not isinstance(section, dict):
        raise InvalidLog(f"{source}: {name} is {section!r:.60}; it must be a table, [{name}].")
    _require_known(source, f"{name}.", section, known)
    return list(section.items())


def _require_known(source: str, where: str, keys: Mapping[str, Any], known: tuple[str, ...]) -> None:
    for key in keys:
        if key not in known:
            raise InvalidLog(f"{source}: {where}{excerpt(key)} is not known; it must be one of {', '.join(known)}.")


def _one_of(source: str, key: str, value: Any, allowed: tuple[str, ...]) -> str:
    if not isinstance(value, str) or value not in allowed:
        names = ", ".join(f'"{name}"' for name in allowed).replace("\t", "\\t")
        raise InvalidLog(f"{source}: {key} is {value!r:.60}; it must be one of {names}.")
    return value


def _text(source: str, key: str, value: Any) -> str:
    if not isinstance(value, str) or not value.strip() or not value.isprintable():
        raise InvalidLog(f"{source}: {key} is {value!r:.60}; it must be the name of a column of the log, in quotes.")
    return value.strip()


def _constant(source: str, name: str, value: Any) -> float | str:
    if name == "cut_id":
        raise InvalidLog(f"{source}: constant.cut_id is not possible: it tells the passes apart.")
    if name in TEXTS:
        text = _text(source, f"constant.{name}", value)
        if len(text) > LONGEST_TEXT:
            raise InvalidLog(f"{source}: constant.{name} is longer than {LONGEST_TEXT} characters; shorten it.")
        return text
    if (isinstance(value, bool) and name != "stopped_by_hand") or not isinstance(value, int | float):
        raise InvalidLog(f"{source}: constant.{name} is {value!r:.60}; it must be a number.")
    if name not in RANGES:
        raise InvalidLog(f"{source}: constant.{name} is not possible: it changes from row to row.")
    low, high, unit = RANGES[name]
    # Compared as it is: a whole number may be too long for a float.
    if not low <= value <= high or (name in WHOLE and value != int(value)):
        kind = "a whole number" if name in WHOLE else "a number"
        raise InvalidLog(
            f"{source}: constant.{name} is {value!r:.60}; it must be {kind} from {low:g} to {high:g}{unit}."
        )
    return float(value)
