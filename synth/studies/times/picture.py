"""The picture of the study `times`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from matplotlib.figure import Figure

from synth.present.plots.house_style import BLUE, dress, logarithmic_x, new_figure, place

if TYPE_CHECKING:
    from synth.studies.times.findings import Waited, WaitingTimes


def picture(waited: Sequence[Waited], processor: str) -> Figure:
    """Bars of the medians on a logarithmic axis."""
    figure = new_figure(8.0, 3.4, "What a user waits for", processor)
    place(figure, left=2.7, right=0.6, bottom=0.6, top=0.75)
    axes = figure.subplots()
    medians = [each.times.median_s for each in waited]
    dress(axes, "", "median wall time, s")
    logarithmic_x(axes, [0.5 * min(medians), 3.0 * max(medians)])
    bars = axes.barh([each.name.strip("`") for each in waited], medians, color=BLUE)
    axes.bar_label(bars, [f"{seconds:.3g} s" for seconds in medians], padding=3, fontsize=8)
    axes.invert_yaxis()
    axes.grid(False, axis="y")
    return figure


def figures(found: WaitingTimes) -> Mapping[str, Figure]:
    """Bars of the medians."""
    named = [replace(each, name=f"{found.passes} passes, {each.name}") for each in found.simulated]
    return {"": picture([*found.commands, *named], found.machine.processor)}
