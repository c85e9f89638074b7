"""Long work in parts: what a worker is asked and answers, what a result depends on besides its configuration, and
which results of earlier runs are there and whole.
"""

from __future__ import annotations

import hashlib
import os
import platform
import time
from collections.abc import Callable, Generator, Sequence
from dataclasses import dataclass
from functools import cache
from importlib.metadata import version
from pathlib import Path
from typing import Any, Protocol, TypeVar

from synth.frame.faults import unforeseen
from synth.kernels.cache import compiling_facts
from tuning_tables import TableError


class Order(Protocol):
    """What an engine must know of an order: how it tells it from others. Work knows the rest of its own orders."""

    @property
    def key(self) -> str:
        """Of this order alone."""


@dataclass(frozen=True)
class Answer:
    """`result`, or None and the `reason` in one sentence; the `seconds` it took, the worker's name."""

    key: str
    result: Any
    reason: str = ""
    seconds: float = 0.0
    worker: str = ""


OrderOfKind = TypeVar("OrderOfKind", bound=Order)

Work = Callable[[Any], Answer]
"""From an order of its kind to the answer; never raises."""

Begun = Callable[[Any], None]


Tell = Callable[[str], None]
"""Is told a sentence when a step has ended."""


def silent(_sentence: str) -> None:
    """Nobody wants to know."""


class Watcher(Protocol):
    """Is told how far a run is, by any thread."""

    def note(self, sentence: str) -> None:
        """Something besides the results, or more of one."""

    def done(self, sentence: str) -> None:
        """A result is there, or has failed: once for each."""


@dataclass(frozen=True)
class Teller:
    """A watcher that counts nothing and passes every sentence on."""

    tell: Tell

    def note(self, sentence: str) -> None:
        """See `Watcher`."""
        self.tell(sentence)

    done = note


class Engine(Protocol):
    """Computes orders somewhere; answers come as they are ready, one for every order, whatever happens to workers."""

    def answers(self, orders: Sequence[Order], begun: Begun) -> Generator[Answer]:
        """`begun` is told of an order when it is given to a worker."""
        ...


@dataclass(frozen=True)
class InThisProcess:
    """One order after the other, here: what the other engines are checked against."""

    work: Work

    def answers(self, orders: Sequence[Order], begun: Begun) -> Generator[Answer]:
        """In the order given."""
        for order in orders:
            begun(order)
            yield self.work(order)


def answered(order: OrderOfKind, compute: Callable[[OrderOfKind], object]) -> Answer:
    """Compute an order; whatever is raised becomes the reason of a failure."""
    started = time.monotonic()
    try:
        result, reason = compute(order), ""
    except Exception as fault:
        result, reason = None, sentence_of(fault)
    return Answer(order.key, result, reason, time.monotonic() - started, worker_name())


def sentence_of(fault: Exception) -> str:
    """What was raised, in one line, with the place where it is none of our own words."""
    from plant_models import PlantError
    from tuning_tables import TableError

    if isinstance(fault, PlantError | TableError) or type(fault) is ValueError:
        return " ".join(str(fault).split()) or "no words"
    return unforeseen(fault)


def worker_name() -> str:
    """This process on this machine."""
    return f"{platform.node()}:{os.getpid()}"


SHOWING = frozenset({"checker", "cli", "page", "picture", "pictures", "shown", "terminal"})
"""Folders and files of what shows or checks results and makes none."""

PATTERNS = ("plant_models/**/*.py", "plant_models/**/*.toml", "synth/**/*.py", "tuning_tables/**/*.py")


@cache
def software_sha256() -> str:
    """64 hex digits that change with any source that can change a table, the versions that compute it, the processor.

    The processor counts because compiled kernels are made for it: another one may round otherwise.
    """
    root = Path(__file__).resolve().parents[3]
    digest = hashlib.sha256(f"{version('retarder-synth')}\0{version('scipy')}\0{compiling_facts()}".encode())
    names = {path.relative_to(root).as_posix(): path for pattern in PATTERNS for path in root.glob(pattern)}
    for name in sorted(names):
        if SHOWING.isdisjoint(Path(name).with_suffix("").parts):
            content = names[name].read_bytes()
            digest.update(f"\0{name}\0{len(content)}\0".encode() + content)
    return digest.hexdigest()


def require_software(sha256: str) -> None:
    """`ValueError` unless this process runs the very software that has asked."""
    if software_sha256() != sha256:
        raise ValueError(
            f"the worker {worker_name()} has another version of retarder-synth or of its libraries, or another "
            "processor, than the run that asked; its results might differ"
        )


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
