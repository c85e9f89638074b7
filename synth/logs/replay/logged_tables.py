"""Which table of a book a controller regulates each measured pass with."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from plant_models.frozen_arrays import Ints, frozen_arrays
from synth.logs.fitting_passes import FittingPasses
from tuning_tables import ControllerTable
from tuning_tables.active_table import ActiveTable
from tuning_tables.table_book import Choice, Status, TableBook

NO_TABLE = -1


@frozen_arrays
class LoggedTables:
    """`tables` that passes are regulated with; `of_pass` (m,): number of that of each pass, `NO_TABLE` for none, and
    then `reason` (m of them) says why; '' otherwise."""

    tables: tuple[ActiveTable, ...]
    of_pass: Ints
    reason: tuple[str, ...]


def logged_tables(passes: FittingPasses, tables: Sequence[ControllerTable]) -> LoggedTables:
    """The lines that a book of `tables` chooses for category, axles and target of each pass (`table_book`).

    A single table stands for its own target only. Without a category in the log, that of the class counts.
    """
    log, book = passes.log, TableBook(tuple(tables))
    chosen: dict[tuple[str, int, float], tuple[int, str]] = {}
    found: list[ActiveTable] = []
    of_pass, reasons = np.full(len(log), NO_TABLE, dtype=np.int64), []
    for number in range(len(log)):
        category = log.category[number] or passes.plants[passes.class_of[number]][1].cut.category
        key = (category, int(log.axles[number]), float(log.target_m_s[number]))
        if np.isnan(key[2]):
            reasons.append("no target is logged")
            continue
        if key not in chosen:
            choice = book.choose(*key)
            why = refusal(choice, key, alone=len(tables) == 1)
            if not why and choice.table is not None:
                found.append(choice.table)
            chosen[key] = (NO_TABLE if why else len(found) - 1, why)
        of_pass[number], why = chosen[key]
        reasons.append(why)
    return LoggedTables(tuple(found), of_pass, tuple(reasons))


def refusal(choice: Choice, key: tuple[str, int, float], alone: bool) -> str:
    """Why the choice for (category, axles, target) is not used; '' where it is."""
    category, axles, target = key
    if choice.status is Status.NO_CLASS:
        return f"no table is for {category} on {axles} axles"
    if choice.table is None or (alone and choice.status is not Status.TUNED):
        return f"no table of {category} on {axles} axles is for {target:g} m/s"
    return ""
