"""How the stages are told apart in pictures, which part of a pass or of a line belongs to one, and panels of the best
command, one a stage: colours over path and speed, for whoever draws lines or sensors on them.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from matplotlib.colors import to_rgba_array
from matplotlib.figure import Figure
from numpy.typing import NDArray

from plant_models.frozen_arrays import Floats, Ints
from synth.frame.picture.house_style import BLUE, GREEN, GREY, INK, ORANGE, PURPLE, SKY, VERMILLION, new_figure, place
from synth.simulation.passes import PassTrace

if TYPE_CHECKING:
    from synth.solver.backward_induction import PolicyMap

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


DOWN, HOLD, UP, HATCH = "#cfe4f3", "#fafafa", "#fae0cf", "#b5b5b5"
STRIPE_PERIOD, STRIPE_WIDTH = 9, 2
"""Of the hatching, in pixels along the path."""


def stage_panels(title: str, subject: str, stages: int) -> tuple[Figure, Any]:
    """A figure with a panel for each stage and at least one free place, path across and speed upwards; and its grid."""
    columns = math.ceil((stages + 1) / 2)
    figure = new_figure(3.7 * columns + 0.4, 6.6, title, subject)
    place(figure, left=0.6, right=0.2, bottom=0.5, top=0.85, w=0.08, h=0.22)
    grid = figure.subplots(2, columns, sharex=True, sharey=True)
    for free in grid.flat[stages:]:
        free.set_axis_off()
    return figure, grid


def label_panels(grid: Any, stages: int) -> None:
    """Names and units on the outer panels of `stage_panels`, after they are drawn."""
    for stage in range(stages):
        below_is_free = stage + grid.shape[1] >= stages
        grid.flat[stage].tick_params(labelbottom=below_is_free)
        if below_is_free:
            grid.flat[stage].set_xlabel("path of the first axle, m", fontsize=9)
    for row in grid:
        row[0].set_ylabel("speed, m/s", fontsize=9)


def command_image(
    policy: PolicyMap, stage: int, ends_m: tuple[float, float], speeds_m_s: tuple[float, float], pixels: tuple[int, int]
) -> NDArray[np.uint8]:
    """The map of one stage as colours (speed, path, 4) on an even mesh of `pixels`, path by speed; slowest first."""
    width, height = pixels
    path = ends_m[0] + (np.arange(width) + 0.5) / width * (ends_m[1] - ends_m[0])
    speed = speeds_m_s[0] + (np.arange(height) + 0.5) / height * (speeds_m_s[1] - speeds_m_s[0])
    node = np.clip(np.searchsorted(policy.path_m, path, side="right") - 1, 0, policy.path_m.size - 1)
    here = np.ix_(node, nearest(policy.speed_m_s, speed))
    shown = policy.command[stage][here].T + 1
    stripe = (np.arange(width) - np.arange(height)[:, None]) % STRIPE_PERIOD < STRIPE_WIDTH
    shown[stripe & policy.indifferent[stage][here].T] = 3
    colours = np.round(255.0 * to_rgba_array([DOWN, HOLD, UP, HATCH])).astype(np.uint8)
    image: NDArray[np.uint8] = colours[shown]
    return image


def nearest(nodes: Floats, values: Floats) -> Ints:
    """Index of the node nearest to each value; `nodes` increase."""
    return np.searchsorted(0.5 * (nodes[1:] + nodes[:-1]), values)
