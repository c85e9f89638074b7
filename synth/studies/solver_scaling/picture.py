"""The picture of the study `solver-scaling`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure

from synth.present.plots import house_style as house

if TYPE_CHECKING:
    from synth.studies.solver_scaling.findings import Growth, SolverScaling


def picture(growths: Sequence[Growth], subject: str) -> Figure:
    """One panel a size: measured points, and a line of slope 1 through the first."""
    figure = house.new_figure(9.0, 6.4, "What one solve costs", subject)
    house.place(figure, left=0.8, right=0.3, bottom=0.6, top=0.95, w=0.28, h=0.42)
    every = [s for one in growths for s in one.processor_s]
    for i, (axes, one) in enumerate(zip(figure.subplots(2, 2).flat, growths, strict=True)):
        house.dress(axes, f"{one.name}: {one.note}", one.name, "processor time, s")
        size, seconds = np.array(one.size), np.array(one.processor_s)
        proportion = seconds[0] * size / size[0]
        axes.plot(size, proportion, ls=":", color=house.LINE_COLOURS[6], label="in proportion")
        axes.plot(size, seconds, color=house.LINE_COLOURS[i], marker=house.LINE_MARKERS[i], label="measured")
        house.logarithmic_x(axes, one.size)
        house.logarithmic_y(axes, [*every, *proportion])
        axes.legend(fontsize=8, loc="upper left", frameon=False)
    return figure


def figures(found: SolverScaling) -> Mapping[str, Figure]:
    """A panel a size."""
    return {"": picture(found.growths, f"{found.label}, {found.grid}")}
