"""What a summary says of tables off nominal: its shape, and what its figures must keep among themselves.

The changed plants are those of the program that made the summary, so nothing is simulated anew here.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, Final

from synth.checker.document_shape import COUNT, NUMBER, TEXT, OrNull, Pair, require_shape
from synth.checker.finding import DamagedError, shown

KEYS: Final = ("low_friction", "slow_valves", "lost_readings", "wrong_weight")
"""Every condition; each must be told of."""

FOUND: Final[Mapping[str, Any]] = {
    "name": TEXT,
    "change": TEXT,
    "passes": COUNT,
    "rms_m_s": NUMBER,
    "rms_ci95_m_s": Pair(),
    "ratio": OrNull(NUMBER),
    "ratio_ci95": OrNull(Pair()),
    "overspeed": NUMBER,
    "overspeed_ci95": Pair(),
    "stalled": NUMBER,
    "stalled_ci95": Pair(),
}
NOT_POSSIBLE: Final[Mapping[str, Any]] = {"name": TEXT, "impossible": TEXT}
SHARES: Final = ("overspeed", "stalled")


def off_nominal_faults(case: Mapping[str, Any]) -> Iterator[str]:
    """Where the figures off nominal of a case are no such figures, or contradict themselves."""
    stated = case.get("off_nominal")
    if not isinstance(stated, dict) or set(stated) != set(KEYS):
        known = ", ".join(KEYS)
        yield f"summary.json says of it off nominal {shown(stated)}, but it must tell of {known}"
        return
    simulated = case.get("simulated")
    validated = simulated.get("passes") if isinstance(simulated, dict) else None
    for key, figures in stated.items():
        fault = condition_fault(figures, validated)
        if fault:
            yield f"summary.json says of it off nominal, {key}: {fault}"


def condition_fault(figures: Any, validated: Any) -> str | None:
    """What is wrong with the figures of one condition, of no more passes than the `validated` ones, if anything is."""
    impossible = isinstance(figures, dict) and "impossible" in figures
    try:
        require_shape(figures, NOT_POSSIBLE if impossible else FOUND, "")
    except DamagedError as error:
        return str(error)
    if impossible:
        return None
    for name, ends in (("rms_m_s", "rms_ci95_m_s"), *((share, f"{share}_ci95") for share in SHARES)):
        low, high = figures[ends]
        if not 0.0 <= low <= figures[name] <= high:
            return f"{name} is {shown(figures[name])}, which is outside its interval {shown(figures[ends])}"
    if any(figures[f"{share}_ci95"][1] > 1.0 for share in SHARES):
        return "a share above 1"
    ratio, ends = figures["ratio"], figures["ratio_ci95"]
    if (ratio is None) != (ends is None) or (ratio is not None and not 0.0 <= ends[0] <= ratio <= ends[1]):
        return f"ratio is {shown(ratio)}, which is outside its interval {shown(ends)}"
    if figures["passes"] < 1 or not isinstance(validated, int) or figures["passes"] > validated:
        return f"{shown(figures['passes'])} passes, but the table was simulated on {shown(validated)}"
    return None
