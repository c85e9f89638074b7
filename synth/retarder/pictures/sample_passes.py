"""A few passes of a table: speed over path, pressure and stage over time."""

from __future__ import annotations

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from synth.frame.picture.house_style import (
    GREY,
    INK,
    LINE_COLOURS,
    LINE_STYLES,
    dress,
    legend_below,
    mark_zones,
    new_figure,
    place,
)
from synth.retarder.case_result import CaseResult
from synth.simulation.passes import TRACE_FACTORS, PassTrace


def sample_passes(case: CaseResult) -> Figure:
    """Speed in m/s over path in m on the left; pressure above the pads' touch in kPa and stage over time on the right.

    The legend gives each pass its friction factor ξ_cut and the speed it left with.
    """
    figure = new_figure(11.0, 5.2, "Sample passes", f"{case.cut_name}, {case.target_name}")
    place(figure, left=0.65, right=0.2, bottom=0.95, top=0.85, w=0.17, h=0.24)
    grid = figure.add_gridspec(2, 2, width_ratios=(1.15, 1.0))
    speed, pressure, stage = (figure.add_subplot(grid[part]) for part in ((slice(None), 0), (0, 1), (1, 1)))
    handles: list[Line2D] = []
    for trace, factor, colour, style in zip(case.traces, TRACE_FACTORS, LINE_COLOURS, LINE_STYLES, strict=False):
        speed.plot(trace.path_m, trace.speed_m_s, color=colour, linestyle=style, linewidth=1.6)
        pressure.step(trace.time_s, trace.overpressure_kpa, where="post", color=colour, linestyle=style, linewidth=1.3)
        stage.step(trace.time_s, trace.stage, where="post", color=colour, linestyle=style, linewidth=1.3)
        label = f"friction factor {factor:.2f}: {outcome(trace)}"
        handles.append(Line2D([], [], color=colour, linestyle=style, linewidth=1.6, label=label))
    finish_speed(speed, case)
    dress(pressure, "pressure above the touch of the pads, kPa")
    dress(stage, "commanded stage", "time since the regulator took over, s")
    last_s = max((float(trace.time_s[-1]) for trace in case.traces), default=1.0)
    pressure.tick_params(labelbottom=False)
    pressure.set(xlim=(0.0, last_s), ylim=(0.0, None))
    stage.set(
        xlim=(0.0, last_s),
        yticks=range(case.study.solver_lines.stages),
        ylim=(-0.15, case.study.solver_lines.stages - 0.85),
    )
    legend_below(figure, handles, columns=len(handles) or 1)
    return figure


def finish_speed(axes: Axes, case: CaseResult) -> None:
    """Target, the place where the last axle has left the last zone, zones and labels of the speed panel."""
    axes.axhline(case.target_speed_m_s, color=INK, linewidth=1.0, linestyle=(0, (4, 3)), zorder=1)
    axes.annotate(
        case.target_name, (case.plant.start_m, case.target_speed_m_s), (4.0, -4.0), textcoords="offset points",
        va="top", fontsize=8.5,
    )  # fmt: skip
    mark_zones(axes, case.plant.position.zones_m, case.plant.start_m)
    last_end = case.plant.position.zones_m[-1][1]
    axes.annotate(
        "retarder zones", (last_end, 0.012), (4.0, 0.0), xycoords=("data", "axes fraction"),
        textcoords="offset points", va="center", fontsize=8, color=GREY,
    )  # fmt: skip
    dress(axes, "true speed, m/s", "path of the first axle, m")
    highest = max((float(trace.speed_m_s.max()) for trace in case.traces), default=case.plant.entry.high_m_s)
    axes.set(xlim=(case.plant.start_m, case.plant.exit_m), ylim=(0.0, 1.05 * highest))


def outcome(trace: PassTrace) -> str:
    """How a pass ended, in words."""
    return "stopped in the position" if trace.stalled else f"left at {trace.exit_speed_m_s:.2f} m/s"
