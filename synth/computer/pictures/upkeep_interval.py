"""Availability and loss of a year over the interval between checks, with its best length."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from synth.computer.pictures.pay_back_over_traffic import THOUSAND
from synth.computer.reliability.duplex import single_availability
from synth.computer.reliability.failure_losses import HOURS_PER_YEAR
from synth.computer.resolved_computer import ResolvedComputer
from synth.frame.picture.house_style import (
    BLUE,
    GREY,
    VERMILLION,
    dress,
    legend_below,
    logarithmic_x,
    logarithmic_y,
    new_figure,
    place,
)

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
