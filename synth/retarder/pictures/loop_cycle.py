"""The limit cycle predicted for a table's loop: the speed over time, and python-control's describing function."""

from __future__ import annotations

import math
import warnings
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from synth.frame.picture.house_style import BLUE, GREEN, GREY, INK, VERMILLION, dress, legend_below, new_figure, place
from synth.retarder.comparison.limit_cycle import Hunting, LimitCycle, cycle_wave
from synth.retarder.line_control_loop import LineControlLoop
from synth.retarder.pictures.table_picture import subject

if TYPE_CHECKING:
    from control import DescribingFunctionResponse


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
