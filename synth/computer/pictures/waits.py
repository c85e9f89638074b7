"""Wait over the speed of the processor, by task: its mean, and the chance of a long one."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from synth.computer.resolved_computer import ResolvedComputer
from synth.computer.sizing.demand_service import mean_waits
from synth.computer.sizing.waiting_tail import start_tail
from synth.frame.picture.house_style import (
    GREY,
    INK,
    LINE_COLOURS,
    LINE_STYLES,
    dress,
    legend_below,
    logarithmic_x,
    logarithmic_y,
    new_figure,
    place,
)

SPEEDS = 120
FASTEST = 30.0
"""Times the least speed that can serve all tasks."""

SHOWN_TASKS = 7
LEAST_SHARE = 1e-7


def waits(config: ResolvedComputer) -> Figure:
    """Two panels over the speed; the limits as level lines, the configured speed as an upright one."""
    service = config.settings.service
    least = config.mix.operations_per_s
    speeds = least * np.geomspace(1.05, max(FASTEST, 2.0 * service.speed_op_s / least), SPEEDS)
    streams = [config.mix.streams(float(speed)) for speed in speeds]
    tasks = config.mix.tasks[:SHOWN_TASKS]
    means = np.array([[each.start_s for each in mean_waits(of, service.discipline)] for of in streams])
    tails = np.array(
        [[start_tail(of, service.discipline, task.name, service.long_wait_s).value for task in tasks] for of in streams]
    )
    figure = new_figure(
        11.0, 4.8, "Wait for service over the speed of the processor", f"{service.discipline.said}; formulas"
    )
    place(figure, left=0.8, right=0.3, bottom=1.05, top=0.9, w=0.24)
    of_means, of_tails = figure.subplots(1, 2)
    dress(of_means, "Mean wait", "speed, op/s", "s")
    dress(of_tails, f"Chance of more than {service.long_wait_s:g} s", "speed, op/s", "share of requests")
    handles = []
    for k, task in enumerate(tasks):
        colour, style = LINE_COLOURS[k], LINE_STYLES[k]
        of_means.plot(speeds, means[:, k], color=colour, linestyle=style, linewidth=1.5)
        of_tails.plot(speeds, np.maximum(tails[:, k], LEAST_SHARE), color=colour, linestyle=style, linewidth=1.5)
        handles.append(Line2D([], [], color=colour, linestyle=style, linewidth=1.5, label=task.name))
    for axes, limit in ((of_means, service.mean_wait_s), (of_tails, service.long_wait_share)):
        mark(axes, limit, service.speed_op_s)
        logarithmic_x(axes, speeds)
    logarithmic_y(of_means, [*means.ravel(), service.mean_wait_s])
    logarithmic_y(of_tails, [1.0, service.long_wait_share, *np.maximum(tails.ravel(), LEAST_SHARE)])
    handles.append(Line2D([], [], color=INK, linestyle=":", label="allowed"))
    handles.append(Line2D([], [], color=GREY, linewidth=1.0, label=f"configured: {service.speed_op_s:,.0f} op/s"))
    legend_below(figure, handles, columns=3)
    return figure


def mark(axes: Axes, limit: float, speed_op_s: float) -> None:
    """The limit, and the speed of the configuration."""
    axes.axhline(limit, color=INK, linestyle=":", linewidth=1.3)
    axes.axvline(speed_op_s, color=GREY, linewidth=1.0)
