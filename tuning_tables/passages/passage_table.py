"""The table for point sensors: everything a controller needs to regulate one class of cuts to one exit speed."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import Final

import numpy as np
import numpy.typing as npt

from tuning_tables.approach import Approach
from tuning_tables.errors import InvalidTable
from tuning_tables.figures import Predicted, Validated
from tuning_tables.passages.passage_row import PassageRow
from tuning_tables.passages.plausible_motion import PlausibleMotion
from tuning_tables.passages.sensor_layout import SensorLayout
from tuning_tables.provenance import CutId, Generator, RetarderId
from tuning_tables.requirement import (
    UTC_INSTANT,
    require_between,
    require_count,
    require_kind,
    require_match,
    require_positive,
    require_rising,
    require_text,
    require_tuple,
)
from tuning_tables.table import MOST_STAGES

LONGEST_CUT_M: Final = 1e4
PATH_ERROR_M: Final = 1e-6
MOST_PASSAGES: Final = 1024
MOST_HEARD: Final = 4096
MOST_SPEEDS: Final = 2**17
"""Switching speeds of a whole table: so its JSON text stays below the 4 MiB that readers take."""


@dataclass(frozen=True)
class PassageTable:
    """A complete, checked table; it cannot be built otherwise, and nothing in it can be changed.

    id, created       name of the table; UTC instant "2026-11-20T22:46:00Z", given by the caller
    generator, retarder, cut   what made it and what it is for
    target_speed_m_s  exit speed the table aims at, > 0
    pressure_kpa      gauge pressure of stage k = 0 … K, >= 0, rising, 1 <= K <= 31
    sensors           where speed is measured and how, and at whose passages is decided
    approach          the regulator acts from the first sensor on: length_m is −sensors.path_m[0]
    initial_stage     at rest when the regulator takes over a cut, 0 … approach.entrance_stage
    passages          all those before retarder.exit_m, in the order of the path, then of the sensors; at most 1024,
                      each with K + 1 rows, at most 131 072 switching speeds in all; path within 1e-6 m of the sensor's
                      plus the axle's offset
    plausible         limits of the tracker
    valid_v_m_s       (least, greatest) speed that the switching speeds were made for, >= 0; the rule does not use it
    predicted         figures of the solver, computed without passes; `validated` those of a closed loop, None before

    Derived from these (arrays are read-only). For `rule.wanted_stage`, M passages:

    switching_m_s     float32 (M, K + 1, K), −∞ and +∞ as in `PassageRow`
    path_m            float32 (M,), not falling
    sensor_of         int64 (M,)
    before_entrance   number of passages whose path is below 0: the first ones

    For `tracker.believed_passage`, which must know every axle that gives pulses, all T passages heard:

    heard_path_m      float32 (T,), not falling: every axle over every sensor, also behind the exit; T <= 4096
    heard_sensor      int64 (T,)
    heard_passage     int64 (T,): the passage at which is decided, 0 … M − 1, or −1: nothing is decided there
    limits            float32 (6,)

    Raises `InvalidTable`.
    """

    id: str
    created: str
    generator: Generator
    retarder: RetarderId
    cut: CutId
    target_speed_m_s: float
    pressure_kpa: tuple[float, ...]
    sensors: SensorLayout
    approach: Approach
    initial_stage: int
    passages: tuple[PassageRow, ...]
    plausible: PlausibleMotion
    valid_v_m_s: tuple[float, float]
    predicted: Predicted
    validated: Validated | None = None
    switching_m_s: npt.NDArray[np.float32] = field(init=False, repr=False, compare=False)
    path_m: npt.NDArray[np.float32] = field(init=False, repr=False, compare=False)
    sensor_of: npt.NDArray[np.int64] = field(init=False, repr=False, compare=False)
    heard_path_m: npt.NDArray[np.float32] = field(init=False, repr=False, compare=False)
    heard_sensor: npt.NDArray[np.int64] = field(init=False, repr=False, compare=False)
    heard_passage: npt.NDArray[np.int64] = field(init=False, repr=False, compare=False)
    limits: npt.NDArray[np.float32] = field(init=False, repr=False, compare=False)
    before_entrance: int = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        self._require_fields()
        self._require_stages()
        self._require_approach()
        self._require_passages()
        heard = self.sensors.heard(self.cut.axle_offsets_m)
        number = {(row.sensor, row.axle): index for index, row in enumerate(self.passages)}
        arrays: dict[str, npt.NDArray[np.generic]] = {
            "switching_m_s": np.array([row.switching_m_s for row in self.passages], dtype=np.float32),
            "path_m": np.array([row.path_m for row in self.passages], dtype=np.float32),
            "sensor_of": np.array([row.sensor for row in self.passages], dtype=np.int64),
            "heard_path_m": np.array([path_m for _, _, path_m in heard], dtype=np.float32),
            "heard_sensor": np.array([sensor for sensor, _, _ in heard], dtype=np.int64),
            "heard_passage": np.array([number.get(met[:2], -1) for met in heard], dtype=np.int64),
            "limits": np.array(self.plausible.numbers, dtype=np.float32),
        }
        for name, array in arrays.items():
            array.setflags(write=False)
            object.__setattr__(self, name, array)
        object.__setattr__(self, "before_entrance", sum(row.path_m < 0.0 for row in self.passages))

    @property
    def entrance_stage(self) -> int:
        """The highest stage that may be commanded before the entrance, for `rule.wanted_stage`."""
        return self.approach.entrance_stage

    def with_validated(self, validated: Validated) -> PassageTable:
        """The same table with the figures of a closed-loop run filled in."""
        return replace(self, validated=validated)

    def _require_fields(self) -> None:
        require_text(self.id, "id")
        require_match(self.created, "created", UTC_INSTANT, "2026-11-20T22:46:00Z")
        require_kind(self.generator, "generator", Generator)
        require_kind(self.retarder, "retarder", RetarderId)
        require_kind(self.cut, "cut", CutId)
        require_positive(self.target_speed_m_s, "target_speed_m_s")
        require_kind(self.sensors, "sensors", SensorLayout)
        require_kind(self.approach, "approach", Approach)
        require_kind(self.plausible, "plausible", PlausibleMotion)
        require_tuple(self.valid_v_m_s, "valid.v_m_s", 2)
        require_rising(self.valid_v_m_s, "valid.v_m_s")
        require_between(self.valid_v_m_s[0], "valid.v_m_s[0]", 0.0)
        require_kind(self.predicted, "predicted", Predicted)
        if self.predicted.passes is not None:
            raise InvalidTable("predicted.passes is given, but the prediction of a table for sensors is exact.")
        if self.validated is not None:
            require_kind(self.validated, "validated", Validated)

    def _require_stages(self) -> None:
        require_tuple(self.pressure_kpa, "stages")
        if not 2 <= len(self.pressure_kpa) <= MOST_STAGES:
            raise InvalidTable(f"stages has {len(self.pressure_kpa)} entries, but 2 to {MOST_STAGES} are allowed.")
        for stage, pressure in enumerate(self.pressure_kpa):
            require_between(pressure, f"stages[{stage}].pressure_kpa", 0.0)
        for stage, (below, above) in enumerate(pairwise(self.pressure_kpa), start=1):
            if not below < above:
                raise InvalidTable(
                    f"stages[{stage}].pressure_kpa is {above!r}, but it must exceed that of the stage below, {below!r}."
                )

    def _require_approach(self) -> None:
        require_count(self.approach.entrance_stage, "approach.entrance_stage", 0, len(self.pressure_kpa) - 1)
        require_count(self.initial_stage, "approach.initial_stage", 0, self.approach.entrance_stage)
        if self.approach.length_m != -self.sensors.path_m[0]:
            raise InvalidTable(
                f"approach.length_m is {self.approach.length_m!r}, but the regulator acts from the first sensor on: it "
                f"must be the opposite of sensors.path_m[0], {self.sensors.path_m[0]!r}."
            )

    def _require_passages(self) -> None:
        require_tuple(self.passages, "passages")
        stages = len(self.pressure_kpa)
        axles = len(self.cut.axle_offsets_m)
        require_between(self.cut.axle_offsets_m[-1], f"cut.axle_offsets_m[{axles - 1}]", 0.0, LONGEST_CUT_M)
        if len(self.sensors.path_m) * axles > MOST_HEARD:
            raise InvalidTable(
                f"cut.axle_offsets_m has {axles} entries over {len(self.sensors.path_m)} sensors, but at most "
                f"{MOST_HEARD} passages of axles over sensors are allowed."
            )
        wanted = self.sensors.passages(self.cut.axle_offsets_m, self.retarder.exit_m)
        if not 1 <= len(wanted) <= MOST_PASSAGES or len(wanted) * stages * (stages - 1) > MOST_SPEEDS:
            raise InvalidTable(
                f"sensors and cut give {len(wanted)} passages before the exit for {stages} stages, but a table holds 1 "
                f"to {MOST_PASSAGES} of them with {MOST_SPEEDS} switching speeds in all."
            )
        if len(self.passages) != len(wanted):
            raise InvalidTable(
                f"passages has {len(self.passages)} entries, but {len(wanted)} passages before the exit follow from "
                "sensors and cut.axle_offsets_m."
            )
        for index, (row, (sensor, axle, path_m)) in enumerate(zip(self.passages, wanted, strict=True)):
            require_kind(row, f"passages[{index}]", PassageRow)
            if (row.sensor, row.axle) != (sensor, axle) or not abs(row.path_m - path_m) <= PATH_ERROR_M:
                raise InvalidTable(
                    f"passages[{index}] is axle {row.axle} over sensor {row.sensor} at {row.path_m!r} m, but from "
                    f"sensors and cut.axle_offsets_m it must be axle {axle} over sensor {sensor} at {path_m!r} m."
                )
            if len(row.switching_m_s) != stages:
                raise InvalidTable(
                    f"passages[{index}].switching_m_s has {len(row.switching_m_s)} rows, but there are {stages} stages."
                )
        for index, (before, after) in enumerate(pairwise(self.passages), start=1):
            if not before.path_m <= after.path_m:
                raise InvalidTable(
                    f"passages[{index}].path_m is {after.path_m!r}, but it must not be less than that of the passage "
                    f"before, {before.path_m!r}."
                )
