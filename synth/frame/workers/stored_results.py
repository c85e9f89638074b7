"""Results that earlier runs have stored, a file under a seal for each order: what of them is there and whole."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

from synth.frame.workers.engine import OrderOfKind, Watcher
from tuning_tables import DamagedTable
from tuning_tables.seal import unsealed


def missing_of(
    orders: Sequence[OrderOfKind], file_of: Callable[[str], Path], watcher: Watcher
) -> tuple[OrderOfKind, ...]:
    """The orders without a whole result; `file_of`: the file of a result by the key of its order."""
    return tuple(order for order in orders if not is_whole(file_of(order.key), watcher))


def is_whole(path: Path, watcher: Watcher) -> bool:
    """Whether a sealed file is at `path` and no byte of it has changed; a damaged one is told of."""
    try:
        unsealed(path.read_bytes(), str(path))
    except FileNotFoundError:
        return False
    except DamagedTable:
        watcher.note(f"{path} is damaged; what it held is computed again")
        return False
    return True
