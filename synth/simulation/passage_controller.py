"""A regulator that decides at passages over point sensors, as the closed loop runs it."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from plant_models import Plant, PointSensors, every_axle
from plant_models.point_sensors import deciding_passages, passages
from tuning_tables.passages.held_passages import LIMITS, held_by, held_passages
from tuning_tables.passages.passage_table import PassageTable
from tuning_tables.programs.passage_table import HeldPassages


@dataclass(frozen=True, eq=False)
class PassageController:
    """The rule that a controller holds, and whether it `tracks`.

    With the tracker the regulator hears every axle and finds out itself which passage a pulse pair is; each pair goes
    through `tuning_tables.programs.at_pulse`. Without it hears only the passages at which is decided, and is
    told which each pair is, as if no sensor ever failed. `ValueError` for arrays that do not fit.
    """

    rule: HeldPassages
    tracks: bool

    def __post_init__(self) -> None:
        rule = self.rule
        shape = rule.switching_m_s.shape
        if len(shape) != 3 or shape[1] != shape[2] + 1 or shape[2] < 1:
            raise ValueError(f"passage controller: switching_m_s has shape {shape}; it must be (M, K + 1, K), K >= 1")
        if np.isnan(rule.switching_m_s).any() or (rule.switching_m_s[..., 1:] < rule.switching_m_s[..., :-1]).any():
            raise ValueError("passage controller: switching_m_s must not fall along a row and have no NaN")
        heard = rule.deciding.shape
        if rule.path_m.shape != heard or rule.sensor.shape != heard or (np.diff(rule.path_m) < 0.0).any():
            raise ValueError("passage controller: path_m (rising), sensor and deciding must be of one length")
        if not np.array_equal(rule.deciding[rule.deciding != -1], np.arange(shape[0])):
            raise ValueError(f"passage controller: deciding must name each of {shape[0]} passages once, in order")
        limits = np.array([getattr(rule, name) for name in LIMITS])
        if not np.all(np.isfinite(limits) & (limits >= 0.0)):
            raise ValueError("passage controller: limits must be six numbers that are not negative")

    @property
    def stages(self) -> int:
        """Number of stages K + 1."""
        return int(self.rule.switching_m_s.shape[1])


def of_speeds(
    plant: Plant, sensors: PointSensors, switching_m_s: NDArray[np.floating], limits: tuple[float, ...] = ()
) -> PassageController:
    """The regulator with `switching_m_s` (M, K + 1, K) at the passages at which the cut of `plant` decides.

    With the six `limits` of a tracker (`PlausibleMotion.numbers`) it tracks, else it is told each passage.
    """
    if len(limits) not in (0, len(LIMITS)):
        raise ValueError(f"passage controller: there are {len(limits)} limits, but a tracker has six numbers")
    met = deciding_passages(sensors, plant.cut, plant.exit_m)
    heard = passages(replace(sensors, axles=every_axle), plant.cut)
    rule = held_passages(
        switching_m_s,
        np.array([each.path_m for each in heard]),
        np.array([each.sensor for each in heard]),
        np.array([met.index(each) if each in met else -1 for each in heard]),
        limits or [0.0] * len(LIMITS),
        base_m=sensors.base_m,
        entrance_stage=plant.entrance_stage,
        before_entrance=sum(each.path_m < 0.0 for each in met),
    )
    return PassageController(rule, tracks=bool(limits))


def of_table(table: PassageTable, tracking: bool) -> PassageController:
    """The regulator that runs `table`; `tracking`: with the tracker, as in a controller, else told each passage."""
    return PassageController(held_by(table), tracking)
