"""How cuts leave: of one case beside a run over path by the stage in force; the predicted density over the simulated
histogram, two independent computations of one thing; and the cuts of a bench, for the controller and for the table.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import ConnectionPatch, Patch
from matplotlib.typing import LineStyleType

from synth.frame.picture.house_style import (
    BLUE,
    GREY,
    INK,
    PALE_GREY,
    SKY,
    VERMILLION,
    dress,
    legend_below,
    logarithmic_y,
    mark_entrance,
    new_figure,
    place,
)
from synth.problem.problem import OVERSPEED_M_S
from synth.retarder.pictures.stage_panels import colour_of, ended
from synth.retarder.shown_case import (
    NEAR_M_S,
    ShownCase,
    StagePart,
    bin_edges_m_s,
    predicted_density,
    prediction_origin,
)
from synth.retarder.tuned_case import TunedCase

TARGET_STYLE: Final[LineStyleType] = (0, (4, 3))
LOWER_STYLE: Final[LineStyleType] = (0, (3, 2))
"""Of the line below which a stage goes one down."""

LEAST_NAMED_M: Final = 2.0
"""A shorter part of the run has no room for the number of its stage."""

LAST_M: Final = 2.0
"""So near to the end of the run its outcome is written."""


def case_picture(case: ShownCase) -> Figure:
    """Left: speed in m/s over path in m. Right: the density of exit speeds, the speed axis enlarged at the target."""
    figure = new_figure(6.2, 3.5, f"{case.label} to {case.target_m_s:g} m/s")
    place(figure, left=0.55, right=0.12, bottom=1.02, top=0.42, w=0.3)
    run, exits = figure.subplots(1, 2, width_ratios=(2.6, 1.0))
    draw_run(run, case)
    draw_exits(exits, case)
    enlarge(figure, run, exits, case.target_m_s)
    legend_below(figure, legend_entries(case), columns=4)
    return figure


def draw_run(axes: Axes, case: ShownCase) -> None:
    """Zones, the run in the colour of the stage in force, and the lines of that stage."""
    for start_m, end_m in case.zones_m:
        axes.axvspan(start_m, end_m, color=PALE_GREY, linewidth=0, zorder=0)
    mark_entrance(axes, case.ends_m[0])
    axes.axhline(case.target_m_s, color=INK, linewidth=0.8, linestyle=TARGET_STYLE, zorder=1)
    dress(axes, "", "path of the first axle, m", "speed, m/s")
    axes.grid(False)
    lowest = min([case.target_m_s - 1.0, *(min(part.speed_m_s) - 0.1 for part in case.run)])
    axes.set(xlim=(case.ends_m[0], case.ends_m[1] + 0.4), ylim=(max(0.0, lowest), case.fastest_entry_m_s + 0.4))
    for part in case.run:
        colour = colour_of(part.stage)
        axes.plot(part.path_m, part.speed_m_s, color=colour, linewidth=2.2, solid_capstyle="round", zorder=5)
        axes.plot(part.upper.path_m, part.upper.speed_m_s, color=colour, linewidth=0.9, zorder=4)
        axes.plot(part.lower.path_m, part.lower.speed_m_s, color=colour, linewidth=0.9, linestyle=LOWER_STYLE, zorder=4)
        if part.path_m[-1] - part.path_m[0] >= LEAST_NAMED_M and part.path_m[-1] <= case.run[-1].path_m[-1] - LAST_M:
            name_part(axes, part)
    if case.run:
        mark_end(axes, case)


def name_part(axes: Axes, part: StagePart) -> None:
    """The number of the stage above its part of the run: colour alone does not tell it to everybody."""
    middle = 0.5 * (part.path_m[0] + part.path_m[-1])
    at = min(range(len(part.path_m)), key=lambda i: abs(part.path_m[i] - middle))
    axes.annotate(
        str(part.stage), (part.path_m[at], part.speed_m_s[at]), (0.0, 9.0), textcoords="offset points", ha="center",
        fontsize=8, color=INK, zorder=6,
    )  # fmt: skip


def mark_end(axes: Axes, case: ShownCase) -> None:
    """A dot where the cut is released, or where it stopped."""
    last = case.run[-1]
    at = last.path_m[-1], last.speed_m_s[-1]
    axes.plot(*at, "o", color=INK, markersize=6, zorder=7, clip_on=False)
    axes.annotate(
        ended(case.stalled, last.speed_m_s[-1]), at, (2.0, 24.0), textcoords="offset points", ha="right", fontsize=8,
        color=INK, zorder=7,
    )  # fmt: skip


def draw_exits(axes: Axes, case: ShownCase) -> None:
    """Histogram of the simulated exit speeds, and the predicted density, along an upright speed axis."""
    exits, target = case.exits, case.target_m_s
    axes.stairs(exits.simulated_s_m, exits.edges_m_s, orientation="horizontal", fill=True, color=SKY, linewidth=0)
    axes.plot(exits.predicted_s_m, exits.speed_m_s, color=VERMILLION, linewidth=1.2)
    axes.axhline(target, color=INK, linewidth=0.8, linestyle=TARGET_STYLE)
    dress(axes, f"rms {case.rms_m_s:.3f} m/s", "density, s/m")
    axes.grid(False)
    axes.set(ylim=(target - NEAR_M_S, target + NEAR_M_S), xlim=(0.0, None))


def enlarge(figure: Figure, run: Axes, exits: Axes, target_m_s: float) -> None:
    """Two lines from the end of the run to the ends of the enlarged axis."""
    for sign in (-1.0, 1.0):
        speed = target_m_s + sign * NEAR_M_S
        figure.add_artist(
            ConnectionPatch(
                (run.get_xlim()[1], speed), (0.0, speed), "data", "data", axesA=run, axesB=exits, color=GREY,
                linewidth=0.6, zorder=0,
            )
        )  # fmt: skip


def legend_entries(case: ShownCase) -> list[Artist]:
    """The stages that the run meets, and what else is drawn."""
    stages = sorted({(part.stage, part.pressure_kpa) for part in case.run})
    return [
        *(
            Line2D([], [], color=colour_of(stage), linewidth=2.2, label=f"stage {stage}: {kpa:g} kPa")
            for stage, kpa in stages
        ),
        Line2D([], [], color=INK, linewidth=0.9, label="brakes more above"),
        Line2D([], [], color=INK, linewidth=0.9, linestyle=LOWER_STYLE, label="releases below"),
        Patch(facecolor=PALE_GREY, label="retarders"),
        Line2D([], [], color=INK, linewidth=0.8, linestyle=TARGET_STYLE, label="target"),
        Patch(facecolor=SKY, label="simulated"),
        Line2D([], [], color=VERMILLION, linewidth=1.2, label="predicted"),
    ]


LEAST = 1e-4
"""Bottom of the logarithmic panel, 1/(m/s): one cut in 100 000 in a wide bin."""


def exit_density(cases: Sequence[TunedCase]) -> Figure:
    """One column for each of these cases of one class: density in 1/(m/s) over exit speed in m/s, near the target, and
    its tails logarithmically."""
    columns = len(cases)
    figure = new_figure(3.9 * columns + 0.7, 6.4, "Exit speed, predicted and simulated", cases[0].cut_name)
    in_legend = min(4, 2 * columns)  # beside each other: a single panel is narrow
    place(figure, left=0.8, right=0.2, bottom=0.75 + 0.2 * math.ceil(4 / in_legend), top=1.25, w=0.2, h=0.22)
    panels = figure.subplots(2, columns, squeeze=False)
    for column, each in enumerate(cases):
        draw_case(panels[0, column], panels[1, column], each)
    panels[0, 0].set_ylabel("density, 1/(m/s)", fontsize=9)
    panels[1, 0].set_ylabel("the same, logarithmic", fontsize=9)
    handles = [
        Patch(facecolor=SKY, label="simulated passes"),
        Line2D([], [], color=VERMILLION, linewidth=1.4, label=prediction_origin(cases)),
        Line2D([], [], color=INK, linewidth=1.2, label="target"),
        Line2D([], [], color=GREY, linewidth=1.2, linestyle="--", label=f"target ± {OVERSPEED_M_S:g} m/s"),
    ]
    legend_below(figure, handles, columns=in_legend)
    return figure


def draw_case(near: Axes, tails: Axes, case: TunedCase) -> None:
    """Both panels of one case."""
    target, speeds, share = case.target_speed_m_s, case.exit_speeds_m_s, case.exit_weight / case.exit_weight.sum()
    speed, predicted = predicted_density(case.predicted)
    edges = bin_edges_m_s(target, float(max(speeds.max(initial=0.0), speed[-1])))
    moving = speeds > 0.0
    simulated = np.histogram(speeds[moving], edges, weights=share[moving])[0] / np.diff(edges)
    dress(near, panel_title(case))
    dress(tails, x="exit speed, m/s")
    told = predicted > LEAST
    shown = np.concatenate((speed[told], edges[1:][simulated > LEAST], edges[:-1][simulated > LEAST]))
    if not shown.size:
        near.text(0.5, 0.5, "no pass leaves the position", transform=near.transAxes, ha="center", fontsize=9)
        return
    for axes in (near, tails):
        axes.stairs(simulated, edges, fill=True, color=SKY, linewidth=0)
        axes.plot(speed, np.where(told, predicted, np.nan), color=VERMILLION, linewidth=1.3)
        axes.axvline(target, color=INK, linewidth=1.0)
        for mark in (target - OVERSPEED_M_S, target + OVERSPEED_M_S):
            axes.axvline(mark, color=GREY, linewidth=1.0, linestyle="--")
    highest, far = max(float(predicted.max()), float(simulated.max())), 1.2 * OVERSPEED_M_S
    near.set(xlim=(target - far, target + far), ylim=(0.0, 1.08 * highest))
    tails.set_xlim(min(target - far, float(shown.min())), max(target + far, float(shown.max())))
    logarithmic_y(tails, (1.25 * LEAST, 2.0 * highest))


def panel_title(case: TunedCase) -> str:
    """Target, both rms with the interval of the simulated one, stalls if there are any."""
    found = case.statistics
    lines = [
        f"target {case.target_speed_m_s:g} m/s",
        f"predicted rms {case.table.predicted.rms_m_s:.4f} m/s",
        f"simulated {found.rms_text}",
    ]
    if found.stalled:
        lines[0] += f" · {found.stalled:.2%} of the passes stopped"
    return "\n".join(lines)


def bench_cuts(errors_m_s: Sequence[float], by_table_m_s: Sequence[float]) -> Figure:
    """Errors of n cuts, in the order in which they came."""
    figure = new_figure(8.0, 3.4, "Exit errors on the bench")
    place(figure, left=0.85, right=0.2, bottom=0.95, top=0.5)
    axes = figure.subplots()
    counts = range(1, len(errors_m_s) + 1)
    axes.axhline(0.0, color=INK, linewidth=0.6)
    axes.plot(counts, errors_m_s, color=BLUE, marker="o", markersize=4, linestyle="", label="the controller")
    axes.plot(counts, by_table_m_s, color=INK, marker="x", markersize=7, linestyle="", label="the table, simulated")
    dress(axes, "", "cut", "exit speed − target, m/s")
    legend_below(figure, axes.get_legend_handles_labels()[0], columns=2)
    return figure
