"""Simulated passes of a position in order and of a changed one, and what they say for each drift."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from plant_models import Plant
from plant_models.pressure_gauge import PressureGauge
from synth.logs.drift.causes import Cause
from synth.logs.drift.evidence import Evidence, evidence_of
from synth.logs.fitting_passes import fitting_passes
from synth.simulation.controllers import TableController
from synth.simulation.logged_passes import LoggedClass, mixed_log
from tuning_tables import ControllerTable
from tuning_tables.active_table import active
from tuning_tables.pass_log.pass_log import PassLog

GAUGE = PressureGauge(2.0, 1.0)


@dataclass(frozen=True)
class Change:
    """What happens to the position: `cause` is what the watch is to name; `changed` plant; bias of the sensor, m/s."""

    title: str
    cause: str
    changed: Callable[[Plant], Plant]
    bias_m_s: float = 0.0


def with_friction(factor: float) -> Callable[[Plant], Plant]:
    """The plant with so many times the force of its brake."""

    def changed(plant: Plant) -> Plant:
        force = plant.position.force
        (name,) = (each for each in vars(force) if each.startswith("slope_kn_per_kpa"))
        weaker = replace(force, **{name: factor * getattr(force, name)})  # type: ignore[type-var]
        return replace(plant, position=replace(plant.position, force=weaker))

    return changed


def with_exhaust(factor: float) -> Callable[[Plant], Plant]:
    """The plant that exhausts so many times as slowly."""

    def changed(plant: Plant) -> Plant:
        drive = plant.position.pneumatics
        slower = replace(drive, exhaust_time_constant_s=factor * drive.exhaust_time_constant_s)
        return replace(plant, position=replace(plant.position, pneumatics=slower))

    return changed


IN_ORDER = Change("none", "", lambda plant: plant)

CHANGES = (
    Change("friction −30 %", "friction", with_friction(0.7)),
    Change("friction −10 %", "friction", with_friction(0.9)),
    Change("exhaust constant +50 %", "exhaust constant", with_exhaust(1.5)),
    Change("sensor bias +0.1 m/s", "sensor bias", lambda plant: plant, 0.1),
)


def simulated(
    tables: Sequence[tuple[Plant, ControllerTable]], change: Change, passes: int, seed: int, gauge: PressureGauge | None
) -> PassLog:
    """`passes` of the tables' classes in equal parts, in random order.

    A sensor that shows b too much compares v + b with the lines: the same as v with lines that lie lower by b, and b
    added to what is logged.
    """
    classes = []
    for plant, table in tables:
        coefficients = table.coefficients.copy()
        coefficients[:, :, 0] -= np.float32(change.bias_m_s)
        shifted = replace(active(table), coefficients=coefficients)
        classes.append(LoggedClass(change.changed(plant), TableController(shifted), table.target_speed_m_s))
    log = mixed_log(classes, [max(1, passes // len(classes))] * len(classes), seed, gauge)
    return replace(log, speed_m_s=log.speed_m_s + change.bias_m_s)


@dataclass(frozen=True, eq=False)
class Judge:
    """What logs are held against."""

    plants: tuple[tuple[str, Plant], ...]
    values: dict[str, float]
    causes: tuple[Cause, ...]
    slope_key: str

    def evidence(self, log: PassLog) -> Evidence:
        """What `log` says for each cause."""
        passes = fitting_passes(log, self.plants, "the study")
        return evidence_of(passes, self.values, self.causes, self.slope_key, 2)


def joined(before: Evidence, after: Evidence) -> Evidence:
    """One after the other."""
    ratios = tuple(np.concatenate(pair) for pair in zip(before.ratios, after.ratios, strict=True))
    return Evidence(before.causes, ratios, np.concatenate((before.exit_m_s, after.exit_m_s)))
