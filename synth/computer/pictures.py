"""Pictures of a control computer: waits, the interval between checks, the pay-back over the traffic, and what
uncertain inputs move.
"""

from __future__ import annotations

import math

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from plant_models.errors import PlantError
from synth.computer.asked import ComputerModel
from synth.computer.economics.monte_carlo import QUANTILES, drawn
from synth.computer.economics.ranges import Constant
from synth.computer.economics.sensitivity import Tornado
from synth.computer.reliability.four_states import HOURS_PER_YEAR
from synth.computer.reliability.maintenance import single_availability
from synth.computer.resolved_computer import ResolvedComputer
from synth.computer.sizing.service import mean_waits
from synth.computer.sizing.waiting_tail import start_tail
from synth.frame.picture.house_style import (
    BLUE,
    GREY,
    INK,
    LINE_COLOURS,
    LINE_STYLES,
    ORANGE,
    SKY,
    VERMILLION,
    dress,
    legend_below,
    logarithmic_x,
    logarithmic_y,
    new_figure,
    place,
)

__all__ = ["pay_back_over_traffic", "tornado_bars", "upkeep_interval", "waits"]


TRAFFIC = "traffic.cars_per_day"
SHARES = np.linspace(0.4, 1.6, 13)
DRAWS = 400
THOUSAND = 1000.0
OUTPUTS = ("net_present_value", "pay_back_rate_per_year")
MOST_IMPOSSIBLE = 0.05
"""Share of overloaded draws from which on the others no longer tell what to expect."""


def pay_back_over_traffic(config: ResolvedComputer) -> Figure:
    """Net present value, and the reciprocal of the pay-back time: a time that never comes has no place on an axis."""
    cars, bands = bands_over_traffic(config)
    figure = new_figure(
        11.0, 4.8, "What it pays, over the traffic", f"{DRAWS} draws of the uncertain inputs at each number of cars"
    )
    place(figure, left=0.95, right=0.3, bottom=0.85, top=0.9, w=0.26)
    panels = figure.subplots(1, 2)
    titles = (
        (f"Net present value, {config.case.terms.years} years", f"thousand {config.case.prices.currency}"),
        ("1/pay-back time; below 0 it never pays back", "1/year"),
    )
    for axes, band, (title, unit) in zip(panels, (bands[0] / THOUSAND, bands[1]), titles, strict=True):
        dress(axes, title, "cars humped a day", unit)
        axes.fill_between(cars, band[0], band[2], color=SKY, alpha=0.45, linewidth=0.0, zorder=2)
        axes.plot(cars, band[1], color=BLUE, linewidth=1.6, marker="o", markersize=3.0, zorder=3)
        axes.axhline(0.0, color=INK, linewidth=0.8)
        axes.axvline(config.case.traffic.cars_per_day, color=GREY, linewidth=1.0)
    handles = [
        Line2D([], [], color=BLUE, marker="o", markersize=3.0, linewidth=1.6, label="median"),
        Patch(facecolor=SKY, alpha=0.45, label="5 to 95 % of the draws that are possible"),
        Line2D([], [], color=GREY, label=f"configured: {config.case.traffic.cars_per_day:g} cars a day"),
    ]
    legend_below(figure, handles, columns=3)
    return figure


def bands_over_traffic(config: ResolvedComputer) -> tuple[np.ndarray, np.ndarray]:
    """Cars a day (n,) that can be humped, and quantiles (outputs, quantiles, n)."""
    model, found, possible = ComputerModel(config.case, config.settings.reliability), [], []
    for cars in config.case.traffic.cars_per_day * SHARES:
        ranges = {**config.ranges, TRAFFIC: Constant(float(cars))}
        try:
            draws = drawn(model.figures, ranges, DRAWS, config.settings.uncertainty.seed)
        except PlantError:  # no draw can be humped
            continue
        if draws.impossible.value > MOST_IMPOSSIBLE:
            continue
        values = [draws.found[name][~np.isnan(draws.found[name])] for name in OUTPUTS]
        found.append([np.quantile(each[np.isfinite(each)], QUANTILES) for each in values])
        possible.append(cars)
    return np.array(possible), np.moveaxis(np.array(found).reshape(-1, len(OUTPUTS), len(QUANTILES)), 0, -1)


MOST_BARS = 14


def tornado_bars(found: Tornado, currency: str) -> Figure:
    """A bar an input from its 5 % to its 95 % quantile, widest on top; ends that are impossible are left open."""
    bars = [bar for bar in found.bars if not math.isnan(bar.swing)][:MOST_BARS]
    left_out = len(found.bars) - len(bars)
    figure = new_figure(
        10.0, 1.9 + 0.34 * max(len(bars), 1), "Which input moves the net present value",
        f"{len(bars)} inputs, each alone, all others at their medians"
        + (f"; {left_out} more are left out" if left_out else ""),
    )  # fmt: skip
    place(figure, left=2.9, right=0.4, bottom=0.95, top=0.8)
    axes = figure.subplots()
    dress(axes, "", f"net present value, thousand {currency}", "")
    middle = found.at_medians / THOUSAND
    for row, bar in enumerate(reversed(bars)):
        for end, colour in ((bar.at_low, ORANGE), (bar.at_high, BLUE)):
            axes.barh(row, end / THOUSAND - middle, left=middle, color=colour, height=0.62, zorder=3)
    axes.set_yticks(range(len(bars)), [bar.input for bar in reversed(bars)], fontsize=8)
    axes.axvline(middle, color=INK, linewidth=0.8, zorder=4)
    axes.grid(False, axis="y")
    handles = [
        Patch(facecolor=ORANGE, label="input at its 5 % quantile"),
        Patch(facecolor=BLUE, label="at its 95 % quantile"),
    ]
    legend_below(figure, handles, columns=2)
    return figure


INTERVALS = 200


def upkeep_interval(config: ResolvedComputer) -> Figure:
    """One computer and two, without failures of a common cause; checks at even times."""
    upkeep, currency = config.settings.reliability, config.case.prices.currency
    shortest = max(upkeep.check_h * 1.5, 1e-3 * upkeep.check_interval_h)
    x = np.geomspace(shortest, max(30.0 * upkeep.check_interval_h, 100.0 * shortest), INTERVALS)
    single = single_availability(upkeep.failure_per_h, upkeep.check_h, x)
    double = upkeep.duplex.availability(x)
    figure = new_figure(
        11.0, 4.8, "Checks of the control computer",
        f"failures {upkeep.failure_per_h:g} an hour, a check takes {upkeep.check_h:g} h; no common causes",
    )  # fmt: skip
    place(figure, left=0.8, right=0.3, bottom=0.85, top=0.9, w=0.26)
    of_share, of_loss = figure.subplots(1, 2)
    dress(of_share, "Share of time without a ready computer", "interval between checks, h", "1 − availability")
    dress(of_loss, "Loss of a year", "interval between checks, h", f"thousand {currency}")
    for axes, one, two in (
        (of_share, 1.0 - single, 1.0 - double),
        (of_loss, single_loss(config, x), HOURS_PER_YEAR * (1.0 - double) * upkeep.unnoticed_per_h / THOUSAND),
    ):
        axes.plot(x, one, color=VERMILLION, linestyle="-", linewidth=1.6)
        axes.plot(x, two, color=BLUE, linestyle="--", linewidth=1.6)
        axes.axvline(upkeep.check_interval_h, color=GREY, linewidth=1.0)
        logarithmic_x(axes, x)
        logarithmic_y(axes, [*one, *two])
    handles = [
        Line2D([], [], color=VERMILLION, linewidth=1.6, label="one computer"),
        Line2D([], [], color=BLUE, linestyle="--", linewidth=1.6, label="two, checked one after the other"),
        Line2D([], [], color=GREY, linewidth=1.0, label=f"configured: {upkeep.check_interval_h:g} h"),
    ]
    best = None if upkeep.checked is None else upkeep.checked.best_calendar_h
    if best is not None and x[0] <= best <= x[-1]:
        least = float(single_loss(config, np.array([best]))[0])
        of_loss.plot([best], [least], "o", color=VERMILLION, markersize=6)
        handles.append(
            Line2D([], [], color=VERMILLION, marker="o", linestyle="", label=f"least loss of one: {best:.3g} h")
        )
    legend_below(figure, handles, columns=4)
    return figure


def single_loss(config: ResolvedComputer, interval_h: np.ndarray) -> np.ndarray:
    """A year of one computer that is checked at even times, in thousands."""
    checked = config.settings.reliability.checked
    return (
        np.full_like(interval_h, np.nan)
        if checked is None
        else np.asarray(checked.loss_per_year(interval_h)) / THOUSAND
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
