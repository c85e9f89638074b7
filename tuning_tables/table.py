"""The controller table: everything a trackside controller needs to regulate one class of cuts to one exit speed."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import Final

import numpy as np
import numpy.typing as npt

from tuning_tables.approach import Approach, entrance_stage
from tuning_tables.decisions import Decisions, farthest
from tuning_tables.errors import InvalidTable
from tuning_tables.estimator import Estimator
from tuning_tables.figures import Predicted, Validated, ValidRange
from tuning_tables.held_table import held_table
from tuning_tables.line_order import LARGEST_FLOAT32
from tuning_tables.programs.line_table import LineTable
from tuning_tables.provenance import CutId, Generator, RetarderId
from tuning_tables.requirement import (
    UTC_INSTANT,
    require_count,
    require_kind,
    require_match,
    require_positive,
    require_text,
    require_tuple,
)
from tuning_tables.stage import SIDES, Stage
from tuning_tables.surface_order import NO_PRESSURE, range_above, require_stage

MOST_STAGES: Final = 32
HIGHEST_DEGREE: Final = 9


@dataclass(frozen=True)
class ControllerTable:
    """A complete, checked table; it cannot be built otherwise, and nothing in it can be changed.

    id, created       name of the table; UTC instant "2026-11-20T22:46:00Z", given by the caller
    generator, retarder, cut   what made it and what it is for
    target_speed_m_s  exit speed the table aims at, > 0
    degree            of all lines, 0..9
    stages            k = 0..K in order, 1 <= K <= 31, pressures rising, degree+1 coefficients a line; no `lower` at
                      stage 0, no `upper` at stage K; no `upper` at stage k says that stage k+1 must not be entered
    valid             path and speed range of the lines
    predicted         figures of the solver; `validated` those of a closed loop, None before it was run
    estimator         with it the lines are for the estimated speed: see `rule.speed_for`; None: for the measured one
    approach          the regulator acts from before the entrance, at s = -approach.length_m, where the path range
                      begins; it ends behind the entrance, and an estimator's breaks begin no later. None: from s = 0
    decisions         at rest or at any time; at any time all lines of the table have a slope, or none has

    Derived from these, as arrays for `rule.decide` (read-only; line 0 is `lower`, line 1 is `upper`):

    coefficients      float32 (K+1, 2, degree+1), ascending powers of s in m; NaN where there is no line
    has_line          bool (K+1, 2)
    valid_range       float32 (4,): s_min, s_max in m, v_min, v_max in m/s
    slopes            float32 (K+1, 2), m/s per kPa; 0 where a line has none
    pressures         float32 (K+1,), kPa; the largest float32 number where one exceeds it
    held              what the programs take, `programs.line_table`

    On the valid path range lower(s) < upper(s) holds at every stage that has both, also as evaluated in float32, and
    with slopes at every pressure from that of stage 0 to that of the highest stage that the table raises to, and at the
    stage's own.

    Raises `InvalidTable`.
    """

    id: str
    created: str
    generator: Generator
    retarder: RetarderId
    cut: CutId
    target_speed_m_s: float
    degree: int
    stages: tuple[Stage, ...]
    valid: ValidRange
    predicted: Predicted
    validated: Validated | None = None
    estimator: Estimator | None = None
    approach: Approach | None = None
    decisions: Decisions = Decisions.AT_REST
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

    @property
    def entrance_stage(self) -> int:
        """The highest stage that may be commanded at s < 0, for `rule.decide`: stage K without approach."""
        return entrance_stage(self.approach, len(self.stages))

    @property
    def farthest(self) -> int:
        """By how many stages one command may go, for `rule.decide`."""
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
        require_text(self.id, "id")
        require_match(self.created, "created", UTC_INSTANT, "2026-11-20T22:46:00Z")
        require_kind(self.generator, "generator", Generator)
        require_kind(self.retarder, "retarder", RetarderId)
        require_kind(self.cut, "cut", CutId)
        require_positive(self.target_speed_m_s, "target_speed_m_s")
        require_kind(self.decisions, "decisions", Decisions)
        require_count(self.degree, "polynomial.degree", 0, HIGHEST_DEGREE)
        require_kind(self.valid, "valid", ValidRange)
        require_kind(self.predicted, "predicted", Predicted)
        if self.validated is not None:
            require_kind(self.validated, "validated", Validated)
        if self.estimator is not None:
            require_kind(self.estimator, "estimator", Estimator)
        elif self.predicted.passes is not None:
            raise InvalidTable("predicted.passes is given, but without an estimator the prediction is exact.")

    def _require_stages(self) -> None:
        require_tuple(self.stages, "stages")
        if not 2 <= len(self.stages) <= MOST_STAGES:
            raise InvalidTable(f"stages has {len(self.stages)} entries, but 2 to {MOST_STAGES} are allowed.")
        for index, stage in enumerate(self.stages):
            require_kind(stage, f"stages[{index}]", Stage)
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
        require_kind(self.approach, "approach", Approach)
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
