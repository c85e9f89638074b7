"""The picture of the study `criteria`: a column a case."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from synth.frame.picture.house_style import (
    LINE_COLOURS,
    LINE_MARKERS,
    dress,
    legend_below,
    logarithmic_y,
    new_figure,
    place,
)

if TYPE_CHECKING:
    from scripts.studies.criteria.findings import Criteria


def picture(found: Criteria) -> Figure:
    """Above: rms over switchings by tolerance; below: exit-speed errors by criterion, logarithmically."""
    cases = list(dict.fromkeys(row.case for row in found.criteria))
    prices = ", ".join(f"{t:g}" for t in dict.fromkeys(row.tolerance_m2_s2 for row in found.prices))
    subject = f"above: one point a switching tolerance, from the right {prices} m2/s2, bars 95 % intervals"
    figure = new_figure(3.9 * len(cases) + 0.7, 7.4, "Price on switchings, and exit-speed error by criterion", subject)
    place(figure, left=0.75, right=0.2, bottom=1.05, top=0.95, w=0.22, h=0.3)
    panels = figure.subplots(2, len(cases), squeeze=False)
    handles: list[Line2D] = []
    for column, case in enumerate(cases):
        dress(panels[0, column], case, "switchings a pass", "simulated rms, mm/s" if column == 0 else "")
        dress(panels[1, column], "", "exit speed − target, m/s", "density, 1/(m/s)" if column == 0 else "")
        draw_prices(panels[0, column], found, case)
        handles = draw_errors(panels[1, column], found, case)
    legend_below(figure, handles, columns=len(handles))
    return figure


def draw_prices(axes: Axes, found: Criteria, case: str) -> None:
    """rms over switchings."""
    points = [row.figures for row in found.prices if row.case == case]
    y = np.array([1e3 * each.rms_m_s for each in points])
    ends = np.array([[1e3 * end for end in each.rms_ci95_m_s] for each in points])
    axes.errorbar([each.switchings for each in points], y, np.abs(ends - y[:, None]).T, color=LINE_COLOURS[0],
                  marker="o", capsize=3)  # fmt: skip


def draw_errors(axes: Axes, found: Criteria, case: str) -> list[Line2D]:
    """Densities of the error, the default broad and pale."""
    rows = [row for row in found.criteria if row.case == case]
    edges = np.array(found.bins_m_s)
    middle = 0.5 * (edges[1:] + edges[:-1])
    handles = []
    for i, row in enumerate(rows):
        density = np.array(row.density)
        (line,) = axes.plot(
            middle, np.where(density > 0.0, density, np.nan), label=row.criterion, color=LINE_COLOURS[i],
            marker=LINE_MARKERS[i], markersize=3, linewidth=1.2 if i else 5.0, alpha=1.0 if i else 0.35,
        )  # fmt: skip
        handles.append(line)
    logarithmic_y(axes, [value for row in rows for value in row.density if value > 0.0])
    return handles


def figures(found: Criteria) -> Mapping[str, Figure]:
    """Price on switchings, and error by criterion, a column a case."""
    return {"": picture(found)}
