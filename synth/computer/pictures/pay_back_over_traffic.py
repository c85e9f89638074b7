"""Effect of a year over the traffic, with what uncertain inputs leave open."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from plant_models.errors import PlantError
from synth.computer.computer_model import ComputerModel
from synth.computer.economics.uncertainty.monte_carlo import drawn
from synth.computer.economics.uncertainty.ranges import Constant
from synth.computer.resolved_computer import ResolvedComputer
from synth.frame.picture.house_style import BLUE, GREY, INK, SKY, dress, legend_below, new_figure, place

TRAFFIC = "traffic.cars_per_day"
SHARES = np.linspace(0.4, 1.6, 13)
DRAWS = 400
THOUSAND = 1000.0
OUTPUTS = ("net_present_value", "pay_back_rate_per_year")
QUANTILES = (0.05, 0.5, 0.95)
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
