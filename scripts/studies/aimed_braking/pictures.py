"""The pictures of the study `aimed-braking`: Kozachenko's figures, inputs that count, ways to measure."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from synth.frame.picture.house_style import (
    BLUE,
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
    from scripts.studies.aimed_braking.published_figures import Line, OverSpeeds
    from scripts.studies.aiming.trial import Value

NORM_GAP_M, NORM_SHARE = 3.0, 0.1


def curves(found: AimedBraking) -> Figure:
    """Figure 1 of Kozachenko: speed and time of light cars over the distance from the crest."""
    rolls = len(found.curves.speed_m_s)
    figure = new_figure(9.0, 5.0, "Light single cars that leave the park position at 3.5 m/s",
                        f"{rolls} rolls, standard deviation of the exit speed 0.1 m/s")  # fmt: skip
    place(figure, left=0.7, right=0.4, bottom=0.6, top=0.85, w=0.25)
    left, right = figure.subplots(1, 2)
    dress(left, "speed", "distance from the crest, m", "v, m/s")
    dress(right, "time since the exit", "distance from the crest, m", "t, s")
    for speeds, times in zip(found.curves.speed_m_s, found.curves.time_s, strict=True):
        known = [t for t in times if t is not None]
        left.plot(found.curves.stations_m[: len(speeds)], speeds, color=BLUE, linewidth=0.5, alpha=0.35)
        right.plot(found.curves.stations_m[: len(known)], known, color=BLUE, linewidth=0.5, alpha=0.35)
    limit = 5.0 / 3.6
    left.axhline(limit, color=GREY, linestyle="--", linewidth=1.0)
    left.annotate(
        "1.39 m/s", (found.curves.stations_m[0], limit), xytext=(0, 3), textcoords="offset points", fontsize=8
    )
    left.set_ylim(bottom=0.0)
    return figure


def over_speed(found: AimedBraking) -> Figure:
    """Figure 2 of Kozachenko: over-speed and gap of light cars over the exit speed, 500 m from the crest."""
    each = next(o for o in found.over_speeds if o.category == "L" and o.metres == 500.0)
    figure = new_figure(9.0, 4.6, "Light single cars, 500 m from the crest", "bars: 95 % intervals")
    place(figure, left=0.7, right=0.4, bottom=0.6, top=0.85, w=0.25)
    left, right = figure.subplots(1, 2)
    dress(left, "share of over-speeds", "commanded exit speed, m/s", "p")
    dress(right, "mean gap a car", "commanded exit speed, m/s", "l, m")
    speeds = [row.speed_m_s for row in each.rows]
    bars(left, speeds, [row.overspeed for row in each.rows], 0, "")
    bars(right, speeds, [row.gap_m for row in each.rows], 0, "")
    return figure


def share_over_gap(found: AimedBraking) -> Figure:
    """Figure 3 of Kozachenko: over-speed over gap by distance, light and heavy."""
    figure = new_figure(10.0, 5.2, "Over-speed over gap: one is had for the other",
                        "single cars; a point for each exit speed; the cross: 3 m at a share of 0.1")  # fmt: skip
    place(figure, left=0.7, right=0.4, bottom=0.6, top=0.85, w=0.25)
    for axes, category, name in zip(figure.subplots(1, 2), ("L", "T"), ("light", "heavy"), strict=True):
        dress(axes, name, "mean gap a car, m", "share of over-speeds")
        for i, each in enumerate(o for o in found.over_speeds if o.category == category):
            trade_off(axes, each, i)
        axes.plot([NORM_GAP_M], [NORM_SHARE], marker="+", color="black", markersize=12, linestyle="")
        axes.set(xlim=(0.0, 60.0), ylim=(0.0, 1.0))
        axes.legend(fontsize=8, title="from the crest", title_fontsize=8)
    return figure


def trade_off(axes: Axes, each: OverSpeeds, i: int) -> None:
    """One curve of figure 3."""
    axes.plot(
        [row.gap_m.value for row in each.rows], [row.overspeed.value for row in each.rows], color=LINE_COLOURS[i],
        linestyle=LINE_STYLES[i], marker=LINE_MARKERS[i], markersize=3.5, label=f"{each.metres:g} m",
    )  # fmt: skip


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


def moved(found: AimedBraking) -> Figure:
    """How far each assumed input moves the distance of the norm."""
    rows = found.sensitivity[1:]
    figure = new_figure(9.5, 1.6 + 0.27 * max(len(rows), 3), "What moves the distance to which 3 m are kept",
                        "bars: 95 % intervals of the paired difference")  # fmt: skip
    place(figure, left=3.3, right=0.4, bottom=0.6, top=0.7)
    axes = figure.subplots()
    dress(axes, "", "farther from the crest, m", "")
    kinds = (("light, category", "light"), ("heavy, category", "heavy"), ("light, resistance measured", "measured"))
    for i, (label, name) in enumerate(kinds):
        known = [(k, getattr(row, name).farther_m) for k, row in enumerate(rows) if getattr(row, name).farther_m]
        axes.errorbar(
            [v.value for _, v in known], [k + 0.2 * (i - 1) for k, _ in known],
            xerr=[0.5 * (v.ci95[1] - v.ci95[0]) for _, v in known], color=LINE_COLOURS[i], marker=LINE_MARKERS[i],
            linestyle="", markersize=4.5, capsize=2, label=label,
        )  # fmt: skip
    axes.axvline(0.0, color=GREY, linewidth=1.0)
    axes.set_yticks(range(len(rows)), [f"{r.name}: {r.assumed} → {r.value}" for r in rows], fontsize=8)
    axes.invert_yaxis()
    axes.legend(fontsize=8, loc="lower right")
    return figure


def measuring(found: AimedBraking) -> Figure:
    """The gap by what is measured, a bar a way, for each free distance."""
    ways = found.measured
    figure = new_figure(10.0, 1.8 + 0.3 * max(len(ways), 4), "What measuring brings: light single cars",
                        f"gap at a share {found.p_overspeed:g} of over-speeds, exit error 0.03 m/s")  # fmt: skip
    place(figure, left=3.6, right=0.4, bottom=0.6, top=0.85, w=0.12)
    panels = figure.subplots(1, len(found.measured_metres), sharey=True)
    for k, axes in enumerate(panels):
        dress(axes, f"{found.measured_metres[k]:g} m behind the position", "gap, m", "")
        for i, way in enumerate(ways):
            outcome = way.outcomes[k]
            if outcome is not None:
                gap = outcome.gap_m
                axes.barh(i, gap.value, color=BLUE, height=0.6, xerr=0.5 * (gap.ci95[1] - gap.ci95[0]), capsize=2)
    panels[0].set_yticks(range(len(ways)), [way.name for way in ways], fontsize=8)
    panels[0].invert_yaxis()
    return figure


def figures(found: AimedBraking) -> Mapping[str, Figure]:
    """All pictures."""
    return {
        "curves": curves(found), "speeds": over_speed(found), "trade-off": share_over_gap(found),
        "distance": gap_over_distance(found), "sensitivity": moved(found), "measuring": measuring(found),
    }  # fmt: skip
