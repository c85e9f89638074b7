"""The picture of the study `yard-chain`."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from synth.frame.picture.house_style import (
    BLUE,
    ORANGE,
    SKY,
    VERMILLION,
    dress,
    legend_below,
    new_figure,
    place,
)

if TYPE_CHECKING:
    from scripts.studies.aiming.trial import Value
    from scripts.studies.yard_chain.study import YardChain


def practices(found: YardChain) -> Figure:
    """Metres of gap and damaging couplings, today's practice beside the chain."""
    rows = found.practices
    about = f"mean over {', '.join(f'{m:g}' for m in found.metres)} m of free roll; bars: 95 % intervals"
    figure = new_figure(11.0, 4.6, "What the chain is worth: single cars, light and heavy", about)
    place(figure, left=2.9, right=0.4, bottom=0.95, top=0.85, w=0.12)
    left, right = figure.subplots(1, 2, sharey=True)
    dress(left, "gap a car", "m", "")
    dress(right, "couplings in a thousand cars", "couplings", "")
    for i, row in enumerate(rows):
        bar(left, i, row.gap_m, BLUE, 0.6, "")
        for k, (value, colour) in enumerate(zip(row.couplings, (SKY, ORANGE, VERMILLION), strict=True)):
            label = ("> 1.39 m/s", "> 1.5 m/s", "> 2 m/s")[k] if i == 0 else ""
            bar(right, i + 0.26 * (k - 1), value, colour, 0.24, label)
    left.set_yticks(range(len(rows)), [row.name for row in rows], fontsize=8.5)
    left.invert_yaxis()
    for axes in (left, right):
        axes.set_xlim(left=0.0)
    legend_below(figure, right.get_legend_handles_labels()[0], 3)
    return figure


def bar(axes: Axes, y: float, value: Value | None, colour: str, height: float, label: str) -> None:
    """One bar with its interval; none where there is no figure."""
    if value is None:
        return
    half = 0.5 * (value.ci95[1] - value.ci95[0])
    axes.barh(y, value.value, height, color=colour, xerr=half, capsize=2, label=label or None)


def figures(found: YardChain) -> Mapping[str, Figure]:
    """The one picture."""
    return {"practices": practices(found)}
