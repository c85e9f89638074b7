"""Simulated passes of a position in order and of a changed one, and what they say for each drift."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from plant_models import Plant
from plant_models.pressure_gauge import PressureGauge
from scripts.studies.plant_changes import friction, times
from synth.logs import unknowns as asked
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
    """What happens to the position: `cause` is what the watch is to name; `changed` plant; what sensor and gauge
    show too much; `is_of_drive`: it is sought only with a gauge on the drive."""

    title: str
    cause: str
    changed: Callable[[Plant], Plant]
    bias_m_s: float = 0.0
    gauge_off_kpa: float = 0.0
    is_of_drive: bool = False


LIGHT = "Л"
"""A weight category of the built-in configuration."""


def of_light(changed: Callable[[Plant], Plant]) -> Callable[[Plant], Plant]:
    """The change for cuts of one category alone."""
    return lambda plant: changed(plant) if plant.cut.category == LIGHT else plant


IN_ORDER = Change("none", "", lambda plant: plant)

CHANGES = (
    Change("friction −30 %", "friction", friction(0.7, 1.0)),
    Change("friction −10 %", "friction", friction(0.9, 1.0)),
    Change("exhaust constant +50 %", "exhaust constant", times(asked.EXHAUST, 1.5)),
    Change("sensor bias +0.1 m/s", "sensor bias", lambda plant: plant, 0.1),
    Change("friction of category Л −30 %", f"friction of {LIGHT}", of_light(friction(0.7, 1.0))),
    Change("spread of friction ×2", "friction spread", friction(1.0, 2.0)),
    Change("rolling resistance +50 %", "rolling resistance", times("cut.rolling_resistance.mean_n_per_kn", 1.5)),
    Change("fill constant +50 %", "fill constant", times(asked.FILL, 1.5), is_of_drive=True),
    Change("brake delay ×2", "brake delay", times(asked.BRAKE_DELAY, 2.0), is_of_drive=True),
    Change("release delay ×2", "release delay", times(asked.RELEASE_DELAY, 2.0), is_of_drive=True),
    Change("dead band +50 %", "dead band", times(asked.DEAD_BAND, 1.5), is_of_drive=True),
    Change("touch pressure +30 %", "touch pressure", times(asked.TOUCH_PRESSURE, 1.3), is_of_drive=True),
    Change("sensor noise ×2", "sensor noise", times(asked.NOISE, 2.0)),
    Change("gauge offset +10 kPa", "gauge offset", lambda plant: plant, gauge_off_kpa=10.0, is_of_drive=True),
)
"""One at least of each cause that the watch knows; sizes are assumed."""


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
    return replace(log, speed_m_s=log.speed_m_s + change.bias_m_s, pressure_kpa=log.pressure_kpa + change.gauge_off_kpa)


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
