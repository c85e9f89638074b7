"""Pictures of identified numbers: what changed, how the drive answers, and friction from cut to cut."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from matplotlib.figure import Figure

from plant_models.frozen_arrays import Floats, Ints
from synth.frame.picture.house_style import BLUE, GREY, INK, PALE_GREY, VERMILLION, dress, new_figure, place
from synth.logs import unknowns as asked
from synth.logs.identify import Identified

AFTER_S, BIN_S = 1.5, 0.05
"""How long after a command pressures are shown, and of how much time a point is the mean."""


def numbers(found: Identified) -> Figure:
    """Interval of each number beside the band of what was known."""
    count = len(found.findings)
    figure = new_figure(
        9.5, 1.9 + 0.32 * count, "What the passes say of each number",
        f"{len(found.passes)} passes; figures: identified value [95 % interval]",
    )  # fmt: skip
    place(figure, left=3.3, right=2.6, bottom=0.75, top=0.8)
    axes = figure.subplots()
    dress(axes, "", "distance from before, in standard deviations of what was known", "")
    axes.axvspan(-1.0, 1.0, color=PALE_GREY, zorder=0)
    axes.axvline(0.0, color=INK, linewidth=0.8)
    for row, (finding, u, std) in enumerate(
        zip(found.findings, found.estimate.u, found.estimate.std, strict=True)
    ):  # fmt: skip
        y, colour = count - 1 - row, BLUE if finding.identified else GREY
        axes.plot([u - 1.96 * std, u + 1.96 * std], [y, y], color=colour, linewidth=2)
        axes.plot([u], [y], "o", color=colour, markersize=5, markerfacecolor=colour if finding.identified else "white")
        low, high = finding.interval
        text = f"{finding.value:.4g} [{low:.4g}, {high:.4g}] {finding.unit.partition(' ')[0]}"
        axes.annotate(
            text, (1.02, y), xycoords=("axes fraction", "data"), va="center", fontsize=7.5,
            color=INK if finding.identified else GREY,
        )  # fmt: skip
    names = [finding.key.removeprefix("retarder.") for finding in reversed(found.findings)]
    axes.set_yticks(range(count), names, fontsize=8)
    axes.set_ylim(-0.7, count - 0.3)
    axes.grid(False, axis="y")
    return figure


def pressures(found: Identified) -> Figure:
    """A panel for commands upwards, and one for those downwards, by stages."""
    figure = new_figure(10.5, 4.8, "Pressure after a command", "points: mean of the gauge; lines: the drive by numbers")
    place(figure, left=0.75, right=0.3, bottom=0.75, top=0.95, w=0.22)
    panels = figure.subplots(1, 2)
    log = found.passes.log
    since, kind = since_command(found)
    for axes, upwards, title in zip(panels, (True, False), ("stage up", "stage down"), strict=True):
        dress(axes, title, "time since the command, s", "pressure, kPa")
        for start, end in sorted({(int(a), int(b)) for a, b in kind[np.isfinite(since)]}):
            if (end > start) != upwards:
                continue
            chosen = (kind[:, 0] == start) & (kind[:, 1] == end) & (since <= AFTER_S)
            times, columns = binned(
                since[chosen], log.pressure_kpa[chosen], found.before.pressure_kpa[chosen],
                found.after.pressure_kpa[chosen],
            )  # fmt: skip
            axes.plot(times, columns[0], "o", color=INK, markersize=3)
            axes.plot(times, columns[1], "--", color=VERMILLION, linewidth=1)
            axes.plot(times, columns[2], "-", color=BLUE, linewidth=1.2)
            if len(times):
                axes.annotate(f"{start} → {end}", (times[-1], columns[0][-1]), fontsize=7, color=GREY)
    return figure


def since_command(found: Identified) -> tuple[Floats, Ints]:
    """Time since the last command at each row, inf before the first; and the stages before and after it (n, 2)."""
    log = found.passes.log
    since, kind = np.full(len(log.time_s), np.inf), np.zeros((len(log.time_s), 2), dtype=np.int64)
    for number in range(len(log)):
        rows = log.rows(number)
        stage = log.stage[rows]
        at = np.concatenate(([0], np.flatnonzero(np.diff(stage)) + 1, [len(stage)]))
        for begin, end in pairwise(at[1:]):
            part = slice(rows.start + begin, rows.start + end)
            since[part] = log.time_s[part] - log.time_s[part.start]
            kind[part] = stage[begin - 1], stage[begin]
    return since, kind


def binned(since: Floats, *columns: Floats) -> tuple[Floats, list[Floats]]:
    """Times, and means of each column over readings made at nearly the same time, where there are some."""
    place = np.rint(since / BIN_S).astype(np.int64)
    known = np.isfinite(columns[0])
    count = np.bincount(place[known])
    there = np.flatnonzero(count >= 3)
    means = [np.bincount(place[known], column[known])[there] / count[there] for column in columns]
    return np.asarray(there * BIN_S), [np.asarray(mean) for mean in means]


def friction(found: Identified) -> Figure:
    """Histograms of ξ and of the standardised innovations."""
    figure = new_figure(10.5, 4.2, "Friction of the cuts, and innovations of the readings")
    place(figure, left=0.7, right=0.3, bottom=0.75, top=0.75, w=0.2)
    left, right = figure.subplots(1, 2)
    dress(left, "friction of a cut, as its pass tells it", "friction factor", "cuts")
    cv = found.estimate.values[asked.COMMON_CV]
    values = found.after.friction
    edges = np.linspace(min(values.min(), 1.0 - 3 * cv), max(values.max(), 1.0 + 3 * cv), 41)
    left.hist(values, edges, color=BLUE, alpha=0.6)
    # What a filter tells of a cut varies less than the cuts do: by its own error.
    spread = np.sqrt(max(cv**2 - float(np.mean(found.after.friction_std**2)), 1e-6))
    left.plot(edges, normal(edges, 1.0, spread) * len(values) * (edges[1] - edges[0]), color=INK, linewidth=1.2)
    dress(right, "innovations of the readings", "innovation over what is expected", "share a unit")
    edges = np.linspace(-5.0, 5.0, 61)
    for fit, colour, name in ((found.before, VERMILLION, "numbers before"), (found.after, BLUE, "identified")):
        right.hist(fit.innovations, edges, density=True, histtype="step", color=colour, linewidth=1.4, label=name)
    right.plot(edges, normal(edges, 0.0, 1.0), color=INK, linewidth=0.9, label="expected")
    right.legend(frameon=False, fontsize=8)
    return figure


def normal(x: Floats, mean: float, std: float) -> Floats:
    """Density of the normal law."""
    return np.asarray(np.exp(-0.5 * ((x - mean) / std) ** 2) / (std * np.sqrt(2.0 * np.pi)))
