"""Units as the names of numbers end with them, and as UDUNITS writes them."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Final

NO_UNIT: Final = "1"

UNITS: Final[Mapping[str, str]] = MappingProxyType({
    "m2_s2_per_kpa": "m2/s2 per kPa",
    "m_s_per_kpa": "m/s per kPa",
    "m2_s2": "m2/s2",
    "m2_s4": "m2/s4",
    "m_s2": "m/s2",
    "m_s": "m/s",
    "n_per_kn": "N/kN",
    "kpa": "kPa",
    "m": "m",
    "s": "s",
    "t": "t",
})  # fmt: skip
"""By the end of a name; each stands before one that it ends with."""


def ending_of(name: str) -> str:
    """The key of `UNITS` that `name` ends with, "" for a name without unit: "path_min_m" gives "m"."""
    return next((each for each in UNITS if name.endswith(f"_{each}")), "")


def unit_of(name: str) -> str:
    """The unit of the number called `name`, "1" for one without."""
    ending = ending_of(name)
    return UNITS[ending] if ending else NO_UNIT
