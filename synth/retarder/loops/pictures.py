"""Pictures of a table's loop: the nominal pass by python-control and by the simulator, one over the other, and what
lies between; the phase portrait, speed over path, with the table's lines; and the predicted limit cycle, its speed over
time and python-control's describing function.
"""

from __future__ import annotations

import math
import warnings
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from plant_models.frozen_arrays import Floats
from synth.frame.picture.house_style import BLUE, GREEN, GREY, INK, VERMILLION, dress, legend_below, new_figure, place
from synth.retarder.comparison.limit_cycle import Hunting, LimitCycle, cycle_wave
from synth.retarder.loops.control_loop import (
    LINE_NODES,
    TOLERANCE_M_S,
    ControlLoop,
    LineControlLoop,
    PassageControlLoop,
)
from synth.retarder.pictures.stage_panels import colour_of, finite
from synth.retarder.pictures.table_picture import stages_in_use, subject
from synth.simulation.nominal_response import NominalResponse
from synth.solver.tabulate import lines_of

if TYPE_CHECKING:
    from control import DescribingFunctionResponse

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


SHADE = "#f3f1e7"

NEAR_M_S = 0.35
"""Half the height of the enlarged part."""


def loop_portrait(loop: LineControlLoop) -> Figure:
    """The whole pass on the left, its end around the commanded speed enlarged on the right."""
    title = "Phase portrait of the nominal loop, by python-control"
    figure = new_figure(13.0, 6.4, title, subject(loop.table))
    place(figure, left=0.65, right=0.2, bottom=1.2, top=0.85, w=0.13)
    whole, near = figure.subplots(1, 2)
    target, ends_m = loop.table.target_speed_m_s, (loop.plant.start_m, loop.plant.exit_m)
    for axes in (whole, near):
        draw(axes, loop)
    speeds = np.concatenate([response.speed_m_s for response in loop.portrait])
    lowest, highest = min(float(speeds.min()), target - 0.8), float(speeds.max())
    dress(whole, f"{len(loop.portrait)} passes of mean friction", "path of the first axle, m", "speed, m/s")
    whole.set(xlim=ends_m, ylim=(max(0.0, lowest - 0.2), highest + 0.3))
    dress(near, "the same, around the commanded speed", "path of the first axle, m", "speed, m/s")
    near.set(xlim=ends_m, ylim=(target - NEAR_M_S, target + NEAR_M_S))
    legend_below(figure, entries(loop), columns=5)
    return figure


def draw(axes: Axes, loop: LineControlLoop) -> None:
    """Lines, passes coloured by the commanded stage, zones, and where two stages can hunt."""
    path = np.linspace(*loop.table.valid.s_m, LINE_NODES)
    lines = lines_of(loop.table, path)
    for stage in range(stages_in_use(loop.table)):
        colour = colour_of(stage)
        axes.plot(path, finite(lines.upper_m_s[stage]), "-", color=colour, linewidth=0.9, zorder=3)
        axes.plot(path, finite(lines.lower_m_s[stage]), "--", color=colour, linewidth=0.9, zorder=3)
    for response in loop.portrait:
        for stage in range(len(loop.table.stages)):
            axes.plot(*while_in(response, stage), color=colour_of(stage), linewidth=2.0, alpha=0.75, zorder=4)
    for hunting in loop.hunting:
        axes.axvspan(hunting.from_m, hunting.to_m, color=SHADE, linewidth=0, zorder=0)
    axes.axhline(loop.table.target_speed_m_s, color=INK, linewidth=1.0, linestyle=(0, (4, 3)), zorder=2)
    bars = [(start, end - start) for start, end in loop.table.retarder.zones_m]
    axes.broken_barh(bars, (0.0, 0.02), transform=axes.get_xaxis_transform(), facecolor=INK, zorder=5)


def while_in(response: NominalResponse, stage: int) -> tuple[Floats, Floats]:
    """Path and speed of a response, NaN where `stage` is not commanded."""
    inside = response.stage == stage
    inside[:-1] |= inside[1:]  # up to the point where the next stage is commanded
    return response.path_m, np.where(inside, response.speed_m_s, np.nan)


def entries(loop: LineControlLoop) -> list[Line2D | Patch]:
    """What colours and strokes mean."""
    shown: list[Line2D | Patch] = [
        Line2D([], [], color=colour_of(stage.k), linewidth=2.0, label=f"stage {stage.k}: {stage.pressure_kpa:g} kPa")
        for stage in loop.table.stages[: stages_in_use(loop.table)]
    ]
    shown += [
        Line2D([], [], color=INK, linewidth=0.9, label="line of a stage: one up above it"),
        Line2D([], [], color=INK, linewidth=0.9, linestyle="--", label="line of a stage: one down below it"),
        Line2D([], [], color=INK, linewidth=1.0, linestyle=(0, (4, 3)), label="commanded exit speed"),
        Patch(facecolor=INK, label="retarder zones"),
    ]
    pairs = sorted({(each.cycle.lower_stage, each.cycle.lower_stage + 1) for each in loop.hunting})
    if pairs:
        told = " and ".join(f"{low} – {high}" for low, high in pairs)
        shown.append(Patch(facecolor=SHADE, edgecolor=GREY, label=f"stages {told} can hunt here"))
    return shown


PERIODS = 2

CRUDE_FROM = 2.0
"""Ratio of slopes from which the first harmonic is called crude: at 2.5 amplitude and period were 40 and 22 % off."""


def loop_cycle(loop: LineControlLoop, hunting: Hunting) -> Figure:
    """The cycle of `hunting`: closed form and first harmonic over time; relay and loop in the complex plane."""
    cycle = hunting.cycle
    where = (
        f"stages {cycle.lower_stage} and {cycle.lower_stage + 1} from {hunting.from_m:.1f} to {hunting.to_m:.1f} m, "
        f"{hunting.periods:.1f} periods"
    )
    figure = new_figure(12.0, 5.6, "Predicted limit cycle", f"{subject(loop.table)} · {where}")
    place(figure, left=0.75, right=0.25, bottom=1.1, top=0.9, w=0.2)
    balances = math.isfinite(cycle.harmonic_period_s)
    panels = figure.subplots(1, 2 if balances else 1, width_ratios=(1.35, 1.0) if balances else None, squeeze=False)[0]
    draw_wave(panels[0], loop, cycle)
    handles = [
        Line2D([], [], color=BLUE, linewidth=2.0, label="closed form, mean friction"),
        Line2D([], [], color=INK, linewidth=1.0, linestyle=":", label="the two lines"),
    ]
    if balances:
        draw_plane(panels[1], cycle)
        handles += [
            Line2D([], [], color=GREEN, linewidth=1.4, linestyle="--", label=harmonic_label(cycle)),
            Line2D([], [], color=GREY, linewidth=1.6, label="loop L(jω): dead time and integrator"),
            Line2D([], [], color=VERMILLION, linewidth=1.6, label="−1/N(A) of the relay"),
        ]
    else:
        label = "first harmonic: none, as the lines lie the wrong way round and the lock alone sets the period"
        handles.append(Line2D([], [], color=GREEN, linewidth=1.4, linestyle="--", label=label))
    legend_below(figure, handles, columns=len(handles))
    return figure


def harmonic_label(cycle: LimitCycle) -> str:
    """What the first harmonic is, and whether much can be expected of it."""
    flatter, steeper = sorted((cycle.rise_m_s2, cycle.fall_m_s2))
    ratio = steeper / flatter
    word = "first harmonic: crude, as the slopes are" if ratio > CRUDE_FROM else "first harmonic, slopes"
    return f"{word} 1 : {ratio:.1f}"


def draw_wave(axes: Axes, loop: LineControlLoop, cycle: LimitCycle) -> None:
    """Speed above the middle of the lines in cm/s over time."""
    wave = cycle_wave(loop.plant, cycle)
    time = np.concatenate([wave.time_s + i * cycle.period_s for i in range(PERIODS)])
    axes.plot(time, 100.0 * np.tile(wave.speed_m_s, PERIODS), color=BLUE, linewidth=2.0)
    if math.isfinite(cycle.harmonic_period_s):
        even = np.linspace(0.0, PERIODS * cycle.period_s, 400)
        top = float(wave.time_s[np.argmax(wave.speed_m_s)])
        harmonic = np.cos(2.0 * math.pi * (even - top) / cycle.harmonic_period_s)
        axes.plot(even, 100.0 * cycle.harmonic_amplitude_m_s * harmonic, "--", color=GREEN, linewidth=1.4)
    for side in (-0.5, 0.5):
        axes.axhline(100.0 * side * cycle.gap_m_s, color=INK, linewidth=1.0, linestyle=":")
    title = f"closed form ±{100.0 * cycle.amplitude_m_s:.1f} cm/s in {cycle.period_s:.2f} s; sampled exactly "
    title += f"±{100.0 * cycle.sampled_amplitude_m_s:.1f} cm/s at most, {cycle.sampled_period_s:.2f} s"
    dress(axes, title, "time, s", "speed above the middle of the two lines, cm/s")
    axes.set_xlim(0.0, PERIODS * cycle.period_s)


def draw_plane(axes: Axes, cycle: LimitCycle) -> None:
    """Where loop and relay balance in the complex plane, as python-control finds it."""
    found = describing_function_analysis(cycle)
    curve = found.response.response
    axes.plot(curve.real, curve.imag, color=GREY, linewidth=1.6)
    axes.plot(found.N_vals.real, found.N_vals.imag, color=VERMILLION, linewidth=1.6)
    title = "python-control: no balance of equal slopes"
    if found.intersections:
        amplitude, omega = found.intersections[0]
        at = found.positions[0]
        axes.plot([at.real], [at.imag], "o", color=INK, markersize=6)
        title = f"python-control, with equal slopes: ±{100.0 * amplitude:.1f} cm/s in {2.0 * math.pi / omega:.2f} s"
    dress(axes, title, "real part", "imaginary part")


def describing_function_analysis(cycle: LimitCycle) -> DescribingFunctionResponse:
    """python-control's own analysis, to plot: relay with hysteresis, exact dead time, integrator.

    It knows one amplitude and one delay: both stages count as (rise + fall)/2 and both changes as delayed by
    the mean. The dead time is exact because the loop is given as frequency response data.
    """
    import control

    height, edge = 0.5 * (cycle.rise_m_s2 + cycle.fall_m_s2), 0.5 * max(0.0, cycle.gap_m_s)
    delay = 0.5 * (cycle.brake_delay_s + cycle.release_delay_s)
    fastest = 0.5 * math.pi / delay
    slowest = 0.5 * math.pi / (delay + edge * math.pi**2 / (8.0 * height))  # as arccos lies above its chord
    omega = np.linspace(0.9 * slowest, 1.1 * fastest, 400)
    loop = control.frd(np.exp(-1j * omega * delay) / (1j * omega), omega, smooth=True)
    largest = 4.0 * height / (math.pi * omega[0])
    amplitudes = np.linspace(max(1.0001 * edge, 0.1 * largest), 1.1 * largest, 80)
    relay = control.relay_hysteresis_nonlinearity(height, edge)
    with warnings.catch_warnings():
        # Where its search for more digits fails, the crossing on this fine a grid stands.
        warnings.filterwarnings("ignore", "not able to refine result", UserWarning)
        return control.describing_function_response(loop, relay, amplitudes, omega=omega)
