"""The picture of the study `reference-problem`."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from matplotlib.figure import Figure

from synth.present.plots.house_style import BLUE, GREY, INK, VERMILLION, dress, logarithmic_x, new_figure, place
from synth.studies.timing.turns import three_digits

if TYPE_CHECKING:
    from synth.studies.reference_problem.findings import Comparison


def picture(found: Comparison) -> Figure:
    """Bars of the medians on a logarithmic axis: one problem, the batch; dashed what the loads alone would take."""
    subject = f"{found.transitions:,} transitions; {found.machine.processor}"
    figure = new_figure(10.5, 3.9, "Time of a whole solve of the reference problem", subject)
    place(figure, left=1.6, right=1.3, bottom=0.55, top=0.95, w=1.05)
    limit = 1e3 * found.limits[-1].sweep_by_loads_s
    titles = {f"one problem (dashed: its loads alone, {limit:.2g} ms)": found.single, "16 problems": found.batch}
    for axes, (title, rows) in zip(figure.subplots(1, 2), titles.items(), strict=True):
        ordered = sorted(rows, key=lambda row: -row.times.median_s)
        medians = [1e3 * row.times.median_s for row in ordered]
        dress(axes, title, "median, ms")
        axes.grid(False, axis="y")
        colours = [BLUE if row.name.startswith("kernels") else GREY for row in ordered]
        axes.barh(
            [row.name.replace(", operators", ",\noperators") for row in ordered], medians, color=colours, height=0.62
        )
        single = rows is found.single
        logarithmic_x(axes, [0.6 * (limit if single else min(medians)), *medians])
        for place_at, middle in enumerate(medians):
            axes.annotate(f"{three_digits(middle)} ms", (middle, place_at), (4, 0), fontsize=8, va="center",
                          textcoords="offset points", color=INK, annotation_clip=False)  # fmt: skip
        if single:
            axes.axvline(limit, color=VERMILLION, ls="--", lw=1.2)
    return figure


def figures(found: Comparison) -> Mapping[str, Figure]:
    """Bars of one problem and of the batch."""
    return {"": picture(found)}
