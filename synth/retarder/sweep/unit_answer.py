"""What a worker does with a unit of a sweep; the solver is imported when it is needed."""

from __future__ import annotations

from synth.frame.workers.engine import Answer, answered
from synth.frame.workers.software import require_software
from synth.retarder.sweep.plan import UnitOrder
from synth.retarder.sweep.unit_result import UnitResult


def answer(order: UnitOrder) -> Answer:
    """Compute a unit."""
    return answered(order, computed)


def computed(order: UnitOrder) -> UnitResult:
    """The result of `order`, computed in this process by this very software; raises what its steps raise."""
    require_software(order.software)
    from synth.kernels.cache import guarded
    from synth.retarder.sweep.tune_unit import tune_unit

    return guarded(tune_unit, order)
