"""The picture of the study `accuracy-grid`: all cases by their rms."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from matplotlib.figure import Figure

from synth.present.plots.house_style import (
    BLUE,
    GREEN,
    GREY,
    INK,
    VERMILLION,
    dress,
    legend_below,
    logarithmic_y,
    new_figure,
    place,
)

if TYPE_CHECKING:
    from synth.studies.accuracy_grid.figures import Figures
    from synth.studies.accuracy_grid.findings import Grid

LIMIT_M_S = 0.1


def picture(figures: Sequence[Figures]) -> Figure:
    """Told, with estimator, table, best baseline."""
    rows = sorted(figures, key=lambda each: each.told.rms_m_s)
    subject = f"{len(rows)} cases, sorted by what is left when the friction is told; dashed: {LIMIT_M_S:g} m/s"
    figure = new_figure(11.0, 6.0, "Exit-speed error over the whole grid", subject)
    place(figure, left=0.8, right=0.2, bottom=1.0, top=0.9)
    axes = figure.subplots()
    dress(axes, y="rms of exit speed − target, m/s", x="case")
    every = (
        (GREY, "v", "best tuned baseline", [each.baselines[each.best_baseline].rms_m_s for each in rows]),
        (VERMILLION, "o", "cubic table", [each.table.rms_m_s for each in rows]),
        (BLUE, "D", "with estimator", [each.estimated.rms_m_s for each in rows]),
        (GREEN, "_", "told the friction of every cut", [each.told.rms_m_s for each in rows]),
    )
    handles = [
        axes.plot(range(len(rows)), values, marker, color=colour, markersize=5, linestyle="", label=label)[0]
        for colour, marker, label, values in every
    ]
    axes.axhline(LIMIT_M_S, color=INK, linewidth=1.0, linestyle="--")
    logarithmic_y(axes, [LIMIT_M_S, *(value for *_, values in every for value in values)])
    legend_below(figure, handles, len(handles))
    return figure


def figures(found: Grid) -> Mapping[str, Figure]:
    """All cases by their rms."""
    return {"": picture([figures for _, figures in found.known])}
