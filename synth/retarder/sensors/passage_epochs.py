"""A regulator that decides where axles pass point sensors."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

from plant_models import Plant
from synth.problem.resolution import Resolution
from synth.retarder.configuration.point_sensors.resolved_sensors import ResolvedSensors
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.retarder.epochs import Ground

if TYPE_CHECKING:
    from synth.retarder.sensors.sensor_case import SensorCase
    from tuning_tables.passages.passage_table import PassageTable


@dataclass(frozen=True)
class PassageEpochs:
    """See `Epochs`; `sensors` tell the passages."""

    sensors: ResolvedSensors

    def grids(self, config: ResolvedConfig, plant: Plant) -> tuple[Plant, Sequence[Resolution]]:
        """See `Epochs`."""
        return self.sensors.serving(plant), (config.resolution,)

    def cases(self, ground: Ground[PassageTable], label: str, plant: Plant) -> list[Callable[[], SensorCase]]:
        """See `Epochs`."""
        from synth.retarder.sensors.sensor_case import sensor_case  # with the kernels
        from synth.retarder.sensors.sensor_class import sensor_class

        config = ground.config
        setup = sensor_class(label, plant, self.sensors, config.resolution, ground.passes, ground.origin)
        return [partial(sensor_case, setup, aim, ground.store) for aim in config.aims_of(label)]
