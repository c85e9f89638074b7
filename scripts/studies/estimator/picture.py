"""Ratios of the rms with and without estimator: a line a case, a mark for what is wrong."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure

from synth.frame.picture.house_style import BLACK, LINE_COLOURS, dress, new_figure, place

if TYPE_CHECKING:
    from scripts.studies.estimator.pair import Compared

MARKERS = "os^vD<>pXhPd"


def picture(title: str, cases: Mapping[str, Mapping[str, Compared]]) -> Figure:
    """`cases`: figures by case and by what is wrong, the nominal plant first; that one with its interval."""
    figure = new_figure(10.0, 0.42 * len(cases) + 2.2, title)
    place(figure, left=2.2, right=2.3, bottom=0.7, top=0.6)
    axes = figure.subplots()
    dress(axes, "below 1: better than the same table without estimator", "rms with / without estimator", "")
    axes.grid(axis="y", visible=False)
    places = np.arange(len(cases))[::-1]
    nominal, *wrong = next(iter(cases.values()))
    for i, name in enumerate(wrong):
        found = [case[name].ratio for case in cases.values()]
        axes.plot(found, places, marker=MARKERS[i % len(MARKERS)], color=LINE_COLOURS[i % 7], linestyle="",
                  markersize=5, alpha=0.8, fillstyle="none", label=name)  # fmt: skip
    ratios = np.array([case[nominal].ratio for case in cases.values()])
    spread = np.abs(np.array([case[nominal].ratio_ci95 for case in cases.values()]).T - ratios)
    axes.errorbar(ratios, places, xerr=spread, fmt="k|", markersize=12, capsize=3, label=f"{nominal}, 95 %")
    axes.axvline(1.0, color=BLACK, linewidth=0.8)
    axes.set_yticks(places, list(cases))
    axes.legend(fontsize=8, loc="center left", bbox_to_anchor=(1.01, 0.5))
    return figure
