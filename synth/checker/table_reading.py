"""A table with lines, read from its JSON document."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from synth.checker.document_shape import (
    AT_ANY_TIME,
    LINES,
    LINES_SHAPE,
    SLOPES,
    checked_document,
    number_of,
    refuse_unless,
)
from synth.checker.estimator import Estimator, estimator_of

Line = tuple[float, ...]


@dataclass(frozen=True)
class Table:
    """A table as the controller must understand it, and the document that it was read from (less its checksum).

    `lines`: (lower, upper) of stage 0, 1, …, ascending powers of s in metres. `p_stall` and the three validated
    figures are None where the table does not state them, `predicted_passes` where the prediction was not simulated,
    `estimator` where it is for the measured speed, `category_number` where nothing tells it. `approach_m`, 0.0 without:
    the regulator acts from so far before the entrance, and commands no stage above `entrance_stage` there.

    `at_any_time`: it is asked at every sample, not only when no change of stage is under way; the stage asked for is
    the one commanded last. `slopes`: those of `lines` over the pressure, m/s per kPa, None where there is none; a line
    holds at the pressure of its stage, and its slope counts from there.
    """

    id: str
    config_sha256: str
    retarder: str
    zones_m: tuple[tuple[float, float], ...]
    exit_m: float
    dead_band_kpa: float
    category: str
    category_number: int | None
    mass_t: float
    axle_offsets_m: tuple[float, ...]
    target_m_s: float
    sample_period_s: float
    computing_delay_s: float
    degree: int
    pressures_kpa: tuple[float, ...]
    lines: tuple[tuple[Line | None, Line | None], ...]
    path_m: tuple[float, float]
    speed_m_s: tuple[float, float]
    predicted_rms_m_s: float
    bias_m_s: float
    p_overspeed: float
    switchings: float
    p_stall: float | None
    predicted_passes: int | None
    passes: int | None
    validated_rms_m_s: float | None
    validated_ci95_m_s: tuple[float, float] | None
    estimator: Estimator | None
    approach_m: float
    entrance_stage: int
    at_any_time: bool
    slopes: tuple[tuple[float | None, float | None], ...]
    document: Mapping[str, Any]

    @property
    def top_stage(self) -> int:
        """The highest stage that the rule can enter from stage 0."""
        return next(k for k, (_, upper) in enumerate(self.lines) if upper is None)

    @property
    def farthest(self) -> int:
        """How many stages one command may go: any number at rest, one where the next sample asks again."""
        return 1 if self.at_any_time else len(self.lines) - 1

    @property
    def has_gauge(self) -> bool:
        """Whether its lines depend on the pressure, which the controller must then measure."""
        return any(slope is not None for both in self.slopes for slope in both)


def read_table(content: bytes) -> Table:
    """The table in the JSON text `content`; `DamagedError` for whatever is not one, a wrong checksum among it."""
    return table_of(checked_document(content, LINES, LINES_SHAPE))


def table_of(document: Mapping[str, Any]) -> Table:
    """The table in a document of the right shape; `DamagedError` if its parts make no table."""
    retarder, cut, predicted = document["retarder"], document["cut"], document["predicted"]
    stages, degree = document["stages"], document["degree"]
    refuse_unless(0 <= degree <= 9, degree, "degree", "from 0 to 9")
    refuse_unless(2 <= len(stages) <= 32, len(stages), "the number of stages", "from 2 to 32")
    passes = predicted["passes"]
    refuse_unless(passes is None or passes >= 1, passes, "predicted.passes", "1 or more")
    refuse_unless(
        passes is None or document["estimator"] is not None,
        passes,
        "predicted.passes",
        "null where there is no estimator",
    )
    for k, stage in enumerate(stages):
        refuse_unless(stage["k"] == k, stage["k"], f"stages[{k}].k", str(k))
        for line in (stage["lower"], stage["upper"]):
            refuse_unless(line is None or len(line) == degree + 1, line, f"stages[{k}]", f"of {degree + 1} numbers")
    refuse_unless(stages[0]["lower"] is None, stages[0]["lower"], "stages[0].lower", "null")
    refuse_unless(stages[-1]["upper"] is None, stages[-1]["upper"], f"stages[{len(stages) - 1}].upper", "null")
    approach_m, entrance_stage = approach_of(document)
    return Table(
        id=document["id"],
        config_sha256=document["generator"]["config_sha256"],
        retarder=retarder["name"],
        zones_m=tuple((float(begin), float(end)) for begin, end in retarder["zones_m"]),
        exit_m=float(retarder["exit_m"]),
        dead_band_kpa=float(retarder["dead_band_kpa"]),
        category=cut["category"],
        category_number=number_of(cut),
        mass_t=float(cut["mass_t"]),
        axle_offsets_m=numbers(cut["axle_offsets_m"]),
        target_m_s=float(document["target_speed_m_s"]),
        **clock_of(document["clock"]),
        degree=degree,
        pressures_kpa=tuple(float(stage["pressure_kpa"]) for stage in stages),
        lines=tuple((line_of(stage["lower"]), line_of(stage["upper"])) for stage in stages),
        path_m=pair(document["valid"]["s_m"]),
        speed_m_s=pair(document["valid"]["v_m_s"]),
        **stated_figures(document),
        estimator=estimator_of(document["estimator"]) if document["estimator"] else None,
        approach_m=approach_m,
        entrance_stage=entrance_stage,
        at_any_time=document["decisions"] == AT_ANY_TIME,
        slopes=tuple(slopes_of(stage) for stage in stages),
        document=document,
    )


def stated_figures(document: Mapping[str, Any]) -> dict[str, Any]:
    """What a table says of its accuracy, by the names of `Table`."""
    predicted, validated = document["predicted"], document["validated"]
    return {
        "predicted_rms_m_s": float(predicted["rms_m_s"]),
        "bias_m_s": float(predicted["bias_m_s"]),
        "p_overspeed": float(predicted["p_overspeed"]),
        "switchings": float(predicted["switchings"]),
        "p_stall": None if predicted["p_stall"] is None else float(predicted["p_stall"]),
        "predicted_passes": predicted["passes"],
        "passes": validated["passes"] if validated else None,
        "validated_rms_m_s": float(validated["rms_m_s"]) if validated else None,
        "validated_ci95_m_s": pair(validated["rms_ci95_m_s"]) if validated else None,
    }


def approach_of(document: Mapping[str, Any]) -> tuple[float, int]:
    """Length of the approach and entrance stage; without approach 0 and the highest stage."""
    top = len(document["stages"]) - 1
    approach, path = document["approach"], document["valid"]["s_m"]
    if approach is None:
        return 0.0, top
    length_m, stage = approach["length_m"], approach["entrance_stage"]
    refuse_unless(0.001 <= length_m <= 100.0, length_m, "approach.length_m", "from 0.001 to 100")
    refuse_unless(0 <= stage <= top, stage, "approach.entrance_stage", f"from 0 to {top}")
    refuse_unless(path[0] == -length_m and path[1] > 0.0, path, "valid.s_m", "from -approach.length_m beyond 0")
    if document["estimator"]:
        first_m = document["estimator"]["s_m"][0]
        refuse_unless(first_m <= -length_m, first_m, "estimator.s_m[0]", "-approach.length_m at most")
    return float(length_m), stage


def clock_of(clock: Mapping[str, Any]) -> dict[str, Any]:
    """The numbers of the regulator's clock, by the names of `Table`."""
    for key, low, high in (("sample_period_s", 0.001, 2.0), ("computing_delay_s", 0.0, 2.0)):
        refuse_unless(low <= clock[key] <= high, clock[key], f"clock.{key}", f"from {low:g} to {high:g}")
    return {key: float(value) for key, value in clock.items()}


def numbers(values: list[float]) -> tuple[float, ...]:
    """An array of numbers."""
    return tuple(map(float, values))


def line_of(values: list[float] | None) -> Line | None:
    """A line, or none."""
    return None if values is None else numbers(values)


def slopes_of(stage: Mapping[str, Any]) -> tuple[float | None, float | None]:
    """The slopes of the lower and of the upper line of a stage, None where there is none."""
    lower, upper = (None if stage[key] is None else float(stage[key]) for key in SLOPES)
    return lower, upper


def pair(values: list[float]) -> tuple[float, float]:
    """Two numbers; rounding to double keeps their order."""
    return float(values[0]), float(values[1])
