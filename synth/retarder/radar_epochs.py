"""A regulator that decides at the samples of a radar: at rest or at any time, on the measured or an estimated speed."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

from plant_models import Plant
from synth.problem.resolution import Resolution
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.retarder.epochs import Ground

if TYPE_CHECKING:
    from synth.retarder.case_result import CaseResult
    from tuning_tables import ControllerTable


@dataclass(frozen=True)
class RadarEpochs:
    """See `Epochs`; the section [regulator] of a configuration tells which of them.

    With `pareto` each case also tells what less time in the position costs.
    """

    pareto: bool = False

    def grids(self, config: ResolvedConfig, plant: Plant) -> tuple[Plant, Sequence[Resolution]]:
        """See `Epochs`."""
        return plant, config.grids(plant)

    def cases(self, ground: Ground[ControllerTable], label: str, plant: Plant) -> list[Callable[[], CaseResult]]:
        """See `Epochs`; all targets of a class are solved together."""
        from synth.retarder.tune_case import case_orders, tune_case  # with the kernels

        return [partial(tune_case, order) for order in case_orders(ground, label, plant, self.pareto)]
