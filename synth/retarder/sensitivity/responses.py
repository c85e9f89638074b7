"""What fixed tables do, an output each, at the points of a hypercube: every point another plant, the same passes."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Final

import numpy as np

from plant_models import Plant, PlantError
from plant_models.frozen_arrays import Floats
from synth.problem.aim import OVERSPEED_M_S
from synth.retarder.configuration.plant_parameter import Parameter
from synth.retarder.configuration.plant_values import with_values
from synth.retarder.sensitivity.varied import values_at
from synth.simulation.closed_loop import TableController
from synth.simulation.common_passes import common_passes
from synth.simulation.passes import ExitSample
from synth.simulation.random_passes import RandomPasses
from tuning_tables import ControllerTable


@dataclass(frozen=True)
class Output:
    """`figure` makes the number from the exit errors (n,) and weights (n,) of the passes."""

    name: str
    title: str
    unit: str
    figure: Callable[[Floats, Floats], float]

    def of(self, sample: ExitSample, target_m_s: float) -> float:
        """The number of a sample; a stalled pass counts with exit speed 0, as in `exit_statistics`."""
        return self.figure(sample.exit_speed_m_s - target_m_s, sample.weight)


OUTPUTS: Final = (
    Output("rms_m_s", "rms exit error", "m/s", lambda e, w: math.sqrt(float(w @ e**2 / w.sum()))),
    Output("bias_m_s", "mean exit error", "m/s", lambda e, w: float(w @ e / w.sum())),
    Output(
        "overspeed", f"share over +{OVERSPEED_M_S:g} m/s", "1", lambda e, w: float(w @ (e > OVERSPEED_M_S) / w.sum())
    ),
)
"""The first is what the ranking is told by."""

AT_ONCE = 25
"""Points of one task of a thread."""


def responses(
    plant: Plant,
    tables: Sequence[ControllerTable],
    varied: Mapping[str, Parameter],
    keys: Sequence[str],
    unit: Floats,
    passes: RandomPasses,
    threads: int,
) -> Floats:
    """The outputs, (tables, outputs, points), at the points `unit` (points, keys); `threads` change no bit of them.

    Raises `PlantError` that names the values of a point which the plant refuses.
    """
    controllers = [TableController(table) for table in tables]

    def at(row: list[float]) -> list[list[float]]:
        values = dict(values_at(varied, keys, row))
        try:
            run = common_passes(with_values(plant, values), passes).run
        except PlantError as fault:
            told = ", ".join(f"{key} {value:.6g}" for key, value in values.items())
            raise PlantError(f"{fault} (at the values {told})") from fault
        samples = [run(controller) for controller in controllers]
        return [
            [output.of(sample, table.target_speed_m_s) for output in OUTPUTS]
            for sample, table in zip(samples, tables, strict=True)
        ]

    def part(first: int) -> list[list[list[float]]]:
        return [at(row) for row in unit[first : first + AT_ONCE].tolist()]

    with ThreadPoolExecutor(max_workers=threads) as pool:
        found = [point for points in pool.map(part, range(0, len(unit), AT_ONCE)) for point in points]
    return np.moveaxis(np.array(found), 0, -1)
