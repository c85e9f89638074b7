"""Workers that go wrong with one class, to be imported by processes that are started anew."""

from __future__ import annotations

import os
import signal
from dataclasses import replace
from pathlib import Path

from synth.frame.workers.engine import Answer
from synth.hump.trains.batch import BatchOrder, answer_batch
from synth.kernels.cache import cache_in_use
from synth.retarder.sweep.command import answer
from synth.retarder.sweep.plan import UnitOrder

POISONED = "gondola-4-26t"


def refusing(order: UnitOrder) -> Answer:
    """A class whose configuration cannot be resolved where it is computed, and two that can."""
    if order.label != POISONED:
        return answer(order)
    tree = {**order.tree, "friction": {"common_cv": -1.0}}
    return answer(replace(order, tree=tree))


def dying(order: UnitOrder) -> Answer:
    """A class that takes its process with it."""
    if order.label == POISONED:
        os.kill(os.getpid(), signal.SIGKILL)
    return answer(order)


def dying_once(order: UnitOrder) -> Answer:
    """The same, the first time only."""
    mark = Path(os.environ["DIED_ONCE"])
    if order.label == POISONED and not mark.exists():
        mark.touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return answer(order)


def strange(order: UnitOrder) -> Answer:
    """A worker whose program is another."""
    return answer(replace(order, software="0" * 64))


def caching(order: UnitOrder) -> Answer:
    """A worker that only tells where its kernels are kept, and leaves one there."""
    directory = cache_in_use()
    assert directory is not None
    (directory / f"{os.getpid()}.nbi").touch()
    return Answer(order.key, None, str(directory))


def batch_dying_once(order: BatchOrder) -> Answer:
    """The first batch that is asked for takes its process with it, the first time."""
    mark = Path(os.environ["DIED_ONCE"])
    if not mark.exists():
        mark.touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return answer_batch(order)
