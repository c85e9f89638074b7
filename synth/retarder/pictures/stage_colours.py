"""How the stages are told apart in pictures, and which part of a pass or of a line belongs to one."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from plant_models.frozen_arrays import Floats
from synth.frame.picture.house_style import BLUE, GREEN, GREY, INK, ORANGE, PURPLE, SKY, VERMILLION
from synth.simulation.passes import PassTrace

STAGE_COLOURS: Final = (GREY, BLUE, GREEN, ORANGE, VERMILLION, PURPLE, SKY, INK)
"""Of the stages from 0 on; they come again where there are more."""


def colour_of(stage: int) -> str:
    """The colour of passes and lines of a stage."""
    return STAGE_COLOURS[stage % len(STAGE_COLOURS)]


def finite(line: Floats) -> Floats:
    """The line with gaps where the stage has no such command."""
    return np.where(np.isfinite(line), line, np.nan)


def parts_in_stage(traces: Sequence[PassTrace], stage: int) -> tuple[Floats, Floats]:
    """Path and speed of all passes while `stage` was commanded, gaps (NaN) between the parts."""
    paths, speeds = [np.empty(0)], [np.empty(0)]
    for trace in traces:
        inside = trace.stage == stage
        shown = inside.copy()
        shown[1:] |= inside[:-1]  # a stage holds up to the next event
        paths += [trace.path_m, np.array([np.nan])]
        speeds += [np.where(shown, trace.speed_m_s, np.nan), np.array([np.nan])]
    return np.concatenate(paths), np.concatenate(speeds)


def outcome(trace: PassTrace) -> str:
    """How a pass ended, in words."""
    return ended(trace.stalled, trace.exit_speed_m_s)


def ended(stalled: bool, exit_speed_m_s: float) -> str:
    """The same of a pass that left with this speed, where it was not `stalled`."""
    return "stopped in the position" if stalled else f"left at {exit_speed_m_s:.2f} m/s"
