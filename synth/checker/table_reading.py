"""A controller table read from its JSON document, by a description of what the document must look like."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final

from synth.checker.canonical import canonical_form, crc32, parse_json, without_checksum
from synth.checker.finding import DamagedError, shown

Line = tuple[float, ...]

TEXT, NUMBER, COUNT = "a string", "a number", "a whole number"


@dataclass(frozen=True)
class OrNull:
    """`form`, or null."""

    form: Any


@dataclass(frozen=True)
class Pair:
    """An array of two numbers, the first not above the second."""


@dataclass(frozen=True)
class Optional:
    """A member that may be missing."""

    form: Any


NUMBERS: Final = [NUMBER]
SHAPE: Final[Mapping[str, Any]] = {
    "format": TEXT,
    "version": COUNT,
    "id": TEXT,
    "created": TEXT,
    "generator": {"name": TEXT, "version": TEXT, "config_sha256": TEXT},
    "retarder": {"name": TEXT, "zones_m": [Pair()], "exit_m": NUMBER, "dead_band_kpa": NUMBER},
    "cut": {"category": TEXT, "mass_t": NUMBER, "axle_offsets_m": NUMBERS},
    "target_speed_m_s": NUMBER,
    "polynomial": {"variable": TEXT, "degree": COUNT},
    "stages": [{"k": COUNT, "pressure_kpa": NUMBER, "lower": OrNull(NUMBERS), "upper": OrNull(NUMBERS)}],
    "valid": {"s_m": Pair(), "v_m_s": Pair()},
    "predicted": {
        "rms_m_s": NUMBER,
        "bias_m_s": NUMBER,
        "p_overspeed": NUMBER,
        "switchings": NUMBER,
        "p_stall": Optional(NUMBER),
    },
    "validated": OrNull({"passes": COUNT, "rms_m_s": NUMBER, "rms_ci95_m_s": Pair()}),
    "crc32": TEXT,
}
"""A dict: exactly these members; a list: an array of what it holds."""


@dataclass(frozen=True)
class Table:
    """A table as the controller must understand it, and the document that it was read from (less its checksum).

    `lines`: (lower, upper) of stage 0, 1, …, ascending powers of s in metres. `p_stall` and the three validated
    figures are None where the table does not state them.
    """

    id: str
    config_sha256: str
    retarder: str
    zones_m: tuple[tuple[float, float], ...]
    exit_m: float
    dead_band_kpa: float
    category: str
    mass_t: float
    axle_offsets_m: tuple[float, ...]
    target_m_s: float
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
    passes: int | None
    validated_rms_m_s: float | None
    validated_ci95_m_s: tuple[float, float] | None
    document: Mapping[str, Any]

    @property
    def top_stage(self) -> int:
        """The highest stage that the rule can enter from stage 0."""
        return next(k for k, (_, upper) in enumerate(self.lines) if upper is None)


def read_table(content: bytes) -> Table:
    """The table in the JSON text `content`; `DamagedError` for whatever is not one, a wrong checksum among it."""
    document = parse_json(content)
    if not isinstance(document, dict) or document.get("format") != "retarder-table":
        raise DamagedError('it is no controller table: its format is not "retarder-table"')
    if document.get("version") != 1 or isinstance(document["version"], bool):
        raise DamagedError(f"its version is {shown(document.get('version'))}, but this checker knows version 1 only")
    require_shape(document, SHAPE, "")
    sum_found = f"{crc32(canonical_form(without_checksum(document)).encode('utf-8')):08x}"
    if document["crc32"] != sum_found:
        raise DamagedError(f"its crc32 is {shown(document['crc32'])}, but its content gives {sum_found}")
    return table_of(without_checksum(document))


def require_shape(value: Any, form: Any, path: str) -> None:
    """Raise `DamagedError` unless `value`, found at `path`, looks like `form`."""
    match form:
        case OrNull():
            if value is not None:
                require_shape(value, form.form, path)
        case Pair():
            require_shape(value, NUMBERS, path)
            refuse_unless(len(value) == 2 and value[0] <= value[1], value, path, "two numbers, the smaller one first")
        case Mapping():
            refuse_unless(isinstance(value, dict), value, path, "an object")
            needed = {key for key, member in form.items() if not isinstance(member, Optional)}
            wrong = sorted((value.keys() - form.keys()) | (needed - value.keys()))
            refuse_unless(not wrong, wrong, path, "an object without missing or unknown keys such as these")
            for key, member in value.items():
                of = form[key]
                require_shape(member, of.form if isinstance(of, Optional) else of, f"{path}.{key}".lstrip("."))
        case [inner]:
            refuse_unless(isinstance(value, list) and len(value) > 0, value, path, "an array that is not empty")
            for index, item in enumerate(value):
                require_shape(item, inner, f"{path}[{index}]")
        case _:
            refuse_unless(is_a(form, value), value, path, form)


def is_a(form: str, value: Any) -> bool:
    """Whether `value` is of the simple kind `form`."""
    if form == TEXT:
        return isinstance(value, str) and value != "" and value.isprintable()
    if isinstance(value, bool) or not isinstance(value, int | float):
        return False
    return abs(value) <= 2**53 if isinstance(value, int) else form == NUMBER


def refuse_unless(holds: bool, value: Any, path: str, wanted: str) -> None:
    """Raise `DamagedError` unless `holds`."""
    if not holds:
        raise DamagedError(f"{path or 'the document'} is {shown(value)}, but it must be {wanted}")


def table_of(document: Mapping[str, Any]) -> Table:
    """The table in a document of the right shape; `DamagedError` if its parts make no table."""
    retarder, cut, predicted = document["retarder"], document["cut"], document["predicted"]
    validated, stages, degree = document["validated"], document["stages"], document["polynomial"]["degree"]
    refuse_unless(document["polynomial"]["variable"] == "s_m", document["polynomial"], "polynomial", "in s_m")
    refuse_unless(0 <= degree <= 9, degree, "polynomial.degree", "from 0 to 9")
    refuse_unless(2 <= len(stages) <= 32, len(stages), "the number of stages", "from 2 to 32")
    for k, stage in enumerate(stages):
        refuse_unless(stage["k"] == k, stage["k"], f"stages[{k}].k", str(k))
        for line in (stage["lower"], stage["upper"]):
            refuse_unless(line is None or len(line) == degree + 1, line, f"stages[{k}]", f"of {degree + 1} numbers")
    refuse_unless(stages[0]["lower"] is None, stages[0]["lower"], "stages[0].lower", "null")
    refuse_unless(stages[-1]["upper"] is None, stages[-1]["upper"], f"stages[{len(stages) - 1}].upper", "null")
    return Table(
        id=document["id"],
        config_sha256=document["generator"]["config_sha256"],
        retarder=retarder["name"],
        zones_m=tuple((float(begin), float(end)) for begin, end in retarder["zones_m"]),
        exit_m=float(retarder["exit_m"]),
        dead_band_kpa=float(retarder["dead_band_kpa"]),
        category=cut["category"],
        mass_t=float(cut["mass_t"]),
        axle_offsets_m=numbers(cut["axle_offsets_m"]),
        target_m_s=float(document["target_speed_m_s"]),
        degree=degree,
        pressures_kpa=tuple(float(stage["pressure_kpa"]) for stage in stages),
        lines=tuple((line_of(stage["lower"]), line_of(stage["upper"])) for stage in stages),
        path_m=pair(document["valid"]["s_m"]),
        speed_m_s=pair(document["valid"]["v_m_s"]),
        predicted_rms_m_s=float(predicted["rms_m_s"]),
        bias_m_s=float(predicted["bias_m_s"]),
        p_overspeed=float(predicted["p_overspeed"]),
        switchings=float(predicted["switchings"]),
        p_stall=float(predicted["p_stall"]) if "p_stall" in predicted else None,
        passes=validated["passes"] if validated else None,
        validated_rms_m_s=float(validated["rms_m_s"]) if validated else None,
        validated_ci95_m_s=pair(validated["rms_ci95_m_s"]) if validated else None,
        document=document,
    )


def numbers(values: list[float]) -> tuple[float, ...]:
    """An array of numbers."""
    return tuple(map(float, values))


def line_of(values: list[float] | None) -> Line | None:
    """A line, or none."""
    return None if values is None else numbers(values)


def pair(values: list[float]) -> tuple[float, float]:
    """Two numbers; rounding to double keeps their order."""
    return float(values[0]), float(values[1])
