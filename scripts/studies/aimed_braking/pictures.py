"""The picture of the study `aimed-braking`: the gap over the distance."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from synth.frame.picture.house_style import (
    GREY,
    LINE_COLOURS,
    LINE_MARKERS,
    LINE_STYLES,
    dress,
    new_figure,
    place,
)

if TYPE_CHECKING:
    from scripts.studies.aimed_braking.findings import AimedBraking
    from scripts.studies.aimed_braking.published_figures import Line
    from scripts.studies.aiming.trial import Value

NORM_GAP_M = 3.0


def gap_over_distance(found: AimedBraking) -> Figure:
    """Figures 4 and 5 of Kozachenko: gap at the share over the distance, by category, by knowledge, by cars."""
    figure = new_figure(12.5, 5.2, f"Mean gap a car at a share {found.p_overspeed:g} of over-speeds",
                        "bars: 95 % intervals; dashed: 3 m")  # fmt: skip
    place(figure, left=0.7, right=0.3, bottom=0.6, top=0.85, w=0.2)
    panels = (
        ("single cars by category", found.by_category),
        ("light single cars by what is known", found.refined),
        ("light cuts by their cars", found.by_cars),
    )
    for axes, (name, lines) in zip(figure.subplots(1, 3, sharey=True), panels, strict=True):
        dress(axes, name, "distance from the crest, m", "gap a car, m" if name.startswith("single") else "")
        of_lines(axes, lines)
        axes.axhline(NORM_GAP_M, color=GREY, linestyle="--", linewidth=1.0)
        axes.set_ylim(0.0, 165.0)
        axes.legend(fontsize=7.5, loc="upper left")
    return figure


def of_lines(axes: Axes, lines: tuple[Line, ...]) -> None:
    """Gap over distance of several lines."""
    for i, line in enumerate(lines):
        known = [(x, o.gap_m) for x, o in zip(line.metres, line.outcomes, strict=True) if o is not None]
        bars(axes, [x for x, _ in known], [gap for _, gap in known], i, line.name.replace(", nearest", ",\nnearest"))


def bars(axes: Axes, x: list[float], values: list[Value], i: int, label: str) -> None:
    """Points with 95 % intervals."""
    low = [max(v.value - v.ci95[0], 0.0) for v in values]
    high = [max(v.ci95[1] - v.value, 0.0) for v in values]
    axes.errorbar(
        x, [v.value for v in values], (low, high), color=LINE_COLOURS[i % 7], linestyle=LINE_STYLES[i % 7],
        marker=LINE_MARKERS[i % 7], markersize=3.5, capsize=2, linewidth=1.2, label=label or None,
    )  # fmt: skip


def figures(found: AimedBraking) -> Mapping[str, Figure]:
    """The one picture."""
    return {"distance": gap_over_distance(found)}
