"""What a worker is asked and what it answers, of any kind: units of a sweep, batches of trains."""

from __future__ import annotations

import os
import platform
import time
from collections.abc import Callable, Generator, Sequence
from dataclasses import dataclass
from typing import Any, Protocol, TypeVar

from synth.frame.unforeseen import unforeseen


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
