"""The picture of the study `watch`: passes until alarm and name."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from matplotlib.figure import Figure

from synth.frame.picture.house_style import BLUE, VERMILLION, dress, logarithmic_x, new_figure, place

if TYPE_CHECKING:
    from scripts.studies.watch.findings import Watched


def figures(found: Watched) -> Mapping[str, Figure]:
    """From median to 90 % quantile, a row a change."""
    rows = found.found[::-1]
    figure = new_figure(9.0, 1.4 + 0.4 * len(rows), "Passes from a drift to the alarm and to its name")
    place(figure, left=2.9, right=1.4, bottom=0.6, top=0.6)
    axes = figure.subplots()
    dress(axes, "from median to 90 % quantile", "passes")
    for colour, marker, name, shift in ((BLUE, "o", "alarm", 0.12), (VERMILLION, "s", "name", -0.12)):
        for place_of_row, row in enumerate(rows):
            low, high = row.alarm if name == "alarm" else row.named
            axes.plot([low, high], [place_of_row + shift] * 2, color=colour, marker=marker, markersize=4,
                      label=name if place_of_row == 0 else None)  # fmt: skip
    logarithmic_x(axes, [value for row in rows for value in (*row.alarm, *row.named)])
    axes.set_yticks(range(len(rows)), [f"{row.change}, {'gauge' if row.gauge else 'no gauge'}" for row in rows])
    axes.legend(fontsize=8, loc="center left", bbox_to_anchor=(1.01, 0.5), frameon=False)
    return {"": figure}
