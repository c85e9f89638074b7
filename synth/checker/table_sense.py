"""What a table must fulfil beside its form, so that a controller that follows it does something sensible."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import Final

from synth.checker.document_shape import origin_faults
from synth.checker.finding import Finding, Kind
from synth.checker.float32 import LARGEST, is_float32, rounded
from synth.checker.line_order import LEVEL, Tilt, compare, range_of
from synth.checker.table_reading import Line, Table

PLAUSIBLE_SPEED_M_S: Final = (-5.0, 30.0)
"""Every line of a stage that can be entered stays within; a line below 0 never lowers, one above 30 never raises."""

TARGET_DISTANCE_M_S: Final = 1.0
"""How near the line at which a released cut is braked must come to the target, somewhere on the path. At the exit
itself a command comes too late to matter, and lines are loose: this finds lines of another target, no small shifts."""


@dataclass(frozen=True)
class NamedLine:
    """A line with its stage and name, and its slope over the pressure, m/s per kPa."""

    stage: int
    name: str
    line: Line
    slope: float | None

    def __str__(self) -> str:
        return f"the {self.name} line of stage {self.stage}"


def sense(table: Table) -> Iterator[Finding]:
    """Every way in which `table` makes no sense, as damage."""
    for sentence in (*identity_faults(table), *pressure_faults(table), *line_faults(table)):
        yield Finding(Kind.DAMAGED, table.id, sentence)


def identity_faults(table: Table) -> Iterator[str]:
    """Faults of what the table says that it is for."""
    flat = [edge for zone in table.zones_m for edge in zone]
    if flat[0] != 0.0 or any(not a < b for a, b in pairwise(flat)):
        yield f"its zones {table.zones_m} do not follow one another from 0"
    if not rising(table.axle_offsets_m) or table.axle_offsets_m[0] != 0.0:
        yield f"its axle offsets {table.axle_offsets_m} do not rise from 0"
    last_m = flat[-1] + table.axle_offsets_m[-1]
    if abs(table.exit_m - last_m) > 1e-6:
        yield f"its exit is at {table.exit_m:g} m, but the last axle leaves the last zone at {last_m:g} m"
    if not table.mass_t > 0.0 or not table.dead_band_kpa >= 0.0:
        yield f"its mass of {table.mass_t:g} t or dead band of {table.dead_band_kpa:g} kPa is impossible"
    low, high = table.speed_m_s
    if not 0.0 <= low < table.target_m_s < high:
        yield f"its target of {table.target_m_s:g} m/s is not within its valid speeds, {low:g} to {high:g} m/s"
    begin, end = map(rounded, table.path_m)
    if not (begin < end and begin <= 0.0 and end >= rounded(table.exit_m)):
        yield f"its valid path, {table.path_m}, does not cover the way from 0 to the exit at {table.exit_m:g} m"
    yield from origin_faults(table.document)


def pressure_faults(table: Table) -> Iterator[str]:
    """Faults of the stage pressures."""
    if not rising(table.pressures_kpa) or table.pressures_kpa[0] < 0.0:
        yield f"its stage pressures {table.pressures_kpa} do not rise from 0 or more"
    elif any(b - a <= 2.0 * table.dead_band_kpa for a, b in pairwise(table.pressures_kpa)):
        yield f"two of its stages are no further apart than twice the dead band of {table.dead_band_kpa:g} kPa"


def line_faults(table: Table) -> Iterator[str]:
    """Faults of the lines: numbers, order, range, and what they do."""
    lines = [
        NamedLine(k, name, line, slope)
        for k, (both, slopes) in enumerate(zip(table.lines, table.slopes, strict=True))
        for name, line, slope in zip(("lower", "upper"), both, slopes, strict=True)
        if line is not None
    ]
    odd = [f"{each} has the coefficient {c!r}" for each in lines for c in each.line if not is_float32(c)]
    odd += [f"{each} has the slope {each.slope!r}" for each in lines if not is_float32(each.slope or 0.0)]
    odd = [*(f"{words}, which is no float32 number" for words in odd), *slope_faults(table)]
    yield from odd
    path_m = (rounded(table.path_m[0]), rounded(table.path_m[1]))
    if odd or not path_m[0] < path_m[1] or max(map(abs, path_m)) > 1e6:
        return  # nothing below means anything
    for k, (lower, upper) in enumerate(table.lines):
        if lower is not None and upper is not None:
            yield from order_faults(k, lower, upper, path_m, tilt_of(table, k))
            if k > table.top_stage and table.has_gauge:  # its own pressure is not in the range
                yield from order_faults(k, lower, upper, path_m, LEVEL)
    for each in lines:
        low, high = range_with_pressure(each, table, path_m)
        if each.stage <= table.top_stage:
            yield from used_line_faults(each, low, high, table)
        elif each.name == "lower" and not low > table.speed_m_s[1]:
            yield f"{each}, which the class may not use, falls to {low:.3f} m/s: the rule would stay in that stage"
    for k in range(table.top_stage + 1, len(table.lines)):
        if table.lines[k][0] is None:
            yield f"stage {k}, which the class may not use, has no lower line: the rule would never leave it"
    yield from target_faults(table, path_m)


def slope_faults(table: Table) -> Iterator[str]:
    """Faults of the slopes: every line has one, or none has, and none at rest."""
    if not table.has_gauge:
        return
    if not table.at_any_time:
        yield "its lines have slopes, but it decides at rest, where each stage has its own pressure"
    for k, (both, slopes) in enumerate(zip(table.lines, table.slopes, strict=True)):
        for name, line, slope in zip(("lower", "upper"), both, slopes, strict=True):
            if line is None and slope is not None:
                yield f"stage {k} has a slope of the {name} line, but no such line"
            if line is not None and slope is None:
                yield f"the {name} line of stage {k} has no slope, but other lines have one"
    if table.pressures_kpa[-1] > LARGEST:
        yield f"its stage pressures {table.pressures_kpa} exceed what float32 can hold"


def tilt_of(table: Table, stage: int) -> Tilt:
    """How the lines of `stage` rise with the pressure, over all pressures that the rule computes with."""
    if not table.has_gauge:
        return LEVEL
    lower, upper = (slope or 0.0 for slope in table.slopes[stage])
    least, own, most = (rounded(table.pressures_kpa[k]) for k in (0, stage, table.top_stage))
    return Tilt((lower, upper), own, (least, most))


def range_with_pressure(each: NamedLine, table: Table, path_m: tuple[float, float]) -> tuple[float, float]:
    """Bounds of a line on the path and at all pressures; where the gauge is silent, nothing is added."""
    low, high = range_of(each.line, path_m)
    own = table.pressures_kpa[each.stage]
    added = [(each.slope or 0.0) * (table.pressures_kpa[k] - own) for k in (0, table.top_stage)]
    return low + min(0.0, *added), high + max(0.0, *added)


def order_faults(stage: int, lower: Line, upper: Line, path_m: tuple[float, float], tilt: Tilt) -> Iterator[str]:
    """Whether lower and upper of a stage might both apply."""
    order = compare(lower, upper, path_m, tilt)
    if order.touch_m is not None:
        at = f"s = {order.touch_m:.9g} m" + ("" if tilt == LEVEL else f" and a pressure of {order.touch_kpa:.9g} kPa")
        yield f"at stage {stage} the lower line is not below the upper one at {at}"
    elif not order.proved:
        yield f"at stage {stage} the lines are too close to prove their order, near s = {order.closest_m:.9g} m"


def used_line_faults(each: NamedLine, low: float, high: float, table: Table) -> Iterator[str]:
    """Faults of a line that a controller can meet; it runs from `low` to `high` along the path."""
    least, most = PLAUSIBLE_SPEED_M_S
    if low < least or high > most:
        yield f"{each} runs from {low:.2f} to {high:.2f} m/s, out of the plausible {least:g} to {most:g} m/s"
    if each.name == "upper" and low >= table.speed_m_s[1]:
        yield f"{each} lies above every valid speed: stage {each.stage + 1} is never entered"
    if each.name == "lower" and high <= table.speed_m_s[0]:
        yield f"{each} lies below every valid speed: the stage is never left downwards"


def target_faults(table: Table, path_m: tuple[float, float]) -> Iterator[str]:
    """Whether the line at which braking begins has to do with the target."""
    first = table.lines[0][1]
    if first is None:
        yield "stage 0 has no upper line: the brake is never applied"
        return
    low, high = range_of(first, path_m)
    distance = max(low - table.target_m_s, table.target_m_s - high)
    if distance > TARGET_DISTANCE_M_S:
        yield f"the upper line of stage 0 stays {distance:.2f} m/s or more from the target, {table.target_m_s:g} m/s"


def exit_gap_m_s(table: Table) -> float:
    """Upper line of stage 0 at the end of the path less the target: near 0 where the fit is close there."""
    first = table.lines[0][1]
    return value_at(first, table.path_m[1]) - table.target_m_s if first is not None else 0.0


def value_at(line: Line, s_m: float) -> float:
    """The line at `s_m`, in double precision."""
    return sum(c * s_m**power for power, c in enumerate(line))


def rising(values: tuple[float, ...]) -> bool:
    """Whether each value exceeds the one before."""
    return all(a < b for a, b in pairwise(values))
