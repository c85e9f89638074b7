"""What pictures show of a case, as plain values: how simulated exit speeds are set beside the predicted density, a run
by the stage in force, and how all simulated cuts leave.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np

from plant_models.frozen_arrays import Floats
from synth.problem.problem import OVERSPEED_M_S
from synth.retarder.tuned_case import TunedCase
from synth.simulation.passes import TRACE_FACTORS, PassTrace
from synth.solver.exit_density import ExitDensity
from synth.solver.switching_lines import SwitchingLines

if TYPE_CHECKING:
    from synth.retarder.case_result import CaseResult

NARROW_M_S: Final = 0.01
"""Width of the bins of simulated passes near the target, within `OVERSPEED_M_S` of it."""

WIDE_M_S: Final = 0.1
"""The same beyond."""

EXACT: Final = "predicted by the forward equation"


def prediction_origin(cases: Sequence[TunedCase]) -> str:
    """What the predicted densities come from, in a legend or a caption."""
    estimated = [case.table.predicted.passes is not None for case in cases]
    if all(estimated):
        return "predicted from other simulated passes"
    return f"{EXACT}; with an estimator from other simulated passes" if any(estimated) else EXACT


def predicted_density(exits: ExitDensity) -> tuple[Floats, Floats]:
    """Speeds, and the density there in 1/(m/s); the grid's first energy stands for cuts next to a stall."""
    speed, probability = exits.speed_m_s[1:], exits.probability[1:]
    return speed, probability * speed / (0.5 * exits.speed_m_s[1] ** 2)


def bin_edges_m_s(target_m_s: float, highest_m_s: float) -> Floats:
    """Edges of the bins from 0 to beyond `highest_m_s`; the target is one of them."""
    half = round(OVERSPEED_M_S / NARROW_M_S)
    narrow = NARROW_M_S * np.arange(-half, half + 1)
    wide = np.arange(OVERSPEED_M_S + WIDE_M_S, max(target_m_s, highest_m_s - target_m_s) + 1.5 * WIDE_M_S, WIDE_M_S)
    edges = target_m_s + np.concatenate((-wide[::-1], narrow, wide))
    return np.append(0.0, edges[edges > 1e-9])


NOMINAL: Final = TRACE_FACTORS.index(1.0)
"""Which of the traced passes is shown: that of mean friction."""

NEAR_M_S: Final = 1.2 * OVERSPEED_M_S
"""Exit speeds are shown so far from the target."""

PlainNumbers = tuple[float, ...]


@dataclass(frozen=True)
class SwitchingLine:
    """A line over path; empty where the stage has none there."""

    path_m: PlainNumbers
    speed_m_s: PlainNumbers


@dataclass(frozen=True)
class StagePart:
    """A part of a run with one stage in force: path and speed at its events, and the lines of the stage there."""

    stage: int
    pressure_kpa: float
    path_m: PlainNumbers
    speed_m_s: PlainNumbers
    upper: SwitchingLine
    lower: SwitchingLine


@dataclass(frozen=True)
class ExitDensities:
    """Densities of the exit speed in s/m near the target: of simulated cuts in bins between `edges_m_s` (one more than
    bins), and predicted at `speed_m_s`."""

    edges_m_s: PlainNumbers
    simulated_s_m: PlainNumbers
    speed_m_s: PlainNumbers
    predicted_s_m: PlainNumbers


@dataclass(frozen=True)
class ShownCase:
    """Position, target and fastest entry of a case, its `run` in parts (none where no pass was traced), its exits.

    `stalled`: the run stopped in the position.
    """

    label: str
    target_m_s: float
    zones_m: tuple[tuple[float, float], ...]
    ends_m: tuple[float, float]
    fastest_entry_m_s: float
    run: tuple[StagePart, ...]
    stalled: bool
    rms_m_s: float
    exits: ExitDensities


def shown_case(case: CaseResult) -> ShownCase:
    """The picture's values of `case`."""
    runs = case.traces[NOMINAL : NOMINAL + 1]
    lines, pressures = case.table_lines, case.plant.position.stage_pressures_kpa
    return ShownCase(
        label=case.label,
        target_m_s=case.target_speed_m_s,
        zones_m=case.plant.position.zones_m,
        ends_m=(case.plant.start_m, case.plant.exit_m),
        fastest_entry_m_s=case.plant.entry.high_m_s,
        run=tuple(part for run in runs for part in stage_parts(run, lines, pressures)),
        stalled=any(run.stalled for run in runs),
        rms_m_s=case.statistics.rms_m_s,
        exits=exit_densities(case),
    )


def stage_parts(run: PassTrace, lines: SwitchingLines, pressures_kpa: tuple[float, ...]) -> list[StagePart]:
    """The run cut where its stage changes; an event between two parts belongs to both."""
    ends = [*(np.flatnonzero(np.diff(run.stage)) + 1).tolist(), len(run.stage) - 1]
    parts = []
    for start, end in zip([0, *ends[:-1]], ends, strict=True):
        if end > start:
            stage, path = int(run.stage[start]), run.path_m[start : end + 1]
            there = (lines.nodes_m >= path[0]) & (lines.nodes_m <= path[-1])
            upper, lower = (
                line_of(lines.nodes_m[there], sides[stage][there]) for sides in (lines.upper_m_s, lines.lower_m_s)
            )
            speed = numbers(run.speed_m_s[start : end + 1])
            parts.append(StagePart(stage, pressures_kpa[stage], numbers(path), speed, upper, lower))
    return parts


def line_of(path_m: Floats, speed_m_s: Floats) -> SwitchingLine:
    """What there is of a line."""
    known = np.isfinite(speed_m_s)
    return SwitchingLine(numbers(path_m[known]), numbers(speed_m_s[known]))


def exit_densities(case: CaseResult) -> ExitDensities:
    """Simulated and predicted, within `NEAR_M_S` of the target."""
    target, share = case.target_speed_m_s, case.exit_weight / case.exit_weight.sum()
    speed, predicted = predicted_density(case.predicted)
    edges = bin_edges_m_s(target, float(max(case.exit_speeds_m_s.max(initial=0.0), speed[-1])))
    moving = case.exit_speeds_m_s > 0.0
    simulated = np.histogram(case.exit_speeds_m_s[moving], edges, weights=share[moving])[0] / np.diff(edges)
    inside, near = (np.abs(each - target) <= NEAR_M_S + 1e-9 for each in (edges, speed))
    return ExitDensities(
        numbers(edges[inside]), numbers(simulated[inside[:-1] & inside[1:]]), numbers(speed[near]),
        numbers(predicted[near]),
    )  # fmt: skip


def numbers(values: Floats) -> PlainNumbers:
    """As plain numbers."""
    return tuple(float(each) for each in values)
