"""What a configuration asks of a layout of point sensors."""

from __future__ import annotations

from plant_models import PointSensors, first_axle
from plant_models.library import load_wheel_sensor
from synth.problem.aim import Aim
from synth.retarder.configuration.point_sensors.settings import DEFAULT_WHEEL_SENSOR
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.retarder.sensors.candidate_places import LayoutCase
from synth.retarder.sensors.layout_plan import LayoutProblem


def layout_problem(config: ResolvedConfig) -> tuple[LayoutProblem, tuple[str, ...]]:
    """The problem of all cut classes and targets, and the labels of the classes; [sensors] path_m is not read."""
    cases = tuple(
        LayoutCase(plant, tuple(Aim(target, config.criterion) for target in config.targets_of(label)))
        for label, plant in config.plants()
    )
    return LayoutProblem(cases, sensors_of(config), config.resolution), tuple(label for label, _ in config.plants())


def sensors_of(config: ResolvedConfig) -> PointSensors:
    """The sensors of [sensors], or the usual ones that decide on the first axle; their places mean nothing."""
    if config.sensors is not None:
        return config.sensors.sensors
    return load_wheel_sensor(DEFAULT_WHEEL_SENSOR).at((0.0,), first_axle)
