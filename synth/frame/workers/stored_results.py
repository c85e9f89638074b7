"""Results that earlier runs have stored, a file for each order: what of them is there and whole."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

from synth.frame.workers.engine import OrderOfKind, Watcher
from tuning_tables import TableError


def missing_of(
    orders: Sequence[OrderOfKind],
    file_of: Callable[[str], Path],
    read: Callable[[OrderOfKind], object],
    watcher: Watcher,
) -> tuple[OrderOfKind, ...]:
    """The orders without a whole result of their own.

    `file_of`: the file of a result by the key of its order; `read`: reads the result of an order, and raises
    `TableError` where that is damaged or another one's, which is told.
    """

    def is_whole(order: OrderOfKind) -> bool:
        try:
            read(order)
        except FileNotFoundError:
            return False
        except TableError:
            watcher.note(f"{file_of(order.key)} is damaged; what it held is computed again")
            return False
        return True

    return tuple(order for order in orders if not is_whole(order))
