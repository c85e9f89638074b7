"""Pictures of shares of variance: means over all cases as bars, and every case as a cell."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from synth.frame.picture.house_style import BLUE, GREY, INK, PALE_GREY, dress, new_figure, place
from synth.retarder.sensitivity.sensitivity import Sensitivity, ranked

MOST_BARS = 12
DARK_CELL = 0.35
"""Above this share the figure in a cell is white."""


def share_bars(found: Sensitivity) -> Figure:
    """A panel an output; the parameters of all panels are those that lead in the first."""
    order = [key for key, _ in ranked(found.keys, found.overall[0])][:MOST_BARS]
    names = dict(zip(found.keys, found.names, strict=True))
    figure = new_figure(
        12.0, 2.1 + 0.3 * len(order), "What to measure first: shares of variance by parameter",
        f"mean over {len(found.cases)} cases; {found.trial.points} plants, {found.trial.passes} passes each; "
        f"the {len(order)} largest of {len(found.keys)} for the rms",
    )  # fmt: skip
    place(figure, left=3.1, right=0.3, bottom=0.7, top=0.95, w=0.12)
    panels = np.ravel(figure.subplots(1, len(found.overall), sharey=True))
    rows = range(len(order))
    for axes, each in zip(panels, found.overall, strict=True):
        shares = dict(zip(found.keys, each.shares, strict=True))
        dress(axes, each.output.title, "share of variance, %", "")
        for row, key in zip(rows, reversed(order), strict=True):
            share = shares[key]
            low, high = share.ci95
            colour = BLUE if share.decided else GREY
            axes.barh(row, 100.0 * share.value, color=colour, height=0.6, zorder=3)
            axes.plot([100.0 * low, 100.0 * high], [row, row], color=INK, linewidth=1.2, zorder=4)
        axes.axvline(0.0, color=INK, linewidth=0.8, zorder=4)
        axes.grid(False, axis="y")
    panels[0].set_yticks(list(rows), [names[key] for key in reversed(order)], fontsize=8)
    return figure


def share_cells(found: Sensitivity) -> Figure:
    """Parameters down, cases across: shares for the rms in per cent."""
    order = [key for key, _ in ranked(found.keys, found.overall[0])][:MOST_BARS]
    places = [found.keys.index(key) for key in order]
    cases = [f"{case.label}\nto {case.target_m_s:g} m/s" for case in found.cases]
    figure = new_figure(
        4.0 + 0.62 * len(cases), 2.3 + 0.3 * len(order), "Shares of the variance of the rms exit error, %",
        "every case is a table of its own",
    )  # fmt: skip
    place(figure, left=3.1, right=0.3, bottom=1.15, top=0.75)
    axes = figure.subplots()
    dress(axes)
    axes.grid(False)
    values = np.array([[case.outputs[0].shares[place].value for case in found.cases] for place in places])
    axes.imshow(np.clip(values, 0.0, 1.0), cmap="Blues", vmin=0.0, vmax=0.7, aspect="auto")
    for (row, column), value in np.ndenumerate(values):
        decided = found.cases[column].outputs[0].shares[places[row]].decided
        colour = ("white" if value > DARK_CELL else INK) if decided else GREY
        axes.text(column, row, f"{max(100.0 * value, 0.0):.0f}", ha="center", va="center", fontsize=7.5, color=colour)
    names = [found.names[place] for place in places]
    axes.set_yticks(range(len(order)), names, fontsize=8)
    axes.set_xticks(range(len(cases)), cases, fontsize=7, rotation=90)
    axes.spines[["left", "bottom"]].set_color(PALE_GREY)
    return figure
