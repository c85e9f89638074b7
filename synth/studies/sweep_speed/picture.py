"""The picture of the study `sweep-speed`."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure

from synth.present.plots.house_style import BLUE, VERMILLION, dress, new_figure, place

if TYPE_CHECKING:
    from synth.studies.sweep_speed.findings import SweepSpeed


def picture(found: SweepSpeed) -> Figure:
    """Tables over time; seconds of a class over its mass; memory beside its estimate."""
    figure = new_figure(12.0, 4.2, "A sweep, measured", f"{found.made} tables, {found.workers} workers")
    place(figure, left=0.8, right=0.3, bottom=0.6, top=1.0, w=0.32)
    left, middle, right = figure.subplots(1, 3)
    units = found.units
    dress(left, "tables done", "time, s", "tables")
    left.plot([0.0, *(unit.done_s for unit in units)], [0, *np.cumsum([unit.tables for unit in units])], color=BLUE)
    left.plot([0.0, found.total_s], [0, found.made], color=VERMILLION, ls="--")
    dress(middle, "time of a class with all its targets", "mass, t", "s")
    middle.plot([unit.mass_t for unit in units], [unit.seconds for unit in units], "o", ms=4, color=BLUE)
    middle.set_ylim(0.0)
    dress(right, "highest memory of a worker", "estimated, MiB", "measured, MiB")
    right.plot([unit.estimate_mib for unit in units], [unit.peak_mib for unit in units], "o", ms=4, color=BLUE)
    most = 1.1 * max(max(unit.estimate_mib, unit.peak_mib) for unit in units)
    right.plot([0, most], [0, most], color=VERMILLION, ls="--")
    right.set(xlim=(0, most), ylim=(0, most))
    return figure


def figures(found: SweepSpeed) -> Mapping[str, Figure]:
    """Tables over time, time over mass, memory over its estimate."""
    return {"": picture(found)}
