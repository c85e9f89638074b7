"""What a worker is asked and what it answers; nothing here imports the solver before it is needed.

Engines take any orders: units of a sweep, batches of trains.
"""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Generator, Sequence
from dataclasses import dataclass
from typing import Any, Protocol, TypeVar

from synth.frame.unforeseen import unforeseen
from synth.sweep.plan import UnitOrder
from synth.sweep.software import software_sha256
from synth.sweep.unit_result import UnitResult


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


class Engine(Protocol):
    """Computes orders somewhere; answers come as they are ready, one for every order, whatever happens to workers."""

    def answers(self, orders: Sequence[Order], begun: Begun) -> Generator[Answer]:
        """`begun` is told of an order when it is given to a worker."""
        ...


def answer(order: UnitOrder) -> Answer:
    """Compute a unit of a sweep."""
    return answered(order, computed)


def answered(order: OrderOfKind, compute: Callable[[OrderOfKind], object]) -> Answer:
    """Compute an order; whatever is raised becomes the reason of a failure."""
    started = time.monotonic()
    try:
        result, reason = compute(order), ""
    except Exception as fault:
        result, reason = None, sentence_of(fault)
    return Answer(order.key, result, reason, time.monotonic() - started, worker_name())


def require_software(sha256: str) -> None:
    """`ValueError` unless this process runs the very software that has asked."""
    if software_sha256() != sha256:
        raise ValueError(
            f"the worker {worker_name()} has another version of retarder-synth or of its libraries, or another "
            "processor, than the run that asked; its results might differ"
        )


def computed(order: UnitOrder) -> UnitResult:
    """The result of `order`, computed in this process by this very software; raises what its steps raise."""
    require_software(order.software)
    from synth.kernels.cache import guarded
    from synth.sweep.tune_unit import tune_unit

    return guarded(tune_unit, order)


def sentence_of(fault: Exception) -> str:
    """What was raised, in one line, with the place where it is none of our own words."""
    from plant_models import PlantError
    from tuning_tables import TableError

    if isinstance(fault, PlantError | TableError) or type(fault) is ValueError:
        return " ".join(str(fault).split()) or "no words"
    return unforeseen(fault)


def worker_name() -> str:
    """This process on this machine."""
    return f"{os.uname().nodename}:{os.getpid()}"


@dataclass(frozen=True)
class InThisProcess:
    """One order after the other, here: what the other engines are checked against."""

    work: Work = answer

    def answers(self, orders: Sequence[Order], begun: Begun) -> Generator[Answer]:
        """In the order given."""
        for order in orders:
            begun(order)
            yield self.work(order)
