"""The picture of the study `convergence`: difference of each level from the finest, over the share of the step."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from matplotlib.figure import Figure

from synth.present.plots.house_style import (
    LINE_COLOURS,
    LINE_MARKERS,
    LINE_STYLES,
    dress,
    logarithmic_x,
    logarithmic_y,
    new_figure,
    place,
)

if TYPE_CHECKING:
    from synth.studies.convergence.findings import CaseRow, Convergence


def picture(cases: Sequence[CaseRow]) -> Figure:
    """A row a case, a column a kind of step."""
    figure = new_figure(12.5, 3.2 * len(cases) + 0.6, "Difference of the rms from that of the finest level")
    place(figure, left=0.8, right=0.2, bottom=0.7, top=0.9, w=0.25, h=0.55)
    panels = figure.subplots(len(cases), len(cases[0].refinements), squeeze=False)
    for row, case in zip(panels, cases, strict=True):
        for axes, refinement in zip(row, case.refinements, strict=True):
            *coarser, finest = refinement.levels
            dress(axes, case.case, f"{refinement.kind}, share of default", "mm/s")
            own = [1e3 * abs(level.own_rms_m_s - finest.own_rms_m_s) for level in coarser]
            cubic = [1e3 * abs(level.cubic_rms_m_s - finest.cubic_rms_m_s) for level in coarser]
            for i, (differences, name) in enumerate(((own, "solver's own lines"), (cubic, "fixed cubic"))):
                axes.plot([level.share for level in coarser], differences, marker=LINE_MARKERS[i],
                          color=LINE_COLOURS[i], linestyle=LINE_STYLES[i], label=name)  # fmt: skip
            logarithmic_x(axes, [level.share for level in coarser])
            logarithmic_y(axes, [*own, *cubic])
    panels[0, 0].legend(fontsize=8)
    return figure


def figures(found: Convergence) -> Mapping[str, Figure]:
    """A row a case, a column a kind of step."""
    return {"": picture(found.cases)}
