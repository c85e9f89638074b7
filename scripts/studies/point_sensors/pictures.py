"""Pictures of the study `point-sensors`."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from scripts.studies.point_sensors.tables import kind_of
from synth.frame.picture.house_style import (
    BLUE,
    GREY,
    INK,
    VERMILLION,
    dress,
    legend_below,
    logarithmic_x,
    logarithmic_y,
    new_figure,
    place,
)

if TYPE_CHECKING:
    from scripts.studies.point_sensors.rows import FaultRow, RadarRow, SensorRow, WorthRows

LOOK = {"first": (VERMILLION, "s"), "every": (BLUE, "o")}
"""Colour and marker by the axles that are decided on."""

COLUMNS = 3


def by_number(found: WorthRows) -> Figure:
    """rms over the number of sensors, a panel a case; dashed: equal sections."""
    rows = -(-len(found.radar) // COLUMNS)
    columns = min(COLUMNS, len(found.radar))
    figure = new_figure(3.9 * columns + 0.7, 3.2 * rows + 1.6, "rms by the number of point sensors", "95 % intervals")
    place(figure, left=0.75, right=0.2, bottom=1.15, top=0.85, w=0.22, h=0.45)
    panels = figure.subplots(rows, columns, squeeze=False).ravel()
    ends = [end for row in found.sensors for end in row.rms_ci95_m_s] + [row.rms_m_s for row in found.radar]
    for axes, radar in zip(panels, found.radar, strict=False):
        mine = [row for row in found.sensors if row.case == radar.case]
        dress(axes, radar.case, "sensors, with that behind the exit", "simulated rms, m/s" if axes in panels[::COLUMNS]
              else "")  # fmt: skip
        draw_case(axes, mine, radar)
        logarithmic_y(axes, ends)
    for axes in panels[len(found.radar) :]:
        axes.set_visible(False)
    handles = [
        Line2D([], [], color=colour, marker=marker, label=f"{axles} axle, planned")
        for axles, (colour, marker) in LOOK.items()
    ]  # fmt: skip
    handles += [
        Line2D([], [], color=INK, ls=":", marker=".", label="equal sections"),
        Line2D([], [], color=INK, ls="", marker="*", ms=9, mfc="none", label="rule of the source"),
        Line2D([], [], color=GREY, ls="--", label="radar"),
    ]
    legend_below(figure, handles, columns=5 if columns > 1 else 2)
    return figure


def draw_case(axes: Axes, rows: list[SensorRow], radar: RadarRow) -> None:
    """The layouts of one case, and the radar as a line across."""
    for axles, (colour, marker) in LOOK.items():
        planned = sorted((r for r in rows if (r.axles, r.layout) == (axles, "planned")), key=lambda r: r.sensors)
        y = [row.rms_m_s for row in planned]
        low = [row.rms_m_s - row.rms_ci95_m_s[0] for row in planned]
        high = [row.rms_ci95_m_s[1] - row.rms_m_s for row in planned]
        count = [row.sensors for row in planned]
        axes.errorbar(count, y, (low, high), color=colour, marker=marker, ms=4, lw=1.3, capsize=2)
        equal = sorted((r for r in rows if (r.axles, r.layout) == (axles, "equal")), key=lambda r: r.sensors)
        axes.plot([r.sensors for r in equal], [r.rms_m_s for r in equal], color=colour, ls=":", marker=".", lw=1.1)
        rule = [row for row in rows if (row.axles, row.layout) == (axles, "rule")]
        axes.plot(
            [r.sensors for r in rule], [r.rms_m_s for r in rule], color=colour, ls="", marker="*", ms=9, mfc="none"
        )
    axes.axhline(radar.rms_m_s, color=GREY, ls="--", lw=1.1, zorder=1)


def by_fault(found: WorthRows) -> Figure:
    """The rms of every kind of fault at its worst sensor, a panel a case; hollow: without limits of the tracker."""
    cases = list(dict.fromkeys(row.case for row in found.faulty))
    kinds = list(dict.fromkeys(kind_of(row.fault) for row in found.faulty))
    rows, columns = -(-len(cases) // COLUMNS), min(COLUMNS, len(cases))
    height_in = (0.24 * len(kinds) + 0.9) * rows + 1.4
    subject = "rms of all cuts while the fault lasts; 95 % intervals; dotted: without fault"
    figure = new_figure(3.7 * columns + 2.4, height_in, "What a fault costs, at the worst sensor", subject)
    place(figure, left=2.3, right=0.2, bottom=0.95, top=0.9, w=0.12, h=0.3)
    panels = figure.subplots(rows, columns, squeeze=False, sharey=True).ravel()
    ends = [end for row in found.faulty for end in row.rms_ci95_m_s]
    for axes, case in zip(panels, cases, strict=False):
        dress(axes, case, "rms, m/s")
        for shift, (axles, (colour, marker)) in zip((-0.18, 0.18), LOOK.items(), strict=True):
            draw_faults(axes, worst_of([r for r in found.faulty if (r.case, r.axles) == (case, axles)]), kinds, shift,
                        (colour, marker))  # fmt: skip
        axes.set_yticks(range(len(kinds)), kinds, fontsize=8)
        axes.set_ylim(len(kinds) - 0.4, -0.6)
        logarithmic_x(axes, ends)
    for axes in panels[len(cases) :]:
        axes.set_visible(False)
    handles = [
        Line2D([], [], color=colour, marker=marker, ls="", label=f"{axles} axle")
        for axles, (colour, marker) in LOOK.items()
    ]
    handles += [Line2D([], [], color=INK, marker="o", mfc="none", ls="", label="the tracker believes almost anything")]
    legend_below(figure, handles, columns=3)
    return figure


def worst_of(rows: list[FaultRow]) -> dict[str, FaultRow]:
    """The dearest sensor of each kind."""
    worst: dict[str, FaultRow] = {}
    for row in rows:
        kind = kind_of(row.fault)
        if kind not in worst or row.rms_m_s > worst[kind].rms_m_s:
            worst[kind] = row
    return worst


def draw_faults(axes: Axes, worst: dict[str, FaultRow], kinds: list[str], shift: float, look: tuple[str, str]) -> None:
    """One mark a kind, and a hollow one without limits."""
    colour, marker = look
    if "no fault" not in worst:
        return
    whole = worst["no fault"].rms_m_s
    axes.axvline(whole, color=colour, lw=0.8, ls=":")
    for kind, row in worst.items():
        y = kinds.index(kind) + shift
        axes.plot(row.rms_ci95_m_s, [y, y], color=colour, lw=1.0)
        axes.plot([row.rms_m_s], [y], color=colour, marker=marker, ms=4.5)
        axes.plot([whole * row.wide_ratio], [y], color=colour, marker=marker, ms=7, mfc="none")


def figures(found: WorthRows) -> Mapping[str, Figure]:
    """`number`, `faults`."""
    return {"number": by_number(found), "faults": by_fault(found)}
