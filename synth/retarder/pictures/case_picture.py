"""One case in one picture: a run over path by the stage in force, and beside it how all simulated cuts leave."""

from __future__ import annotations

from typing import Final

from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import ConnectionPatch, Patch
from matplotlib.typing import LineStyleType

from synth.frame.picture.house_style import (
    GREY,
    INK,
    PALE_GREY,
    SKY,
    VERMILLION,
    dress,
    legend_below,
    mark_entrance,
    new_figure,
    place,
)
from synth.retarder.pictures.stage_colours import colour_of, ended
from synth.retarder.shown_case import NEAR_M_S, ShownCase, StagePart

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
