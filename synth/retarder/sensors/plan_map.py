"""A plan of point sensors over the map of the best command: where they stand in what a radar could have decided."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from plant_models.point_sensors import deciding_passages
from synth.frame.picture.house_style import BLUE, GREY, INK, VERMILLION, dress, mark_zones
from synth.retarder.command_panels import DOWN, HATCH, HOLD, UP, command_image, label_panels, stage_panels
from synth.retarder.policy_map import PolicyMap
from synth.retarder.sensors.layout_tables import LayoutTable

BELOW_TARGET_M_S, ABOVE_FASTEST_M_S = 1.0, 0.4


def plan_map(subject: str, policy: PolicyMap, table: LayoutTable) -> Figure:
    """A panel for each stage: colours for the command that a regulator would give that could decide anywhere, upright
    lines for the passages at which this one decides, marks for its switching speeds one stage up and down."""
    stages = table.plant.top_stage + 1
    figure, grid = stage_panels("Sensors over the best command", subject, stages)
    for stage in range(stages):
        draw_stage(grid.flat[stage], policy, table, stage)
    label_panels(grid, stages)
    box = grid.flat[stages].get_position()
    figure.legend(
        handles=legend_entries(), loc="center", bbox_to_anchor=(box.x0, box.y0, box.width, box.height), fontsize=9,
        frameon=False,
    )  # fmt: skip
    return figure


def draw_stage(axes: Axes, policy: PolicyMap, table: LayoutTable, stage: int) -> None:
    """One panel."""
    plant, switching = table.plant, table.speeds.switching_m_s
    ends_m = float(policy.path_m[0]), plant.exit_m
    low = max(0.0, table.aim.target_speed_m_s - BELOW_TARGET_M_S)
    high = plant.entry.high_m_s + ABOVE_FASTEST_M_S
    pixels = round(axes.bbox.width), round(axes.bbox.height)
    image = command_image(policy, stage, ends_m, (low, high), pixels)
    axes.imshow(image, extent=(*ends_m, low, high), origin="lower", aspect="auto", interpolation="none")
    path_m = np.array([each.path_m for each in deciding_passages(table.sensors, plant.cut, plant.exit_m)])
    axes.vlines(path_m, low, high, color=INK, linewidth=0.7, zorder=3)
    for parted, mark, colour in ((stage - 1, "v", BLUE), (stage, "^", VERMILLION)):
        if 0 <= parted < switching.shape[2]:
            speeds = switching[:, stage, parted]
            shown = np.isfinite(speeds)
            axes.plot(path_m[shown], speeds[shown], mark, color=colour, markersize=5, zorder=5)
    mark_zones(axes, plant.position.zones_m, plant.start_m)
    dress(axes, f"stage {stage} · {plant.position.stage_pressures_kpa[stage]:g} kPa")
    axes.grid(False)
    axes.set(xlim=ends_m, ylim=(low, high))


def legend_entries() -> list[Patch | Line2D]:
    """What colours, lines and marks mean."""
    return [
        Patch(facecolor=UP, edgecolor=GREY, label="best anywhere: up"),
        Patch(facecolor=HOLD, edgecolor=GREY, label="best anywhere: hold"),
        Patch(facecolor=DOWN, edgecolor=GREY, label="best anywhere: down"),
        Patch(facecolor="white", edgecolor=HATCH, hatch="////", label="indifferent: commands cost the same"),
        Line2D([], [], color=INK, linewidth=0.7, label="passage at which this plan decides"),
        Line2D([], [], color=VERMILLION, marker="^", linestyle="", markersize=6, label="one stage up above it"),
        Line2D([], [], color=BLUE, marker="v", linestyle="", markersize=6, label="one stage down below it"),
        Patch(facecolor=INK, label="retarder zones"),
    ]
