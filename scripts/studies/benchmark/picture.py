"""The picture of the study `benchmark`."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from matplotlib.figure import Figure

from synth.frame.picture.house_style import BLUE, GREY, INK, VERMILLION, dress, logarithmic_x, new_figure, place

if TYPE_CHECKING:
    from scripts.studies.benchmark.findings import Benchmark


def picture(found: Benchmark) -> Figure:
    """Bars of the medians on a logarithmic axis; dashed: the largest of the machine's limits for the first way."""
    figure = new_figure(9.0, 3.4, "Time of a backward sweep", f"{found.label}, {found.size}; one core")
    place(figure, left=2.3, right=1.2, bottom=0.6, top=0.75)
    axes = figure.subplots()
    limit = max(1e3 * each.sweep.median_s for each in found.limits)
    medians = [1e3 * way.times.median_processor_s for way in found.ways]
    dress(
        axes,
        f"dashed: what the machine could do at best for '{found.ways[0].name}', {limit:.3g} ms",
        "median processor time, ms",
    )
    axes.grid(False, axis="y")
    axes.barh([way.name for way in found.ways], medians, color=[*[BLUE] * (len(medians) - 1), GREY], height=0.6)
    logarithmic_x(axes, [0.6 * limit, *medians])
    axes.invert_yaxis()
    for row, (way, middle) in enumerate(zip(found.ways, medians, strict=True)):
        axes.annotate(f"{found.rate(way):.1e} transitions/s", (middle, row), (4, 0), fontsize=8, va="center",
                      textcoords="offset points", color=INK, annotation_clip=False)  # fmt: skip
    axes.axvline(limit, color=VERMILLION, ls="--", lw=1.2)
    return figure


def figures(found: Benchmark) -> Mapping[str, Figure]:
    """Times of all ways on a logarithmic axis."""
    return {"": picture(found)}
