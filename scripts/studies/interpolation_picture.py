"""The picture of the study `interpolation`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from matplotlib.figure import Figure

from synth.frame.picture.house_style import LINE_COLOURS, LINE_MARKERS, dress, logarithmic_y, new_figure, place

if TYPE_CHECKING:
    from scripts.studies.interpolation import Interpolated, Row


def picture(rows: Sequence[Row]) -> Figure:
    """rms over the commanded speed: filled markers for tables of the book, hollow ones between them."""
    figure = new_figure(9.0, 5.5, "What is lost between two tables of a book")
    place(figure, left=0.8, right=2.4, bottom=0.7, top=0.6)
    axes = figure.subplots()
    dress(axes, "solid: lines of the book; dotted: tuned for the very speed", "commanded exit speed, m/s",
          "simulated rms, mm/s")  # fmt: skip
    for i, label in enumerate(dict.fromkeys(row.label for row in rows)):
        mine = [row for row in rows if row.label == label]
        speeds = [row.target_m_s for row in mine]
        colour, marker = LINE_COLOURS[i % 7], LINE_MARKERS[i % 7]
        axes.plot(speeds, [1e3 * row.book_rms_m_s for row in mine], label=label, color=colour, marker=marker,
                  fillstyle="none")  # fmt: skip
        there = [row for row in mine if not row.between]
        axes.plot([row.target_m_s for row in there], [1e3 * row.book_rms_m_s for row in there], color=colour,
                  marker=marker, linestyle="")  # fmt: skip
        axes.plot(speeds, [1e3 * row.tuned_rms_m_s for row in mine], linestyle=":", color=colour)
    logarithmic_y(axes, [1e3 * row.book_rms_m_s for row in rows])
    axes.legend(fontsize=8, loc="center left", bbox_to_anchor=(1.01, 0.5))
    return figure


def figures(found: Interpolated) -> Mapping[str, Figure]:
    """rms over the commanded speed."""
    return {"": picture(found.rows)}
