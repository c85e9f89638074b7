"""The nominal pass of a table by python-control and by the simulator, one over the other, and what lies between."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from synth.frame.picture.house_style import BLUE, GREY, INK, VERMILLION, dress, legend_below, new_figure, place
from synth.retarder.control_loop import TOLERANCE_M_S, ControlLoop
from synth.retarder.passage_control_loop import PassageControlLoop
from synth.retarder.pictures.table_picture import subject

TIME = "time since the regulator took over, s"


def loop_response(loop: ControlLoop) -> Figure:
    """Speed over path, the difference of speed, overpressure and stage over time."""
    figure = new_figure(11.5, 6.2, "Nominal response: python-control and the simulator", subject(loop.table))
    place(figure, left=0.65, right=0.2, bottom=0.95, top=0.85, w=0.17, h=0.42)
    grid = figure.subplots(2, 2)
    draw_speed(grid[0, 0], loop)
    draw_difference(grid[0, 1], loop)
    draw_pressure(grid[1, 0], loop)
    draw_stage(grid[1, 1], loop)
    last_s = float(max(loop.response.time_s[-1], loop.trace.time_s[-1]))
    for axes in (grid[0, 1], grid[1, 0], grid[1, 1]):
        axes.set_xlim(0.0, last_s)
    handles = [
        Line2D([], [], color=BLUE, linewidth=3.0, alpha=0.45, label="python-control"),
        Line2D([], [], color=VERMILLION, linewidth=1.2, linestyle="--", label="the simulator"),
        Line2D([], [], color=INK, linewidth=1.0, linestyle=(0, (4, 3)), label="commanded exit speed"),
    ]
    if isinstance(loop, PassageControlLoop):
        handles.append(Line2D([], [], color=INK, linestyle="", marker="o", markersize=4.5, label="read at a passage"))
    legend_below(figure, handles, columns=len(handles))
    return figure


def draw_speed(axes: Axes, loop: ControlLoop) -> None:
    """Speed in m/s over path in m, with the exit speeds in the title."""
    response, trace, target = loop.response, loop.trace, loop.table.target_speed_m_s
    axes.plot(response.path_m, response.speed_m_s, color=BLUE, linewidth=3.0, alpha=0.45)
    axes.plot(trace.path_m, trace.speed_m_s, color=VERMILLION, linewidth=1.2, linestyle="--")
    axes.axhline(target, color=INK, linewidth=1.0, linestyle=(0, (4, 3)), zorder=1)
    if isinstance(loop, PassageControlLoop):
        read = loop.trace.readings
        places = np.interp(read.middle_s, trace.time_s, trace.path_m)
        axes.plot(places, read.reading_m_s, color=INK, linestyle="", marker="o", markersize=4.5, zorder=5)
    title = f"leaves with {response.exit_speed_m_s:.4f} and {trace.exit_speed_m_s:.4f} m/s, commanded {target:g}"
    dress(axes, title, "path of the first axle, m", "speed, m/s")
    axes.set(xlim=(loop.plant.start_m, loop.plant.exit_m), ylim=(0.0, None))


def draw_difference(axes: Axes, loop: ControlLoop) -> None:
    """python-control less simulator in mm/s, at the events of the simulator."""
    found, time = loop.difference, loop.trace.time_s
    speed = np.interp(time, loop.response.time_s, loop.response.speed_m_s)
    within = time <= loop.response.time_s[-1]
    axes.plot(time[within], 1e3 * (speed - loop.trace.speed_m_s)[within], color=INK, linewidth=1.2, marker=".")
    decided, border = ("passage", "switching speed") if isinstance(loop, PassageControlLoop) else ("sample", "line")
    if found.parted_s is not None:
        axes.axvline(found.parted_s, color=GREY, linewidth=1.0, linestyle=":")
        parted = f"the commands part at {found.parted_s:.2f} s: a {decided} on a {border}"
    else:
        parted = f"same commands at the same {decided}s"
    dress(axes, f"at most {1e3 * abs(found.largest_m_s):.3f} mm/s; {parted}", TIME, "difference of speed, mm/s")
    reach = 1e3 * max(TOLERANCE_M_S, abs(found.largest_m_s)) * 1.1
    axes.axhline(0.0, color=GREY, linewidth=0.8, zorder=1)
    axes.set_ylim(-reach, reach)


def draw_pressure(axes: Axes, loop: ControlLoop) -> None:
    """Pressure above the touch of the pads over time: integrated by one, played in steps by the other."""
    touch_kpa = loop.plant.position.force.touch_pressure_kpa
    over = np.maximum(0.0, loop.response.pressure_kpa - touch_kpa)
    axes.plot(loop.response.time_s, over, color=BLUE, linewidth=3.0, alpha=0.45)
    axes.step(
        loop.trace.time_s, loop.trace.overpressure_kpa, where="post", color=VERMILLION, linewidth=1.2, linestyle="--"
    )
    dress(axes, "", TIME, "pressure above touch, kPa")
    axes.set_ylim(0.0, None)


def draw_stage(axes: Axes, loop: ControlLoop) -> None:
    """Commanded stage over time."""
    axes.step(loop.response.time_s, loop.response.stage, where="post", color=BLUE, linewidth=3.0, alpha=0.45)
    axes.step(loop.trace.time_s, loop.trace.stage, where="post", color=VERMILLION, linewidth=1.2, linestyle="--")
    dress(axes, "", TIME, "commanded stage")
    axes.set(yticks=range(loop.stages), ylim=(-0.2, loop.stages - 0.8))
