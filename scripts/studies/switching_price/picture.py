"""Picture: rms over switchings a pass, one curve for commands at rest and one for commands at any time."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from synth.frame.picture.house_style import LINE_COLOURS, LINE_MARKERS, dress, legend_below, new_figure, place

if TYPE_CHECKING:
    from scripts.studies.switching_price.study import SwitchingPrice


def figures(found: SwitchingPrice) -> Mapping[str, Figure]:
    """`curves`: a panel for each case."""
    count = len(found.curves)
    figure = new_figure(4.0 * count + 0.6, 4.2, "What fewer switchings cost", f"{found.passes} passes a table")
    place(figure, left=0.75, right=0.25, bottom=1.0, top=0.85, w=0.28)
    names = ("commands at rest", "commands at any time")
    for axes, curve in zip(figure.subplots(1, count, squeeze=False)[0], found.curves, strict=True):
        for i, points in enumerate((curve.at_rest, curve.at_any_time)):
            rms = [1e3 * point.rms_m_s for point in points]
            half = [500 * (point.rms_ci95_m_s[1] - point.rms_ci95_m_s[0]) for point in points]
            axes.errorbar([point.switchings for point in points], rms, yerr=half, color=LINE_COLOURS[i],
                          marker=LINE_MARKERS[i], markersize=5, capsize=2, linewidth=1.2)  # fmt: skip
        dress(axes, curve.case, "switchings a pass", "rms of the exit speed, mm/s")
        axes.set_ylim(bottom=0.0)
    handles = [
        Line2D([], [], color=LINE_COLOURS[i], marker=LINE_MARKERS[i], label=name) for i, name in enumerate(names)
    ]
    legend_below(figure, handles, columns=2)
    return {"curves": figure}
