"""The controller table: everything a trackside controller needs to regulate one class of cuts to one exit speed."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import Annotated

import numpy as np
import numpy.typing as npt

from tuning_tables.decisions import Approach, Decisions, RegulatorClock, entrance_stage, farthest
from tuning_tables.declared.members import Several, require_declared
from tuning_tables.declared.numbers import Count, Number
from tuning_tables.declared.texts import Word
from tuning_tables.errors import InvalidTable, require_count
from tuning_tables.estimator import Estimator
from tuning_tables.held_table import held_table
from tuning_tables.programs.held import LineTable
from tuning_tables.provenance import (
    CREATED,
    TABLE_NAME,
    CutId,
    Generator,
    Predicted,
    RetarderId,
    Validated,
    ValidRange,
    rms_in_words,
)
from tuning_tables.stage import (
    HIGHEST_DEGREE,
    LARGEST_FLOAT32,
    MOST_STAGES,
    NO_PRESSURE,
    SIDES,
    Stage,
    range_above,
    require_stage,
)


@dataclass(frozen=True)
class ControllerTable:
    """A complete, checked table; it cannot be built otherwise, and nothing in it can be changed.

    Stages are numbered in order, pressures rise, and every line has degree + 1 coefficients; there is no `lower` at
    stage 0 and no `upper` at stage K. With an approach the path range begins at s = -approach.length_m and ends behind
    the entrance, and the breaks of an estimator begin no later. At any time all lines have a slope, or none has.

    On the valid path range lower(s) < upper(s) holds at every stage that has both, also as evaluated in float32, and
    with slopes at every pressure from that of stage 0 to that of the highest stage that the table raises to, and at the
    stage's own.

    Raises `InvalidTable`. What a member means and may be stands on the page "Table formats". The others follow from
    them, as read-only arrays; line 0 is `lower`, line 1 is `upper`:

    Attributes
    ----------
    coefficients
        float32 (K+1, 2, degree+1), ascending powers of s in m; NaN where there is no line.
    has_line
        bool (K+1, 2).
    valid_range
        float32 (4,), s_min, s_max in m, v_min, v_max in m/s.
    slopes
        float32 (K+1, 2), m/s per kPa; 0 where a line has none.
    pressures
        float32 (K+1,), kPa; the largest float32 number where one exceeds it.
    held
        What the programs take, `programs.line_table`.

    Examples
    --------
    >>> from tuning_tables import (
    ...     ControllerTable,
    ...     CutId,
    ...     Generator,
    ...     Predicted,
    ...     RegulatorClock,
    ...     RetarderId,
    ...     Stage,
    ...     ValidRange,
    ... )
    >>> table = ControllerTable(
    ...     id="by-hand",
    ...     created="2026-11-27T12:00:00Z",
    ...     generator=Generator("by hand", "1", "0" * 64),
    ...     retarder=RetarderId(
    ...         "my-retarder", zones_m=((0.0, 12.0),), exit_m=22.5, dead_band_kpa=15.0
    ...     ),
    ...     cut=CutId("С", mass_t=52.0, axle_offsets_m=(0.0, 1.85, 8.65, 10.5)),
    ...     target_speed_m_s=3.0,
    ...     clock=RegulatorClock(sample_period_s=0.1, computing_delay_s=0.02),
    ...     degree=1,
    ...     stages=(
    ...         Stage(0, 0.0, lower=None, upper=(4.5, -0.0625)),
    ...         Stage(1, 300.0, lower=(4.0, -0.0625), upper=None),
    ...     ),
    ...     valid=ValidRange(s_m=(0.0, 22.5), v_m_s=(0.5, 8.0)),
    ...     predicted=Predicted(rms_m_s=0.2, bias_m_s=0.0, p_overspeed=0.1, switchings=2.0),
    ... )
    >>> table
    ControllerTable(by-hand: degree 1, 2 stages, predicted rms 0.2000 m/s)
    >>> table.coefficients.shape
    (2, 2, 2)
    """

    id: Annotated[str, TABLE_NAME]
    created: Annotated[str, CREATED]
    generator: Generator
    retarder: RetarderId
    cut: CutId
    target_speed_m_s: Annotated[float, Number("exit speed that the table aims at", is_positive=True)]
    clock: RegulatorClock
    decisions: Annotated[
        Decisions, Word("at rest: only when no change of stage is under way; at any time: at every sample", Decisions)
    ] = field(default=Decisions.AT_REST, kw_only=True)
    approach: Approach | None = field(default=None, kw_only=True)
    estimator: Estimator | None = field(default=None, kw_only=True)
    degree: Annotated[int, Count("of all lines", 0, HIGHEST_DEGREE)]
    stages: Annotated[tuple[Stage, ...], Several("stages", "stage", 2, MOST_STAGES)]
    valid: ValidRange
    predicted: Predicted
    validated: Validated | None = None
    coefficients: npt.NDArray[np.float32] = field(init=False, repr=False, compare=False)
    has_line: npt.NDArray[np.bool_] = field(init=False, repr=False, compare=False)
    valid_range: npt.NDArray[np.float32] = field(init=False, repr=False, compare=False)
    slopes: npt.NDArray[np.float32] = field(init=False, repr=False, compare=False)
    pressures: npt.NDArray[np.float32] = field(init=False, repr=False, compare=False)
    held: LineTable = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        self._require_fields()
        self._require_stages()
        valid_range = np.array(self.valid.s_m + self.valid.v_m_s, dtype=np.float32)
        self._require_approach()
        self._require_slopes()
        # Who has no gauge may give any pressure; it must stay finite, or no slope times it would not be 0.
        exact = np.array([stage.pressure_kpa for stage in self.stages], dtype=np.float64)
        pressures = np.minimum(exact, LARGEST_FLOAT32).astype(np.float32)
        self._require_lines((float(valid_range[0]), float(valid_range[1])), pressures)
        coefficients, has_line = _line_arrays(self.stages, self.degree)
        slopes = np.array([[slope or 0.0 for slope in stage.slopes] for stage in self.stages], dtype=np.float32)
        arrays = (coefficients, has_line, valid_range, slopes, pressures)
        for name, array in zip(("coefficients", "has_line", "valid_range", "slopes", "pressures"), arrays, strict=True):
            array.setflags(write=False)
            object.__setattr__(self, name, array)
        object.__setattr__(self, "held", held_table(self))

    def __repr__(self) -> str:
        shape = f"degree {self.degree}, {len(self.stages)} stages"
        return f"ControllerTable({self.id}: {shape}, {rms_in_words(self.predicted, self.validated)})"

    @property
    def entrance_stage(self) -> int:
        """The highest stage that may be commanded at s < 0; stage K without approach."""
        return entrance_stage(self.approach, len(self.stages))

    @property
    def farthest(self) -> int:
        """By how many stages one command may go."""
        return farthest(self.decisions, len(self.stages))

    @property
    def has_gauge(self) -> bool:
        """Whether the lines depend on the pressure, which the controller must then measure."""
        return any(slope is not None for stage in self.stages for slope in stage.slopes)

    @property
    def highest_raised(self) -> int:
        """The highest stage that the table ever asks for."""
        return next(stage.k for stage in self.stages if stage.upper is None)

    def with_validated(self, validated: Validated) -> ControllerTable:
        """The same table with the figures of a closed-loop run filled in."""
        return replace(self, validated=validated)

    def _require_fields(self) -> None:
        require_declared(self)
        if self.estimator is None and self.predicted.passes is not None:
            raise InvalidTable("predicted.passes is given, but without an estimator the prediction is exact.")

    def _require_stages(self) -> None:
        for index, stage in enumerate(self.stages):
            if stage.k != index:
                raise InvalidTable(f"stages[{index}].k is {stage.k}, but stages must be numbered 0, 1, 2, ...")
        for below, above in pairwise(self.stages):
            if not below.pressure_kpa < above.pressure_kpa:
                raise InvalidTable(
                    f"stages[{above.k}].pressure_kpa is {above.pressure_kpa!r}, "
                    f"but it must exceed that of stage {below.k}, {below.pressure_kpa!r}."
                )
        if self.stages[0].lower is not None:
            raise InvalidTable("stages[0].lower is given, but it must be null: there is no stage below the lowest.")
        if self.stages[-1].upper is not None:
            raise InvalidTable("upper of the top stage is given, but it must be null: there is no stage above it.")

    def _require_approach(self) -> None:
        if self.approach is None:
            return
        require_count(self.approach.entrance_stage, "approach.entrance_stage", 0, len(self.stages) - 1)
        begin_m, end_m = -self.approach.length_m, self.valid.s_m[1]
        if not (self.valid.s_m[0] == begin_m and end_m > 0.0):
            raise InvalidTable(
                f"valid.s_m is {self.valid.s_m!r}, but with an approach it must begin at -approach.length_m, "
                f"{begin_m!r}, and end behind the entrance."
            )
        if self.estimator is not None and self.estimator.s_m[0] > begin_m:
            raise InvalidTable(
                f"estimator.s_m begins at {self.estimator.s_m[0]!r}, but its breaks must begin at -approach.length_m, "
                f"{begin_m!r}, or before."
            )

    def _require_slopes(self) -> None:
        if not self.has_gauge:
            return
        for stage in self.stages:
            if stage.pressure_kpa > LARGEST_FLOAT32:
                raise InvalidTable(
                    f"stages[{stage.k}].pressure_kpa is {stage.pressure_kpa!r}, which exceeds what float32 can hold, "
                    "but lines with slopes need it."
                )
            for side, line, slope in zip(SIDES, stage.lines, stage.slopes, strict=True):
                key = f"stages[{stage.k}].{side}_slope_m_s_per_kpa"
                if slope is not None and self.decisions is Decisions.AT_REST:
                    raise InvalidTable(
                        f"{key} is given, but a table whose decisions are at rest meets each stage at its pressure."
                    )
                if line is not None and slope is None:
                    raise InvalidTable(f"{key} is missing, but another line has one: give all lines a slope, or none.")

    def _require_lines(self, s_range_m: tuple[float, float], pressures: npt.NDArray[np.float32]) -> None:
        for stage in self.stages:
            key = f"stages[{stage.k}]"
            for side, line in zip(SIDES, stage.lines, strict=True):
                if line is not None and len(line) != self.degree + 1:
                    raise InvalidTable(
                        f"{key}.{side} has {len(line)} coefficients, but a line of degree {self.degree} has "
                        f"{self.degree + 1}."
                    )
            above = range_above(pressures, self.highest_raised, stage.k) if self.has_gauge else NO_PRESSURE
            require_stage(stage, s_range_m, above, key)


def _line_arrays(stages: tuple[Stage, ...], degree: int) -> tuple[npt.NDArray[np.float32], npt.NDArray[np.bool_]]:
    """Coefficients, float32 (K+1, 2, degree+1), NaN where a line is missing, and which lines there are, (K+1, 2)."""
    coefficients = np.full((len(stages), 2, degree + 1), np.nan, dtype=np.float32)
    has_line = np.zeros((len(stages), 2), dtype=np.bool_)
    for stage in stages:
        for index, line in enumerate(stage.lines):
            if line is not None:
                coefficients[stage.k, index] = line
                has_line[stage.k, index] = True
    return coefficients, has_line
