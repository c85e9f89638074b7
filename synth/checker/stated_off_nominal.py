"""What a summary says of tables off nominal: its shape, and what its figures must keep among themselves.

The changed plants are those of the program that made the summary, so nothing is simulated anew here.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, Final

from synth.checker.document_shape import COUNT, NUMBER, TEXT, OrNull, require_shape
from synth.checker.finding import DamagedError, shown

KEYS: Final = ("low_friction", "slow_valves", "lost_readings", "wrong_weight")
"""Every condition; each must be told of."""

INTERVAL: Final[Mapping[str, Any]] = {"value": NUMBER, "low95": NUMBER, "high95": NUMBER, "n": COUNT}
FOUND: Final[Mapping[str, Any]] = {
    "label": TEXT,
    "target_speed_m_s": NUMBER,
    "key": TEXT,
    "condition": TEXT,
    "change": TEXT,
    "rms_m_s": INTERVAL,
    "ratio": OrNull(INTERVAL),
    "overspeed": INTERVAL,
    "stalled": INTERVAL,
    "impossible": OrNull(TEXT),
}
NOT_POSSIBLE: Final[Mapping[str, Any]] = {
    **FOUND,
    **dict.fromkeys(("change", "rms_m_s", "ratio", "overspeed", "stalled"), OrNull(TEXT)),
    "impossible": TEXT,
}
CONDITION_FIGURES: Final = ("rms_m_s", "ratio", "overspeed", "stalled")
SHARES: Final = ("overspeed", "stalled")


def off_nominal_faults(rows: list[Any], validated: Any) -> Iterator[str]:
    """Where the `rows` of a case are no such figures, or contradict themselves.

    `validated`: passes that its table was simulated on.
    """
    keys = [row.get("key") if isinstance(row, dict) else None for row in rows]
    if sorted(map(str, keys)) != sorted(KEYS):
        yield f"summary.json says of it off nominal {shown(keys)}, but it must tell of {', '.join(KEYS)}, each once"
        return
    for key, row in zip(keys, rows, strict=True):
        fault = condition_fault(row, validated)
        if fault:
            yield f"summary.json says of it off nominal, {key}: {fault}"


def condition_fault(row: Any, validated: Any) -> str | None:
    """What is wrong with the figures of one condition, of no more passes than the `validated` ones, if anything is."""
    impossible = row.get("impossible") is not None
    try:
        require_shape(row, NOT_POSSIBLE if impossible else FOUND, "")
    except DamagedError as error:
        return str(error)
    if impossible:
        return None
    for name, of in ((name, row[name]) for name in CONDITION_FIGURES if row[name] is not None):
        if not 0.0 <= of["low95"] <= of["value"] <= of["high95"]:
            return f"{name} is {shown(of['value'])}, which is outside its interval {shown([of['low95'], of['high95']])}"
        if of["n"] < 1 or not isinstance(validated, int) or of["n"] > validated:
            return f"{name} of {shown(of['n'])} passes, but the table was simulated on {shown(validated)}"
    if any(row[share]["high95"] > 1.0 for share in SHARES):
        return "a share above 1"
    return None
