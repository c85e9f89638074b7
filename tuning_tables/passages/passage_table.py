"""The table for point sensors: everything a controller needs to regulate one class of cuts to one exit speed."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import Annotated, Final

import numpy as np
import numpy.typing as npt

from tuning_tables.decisions import Approach
from tuning_tables.declared.members import Several, require_declared
from tuning_tables.declared.numbers import Count, Number, Row
from tuning_tables.errors import InvalidTable, require_between, require_count, require_rising
from tuning_tables.passages.passage_row import PassageRow
from tuning_tables.passages.sensor_layout import PlausibleMotion, SensorLayout
from tuning_tables.provenance import (
    CREATED,
    TABLE_NAME,
    CutId,
    Generator,
    Predicted,
    RetarderId,
    Validated,
    rms_in_words,
)
from tuning_tables.stage import MOST_STAGES

LONGEST_CUT_M: Final = 1e4
PATH_ERROR_M: Final = 1e-6
MOST_PASSAGES: Final = 1024
MOST_HEARD: Final = 4096
MOST_SPEEDS: Final = 2**17
"""Switching speeds of a whole table: so its JSON text stays below the 4 MiB that readers take."""


@dataclass(frozen=True)
class PassageTable:
    """A complete, checked table; it cannot be built otherwise, and nothing in it can be changed.

    Pressures rise. The regulator acts from the first sensor on: approach.length_m is −sensors.path_m[0]; the initial
    stage is at most the entrance stage. Passages are all those before retarder.exit_m, in the order of the path, then
    of the sensors, each with K + 1 rows, at most 131 072 switching speeds in all; the path is within 1e-6 m of the
    sensor's plus the axle's offset. The prediction is exact, without passes.

    Raises `InvalidTable`. What a member means and may be stands on the page "Table formats". The others follow from
    them, as read-only arrays, for M passages at which is decided, and all T passages that are heard:

    Attributes
    ----------
    switching_m_s
        float32 (M, K + 1, K), −∞ and +∞ as in `PassageRow`.
    path_m
        float32 (M,), not falling.
    sensor_of
        int64 (M,).
    before_entrance
        Number of passages whose path is below 0, the first ones.
    heard_path_m
        float32 (T,), not falling; every axle over every sensor, also behind the exit; T <= 4096.
    heard_sensor
        int64 (T,).
    heard_passage
        int64 (T,), the passage at which is decided, 0 … M − 1, or −1 where nothing is decided.
    limits
        float32 (6,).

    Examples
    --------
    >>> from tuning_tables import (
    ...     Approach,
    ...     CutId,
    ...     DecidesOn,
    ...     Generator,
    ...     PassageRow,
    ...     PassageTable,
    ...     PlausibleMotion,
    ...     Predicted,
    ...     RetarderId,
    ...     SensorLayout,
    ... )
    >>> table = PassageTable(
    ...     id="by-hand",
    ...     created="2026-11-27T12:00:00Z",
    ...     generator=Generator("by hand", "1", "0" * 64),
    ...     retarder=RetarderId(
    ...         "my-retarder", zones_m=((0.0, 12.0),), exit_m=22.5, dead_band_kpa=15.0
    ...     ),
    ...     cut=CutId("С", mass_t=52.0, axle_offsets_m=(0.0, 10.5)),
    ...     target_speed_m_s=3.0,
    ...     pressure_kpa=(0.0, 300.0),
    ...     sensors=SensorLayout(
    ...         (-1.0, 6.0), 0.25, 0.002, 1e-4, 1e-4, 0.02, 0.02, DecidesOn.FIRST_AXLE
    ...     ),
    ...     approach=Approach(1.0, entrance_stage=1),
    ...     initial_stage=0,
    ...     passages=(
    ...         PassageRow(0, 0, -1.0, switching_m_s=((4.5,), (4.0,))),
    ...         PassageRow(1, 0, 6.0, switching_m_s=((4.0,), (3.5,))),
    ...     ),
    ...     plausible=PlausibleMotion((0.5, 10.0), 0.5, 4.0, 0.05, 0.5),
    ...     valid_v_m_s=(0.5, 8.0),
    ...     predicted=Predicted(rms_m_s=0.2, bias_m_s=0.0, p_overspeed=0.1, switchings=2.0),
    ... )
    >>> table
    PassageTable(by-hand: 2 passages, 2 stages, predicted rms 0.2000 m/s)
    """

    id: Annotated[str, TABLE_NAME]
    created: Annotated[str, CREATED]
    generator: Generator
    retarder: RetarderId
    cut: CutId
    target_speed_m_s: Annotated[float, Number("exit speed that the table aims at", is_positive=True)]
    pressure_kpa: Annotated[
        tuple[float, ...], Row(Number("gauge pressure of each stage", 0.0), "stage", 2, MOST_STAGES)
    ]
    sensors: SensorLayout
    approach: Approach
    initial_stage: Annotated[int, Count("at rest when the regulator takes over a cut", 0, MOST_STAGES - 1)]
    passages: Annotated[tuple[PassageRow, ...], Several("passages", "passage", 1, MOST_PASSAGES)]
    plausible: PlausibleMotion
    valid_v_m_s: Annotated[
        tuple[float, float],
        Row(Number("least and greatest speed that the switching speeds were made for", 0.0), "end", 2, 2),
    ]
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

    def __repr__(self) -> str:
        return (
            f"PassageTable({self.id}: {len(self.passages)} passages, {len(self.pressure_kpa)} stages, "
            f"{rms_in_words(self.predicted, self.validated)})"
        )

    @property
    def entrance_stage(self) -> int:
        """The highest stage that may be commanded before the entrance."""
        return self.approach.entrance_stage

    def with_validated(self, validated: Validated) -> PassageTable:
        """The same table with the figures of a closed-loop run filled in."""
        return replace(self, validated=validated)

    def _require_fields(self) -> None:
        require_declared(self)
        require_rising(self.valid_v_m_s, "valid_v_m_s")
        if self.predicted.passes is not None:
            raise InvalidTable("predicted.passes is given, but the prediction of a table for sensors is exact.")

    def _require_stages(self) -> None:
        for stage, (below, above) in enumerate(pairwise(self.pressure_kpa), start=1):
            if not below < above:
                raise InvalidTable(
                    f"pressure_kpa[{stage}] is {above!r}, but it must exceed that of the stage below, {below!r}."
                )

    def _require_approach(self) -> None:
        require_count(self.approach.entrance_stage, "approach.entrance_stage", 0, len(self.pressure_kpa) - 1)
        require_count(self.initial_stage, "initial_stage", 0, self.approach.entrance_stage)
        if self.approach.length_m != -self.sensors.path_m[0]:
            raise InvalidTable(
                f"approach.length_m is {self.approach.length_m!r}, but the regulator acts from the first sensor on: it "
                f"must be the opposite of sensors.path_m[0], {self.sensors.path_m[0]!r}."
            )

    def _require_passages(self) -> None:
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
