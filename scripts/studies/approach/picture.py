"""The picture of the study `approach`."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from matplotlib.figure import Figure

from synth.frame.picture.house_style import LINE_COLOURS, LINE_MARKERS, dress, logarithmic_y, new_figure, place

if TYPE_CHECKING:
    from scripts.studies.approach.findings import Approaches


def picture(found: Approaches) -> Figure:
    """rms over the length of the approach, a line a case, with 95 % intervals."""
    figure = new_figure(9.0, 5.5, "From how far before the entrance the regulator should act")
    place(figure, left=0.8, right=1.9, bottom=0.7, top=0.6)
    axes = figure.subplots()
    dress(axes, "tables tuned for each length; bars: 95 % intervals", "approach, m", "simulated rms, m/s")
    for i, row in enumerate(found.by_length):
        low = [rms - ends[0] for rms, ends in zip(row.rms_m_s, row.rms_ci95_m_s, strict=True)]
        high = [ends[1] - rms for rms, ends in zip(row.rms_m_s, row.rms_ci95_m_s, strict=True)]
        axes.errorbar(
            found.lengths_m, row.rms_m_s, (low, high), color=LINE_COLOURS[i % 7], marker=LINE_MARKERS[i % 7],
            label=row.case, capsize=3,
        )  # fmt: skip
    logarithmic_y(axes, [end for row in found.by_length for ends in row.rms_ci95_m_s for end in ends])
    axes.legend(fontsize=8, loc="center left", bbox_to_anchor=(1.01, 0.5))
    return figure


def figures(found: Approaches) -> Mapping[str, Figure]:
    """rms over the length of the approach."""
    return {"": picture(found)}
