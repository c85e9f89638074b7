"""The tables of a book that a cut may be regulated by, by what the yard knows of it: category and number of axles."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import Protocol

import numpy as np

from tuning_tables.book_categories import OfClass


class ForTarget(OfClass, Protocol):
    """A table of either kind, for a class of cuts and an exit speed."""

    @property
    def target_speed_m_s(self) -> float:
        """Exit speed that it aims at."""
        ...


def tables_by_class(tables: Sequence[ForTarget]) -> Mapping[tuple[str, int], tuple[int, ...]]:
    """Of every class (category, axles) the numbers of its tables by rising target, one a target; first classes first.

    If several masses answer to a class, those of the largest mass: they begin to brake first. Speeds and masses are
    compared as float32 numbers; of equal tables the first counts.
    """
    members: dict[tuple[str, int], list[int]] = {}
    for number, table in enumerate(tables):
        members.setdefault((table.cut.category, len(table.cut.axle_offsets_m)), []).append(number)
    return MappingProxyType({each: _heaviest_by_target(tables, numbers) for each, numbers in members.items()})


def _heaviest_by_target(tables: Sequence[ForTarget], numbers: Sequence[int]) -> tuple[int, ...]:
    heaviest = max(np.float32(tables[number].cut.mass_t) for number in numbers)
    by_target: dict[float, int] = {}
    for number in numbers:
        if np.float32(tables[number].cut.mass_t) == heaviest:
            by_target.setdefault(float(np.float32(tables[number].target_speed_m_s)), number)
    return tuple(by_target[target] for target in sorted(by_target))
