"""Pictures of a plan of point sensors: rms over their number, where they stand, and the best command there."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from plant_models.point_sensors import deciding_passages
from synth.frame.picture.house_style import (
    BLUE,
    ENTRANCE_STYLE,
    GREEN,
    GREY,
    INK,
    ORANGE,
    VERMILLION,
    dress,
    legend_below,
    logarithmic_y,
    mark_zones,
    new_figure,
    place,
)
from synth.retarder.pictures.stage_panels import DOWN, HATCH, HOLD, UP, command_image, label_panels, stage_panels
from synth.retarder.sensors.layout_results import LayoutResults
from synth.retarder.sensors.layout_tables import LayoutTable
from synth.solver.backward_induction import PolicyMap


def shown_plan(results: LayoutResults) -> Figure:
    """The chosen plan, else that of most sensors, over the best command of its first case."""
    table = results.shown.tables[0]
    subject = f"{results.asked.labels[0]} to {table.aim.target_speed_m_s:g} m/s, {results.shown.deciding + 1} sensors"
    return plan_map(subject, results.anywhere, table)


def rms_over_number(results: LayoutResults) -> Figure:
    """Planned layouts with their 95 % intervals, the rule, and the radar as a level line."""
    figure = new_figure(8.4, 4.6, "What sensors and places give", subject_of(results))
    place(figure, left=0.8, right=0.3, bottom=1.15, top=0.85)
    axes = figure.subplots()
    dress(axes, "", "sensors, the one behind the exit included", "rms, m/s")
    numbers = [plan.deciding + 1 for plan in results.plans]
    planned = [plan.errors.rms for plan in results.plans]
    rule, radar = results.rule.errors.rms, results.radar.rms
    at_rule = results.rule.deciding + 1
    values = [each.value for each in planned]
    axes.vlines(numbers, [each.low95 for each in planned], [each.high95 for each in planned], color=BLUE, linewidth=1.5)
    axes.vlines([at_rule], [rule.low95], [rule.high95], color=GREEN, linewidth=1.5)
    axes.plot(numbers, values, color=BLUE, marker="o", markersize=5, linewidth=1.5)
    axes.plot(at_rule, rule.value, color=GREEN, marker="D", markersize=7, linestyle="none")
    axes.axhline(radar.value, color=INK, linestyle=":", linewidth=1.3)
    logarithmic_y(axes, [*values, rule.value, radar.value])
    axes.set_xticks(sorted({*numbers, at_rule}))
    handles = [
        Line2D([], [], color=BLUE, marker="o", label="planned"),
        Line2D([], [], color=GREEN, marker="D", linestyle="none", label="by the rule"),
        Line2D([], [], color=INK, linestyle=":", label="radar"),
    ]
    if results.chosen is not None:
        at = results.chosen.deciding + 1, results.chosen.errors.rms.value
        axes.plot(*at, color=ORANGE, marker="o", markersize=13, markerfacecolor="none", linestyle="none")
        handles.append(Line2D([], [], color=ORANGE, marker="o", markersize=10, markerfacecolor="none",
                              linestyle="none", label="chosen"))  # fmt: skip
    legend_below(figure, handles, columns=4)
    return figure


def places_by_number(results: LayoutResults) -> Figure:
    """A row of marks for each number of sensors."""
    rows = [(str(plan.deciding + 1), plan, BLUE) for plan in results.plans]
    rows.append((f"{results.rule.deciding + 1}, by the rule", results.rule, GREEN))
    figure = new_figure(9.6, 1.9 + 0.3 * len(rows), "Where the sensors stand", subject_of(results))
    place(figure, left=1.25, right=0.3, bottom=0.95, top=0.85)
    axes = figure.subplots()
    dress(axes, "", "path from the entrance of the first retarder, m", "sensors")
    position = results.asked.problem.cases[0].plant.position
    for start, end in position.zones_m:
        axes.axvspan(start, end, color=GREY, alpha=0.18, linewidth=0)
    axes.axvline(0.0, color=INK, linewidth=0.8, linestyle=ENTRANCE_STYLE)
    for row, (_, layout, colour) in enumerate(rows):
        *deciding, last = results.places_of(layout)
        axes.plot(deciding, [row] * len(deciding), color=colour, marker="|", markersize=11, linestyle="none", mew=2)
        axes.plot([last], [row], color=GREY, marker="|", markersize=11, linestyle="none", mew=2)
    axes.set_yticks(range(len(rows)), [name for name, _, _ in rows])
    axes.set_ylim(len(rows) - 0.5, -0.5)
    handles = [
        Line2D([], [], color=BLUE, marker="|", markersize=11, mew=2, linestyle="none", label="decides"),
        Line2D([], [], color=GREY, marker="|", markersize=11, mew=2, linestyle="none", label="logs the exit"),
    ]
    legend_below(figure, handles, columns=2)
    return figure


def subject_of(results: LayoutResults) -> str:
    """The position, and for how many classes and targets."""
    position = results.asked.problem.cases[0].plant.position.name
    aims = sum(len(case.aims) for case in results.asked.problem.cases)
    classes = len(results.asked.problem.cases)
    return f"{position}; {classes} cut class{'es' * (classes > 1)}, {aims} table{'s' * (aims > 1)}"


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
