"""A regulator that decides at passages over point sensors, as the closed loop runs it."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from plant_models import Plant, PointSensors, deciding_passages, every_axle, passages
from synth.simulation.controllers import fixed
from tuning_tables.passages.passage_table import PassageTable
from tuning_tables.passages.regulator import PassageRule, rule_of

LIMITS = 6
"""Numbers that the tracker's `limits` has."""


@dataclass(frozen=True, eq=False)
class PassageController:
    """The rule that a controller holds, and whether it `tracks`.

    With the tracker the regulator hears every axle and finds out itself which passage a pulse pair is; each pair goes
    through `tuning_tables.passages.regulator.at_pulse`. Without it hears only the passages at which is decided, and is
    told which each pair is, as if no sensor ever failed. The arrays of `rule` become read-only. `ValueError` for arrays
    that do not fit.
    """

    rule: PassageRule
    tracks: bool

    def __post_init__(self) -> None:
        rule = self.rule
        shape = rule.switching_m_s.shape
        if len(shape) != 3 or shape[1] != shape[2] + 1 or shape[2] < 1:
            raise ValueError(f"passage controller: switching_m_s has shape {shape}; it must be (M, K + 1, K), K >= 1")
        if np.isnan(rule.switching_m_s).any() or (rule.switching_m_s[..., 1:] < rule.switching_m_s[..., :-1]).any():
            raise ValueError("passage controller: switching_m_s must not fall along a row and have no NaN")
        heard = rule.passage_of.shape
        if rule.path_m.shape != heard or rule.sensor_of.shape != heard or (np.diff(rule.path_m) < 0.0).any():
            raise ValueError("passage controller: path_m (rising), sensor_of and passage_of must be of one length")
        if not np.array_equal(rule.passage_of[rule.passage_of != -1], np.arange(shape[0])):
            raise ValueError(f"passage controller: passage_of must name each of {shape[0]} passages once, in order")
        if rule.limits.shape != (LIMITS,) or not np.all(np.isfinite(rule.limits) & (rule.limits >= 0.0)):
            raise ValueError("passage controller: limits must be six numbers that are not negative")
        object.__setattr__(self, "rule", for_kernel(rule))

    @property
    def stages(self) -> int:
        """Number of stages K + 1."""
        return int(self.rule.switching_m_s.shape[1])


def for_kernel(rule: PassageRule) -> PassageRule:
    """`rule` as the kernel takes it."""
    return PassageRule(
        fixed(rule.switching_m_s, np.float32),
        int(rule.entrance_stage),
        int(rule.before_entrance),
        fixed(rule.path_m, np.float32),
        fixed(rule.sensor_of, np.int64),
        fixed(rule.passage_of, np.int64),
        fixed(rule.limits, np.float32),
        np.float32(rule.base_m),
    )


def of_speeds(
    plant: Plant, sensors: PointSensors, switching_m_s: NDArray[np.floating], limits: tuple[float, ...] = ()
) -> PassageController:
    """The regulator with `switching_m_s` (M, K + 1, K) at the passages at which the cut of `plant` decides.

    With the six `limits` of a tracker (`tuning_tables.passages.tracker`) it tracks, else it is told each passage.
    """
    met = deciding_passages(sensors, plant.cut, plant.exit_m)
    heard = passages(replace(sensors, axles=every_axle), plant.cut)
    rule = PassageRule(
        switching_m_s.astype(np.float32),
        plant.entrance_stage,
        sum(each.path_m < 0.0 for each in met),
        np.array([each.path_m for each in heard], dtype=np.float32),
        np.array([each.sensor for each in heard], dtype=np.int64),
        np.array([met.index(each) if each in met else -1 for each in heard], dtype=np.int64),
        np.array(limits or [0.0] * LIMITS, dtype=np.float32),
        np.float32(sensors.base_m),
    )
    return PassageController(rule, tracks=bool(limits))


def of_table(table: PassageTable, tracking: bool) -> PassageController:
    """The regulator that runs `table`; `tracking`: with the tracker, as in a controller, else told each passage."""
    return PassageController(rule_of(table), tracking)
