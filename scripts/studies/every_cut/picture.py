"""The picture of the study `every-cut`: tables beside the best rules, by the path of a pass."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Final, Literal

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from synth.frame.picture.house_style import (
    BLUE,
    GREEN,
    INK,
    VERMILLION,
    dress,
    legend_below,
    logarithmic_y,
    new_figure,
    place,
)

if TYPE_CHECKING:
    from scripts.studies.every_cut.cut_figures import CutFigures
    from scripts.studies.every_cut.study import EveryCut

KINDS = (("1 car", 1, 1, "o", BLUE), ("2 to 4 cars", 2, 4, "s", GREEN), ("6 to 10 cars", 5, 10, "^", VERMILLION))
"""Name, fewest and most cars, marker, colour."""

FILL_OF_FEASIBLE: Final[Mapping[bool, Literal["full", "none"]]] = {True: "full", False: "none"}


def picture(found: EveryCut) -> Figure:
    """The ratio over the path."""
    subject = f"{len(found.cases)} random cuts over the whole library; below 1 the table is better"
    figure = new_figure(8.0, 5.8, "Tables beside the best of the rules tuned for the same case", subject)
    place(figure, left=0.8, right=0.2, bottom=0.95, top=0.9)
    axes = figure.subplots()
    dress(axes, "", "path of a pass, m", "rms of the table / rms of the best rule")
    marks(axes, found.cases)
    logarithmic_y(axes, [1.0, *(case.best.ratio for case in found.cases)])
    legend_below(figure, handles(), len(KINDS) + len(FILL_OF_FEASIBLE))
    return figure


def marks(axes: Axes, cases: Sequence[CutFigures]) -> None:
    """A mark for each case."""
    for _, fewest, most, marker, colour in KINDS:
        for feasible, fill in FILL_OF_FEASIBLE.items():
            mine = [each for each in cases if fewest <= each.case.cars <= most and each.feasible is feasible]
            axes.plot(
                [each.length_m for each in mine], [each.best.ratio for each in mine], marker, color=colour,
                markersize=4.5, fillstyle=fill, linestyle="",
            )  # fmt: skip
    axes.axhline(1.0, color=INK, linewidth=1.0, linestyle="--")


def handles() -> list[Line2D]:
    """What markers and fillings stand for."""
    by_cars = [
        Line2D([], [], marker=marker, color=colour, linestyle="", markersize=5, label=name)
        for name, _, _, marker, colour in KINDS
    ]
    names = {True: "limit can be met", False: "limit cannot be met"}
    by_feasibility = [
        Line2D([], [], marker="o", color=INK, fillstyle=FILL_OF_FEASIBLE[feasible], linestyle="", markersize=5,
               label=name)
        for feasible, name in names.items()
    ]  # fmt: skip
    return by_cars + by_feasibility


def figures(found: EveryCut) -> Mapping[str, Figure]:
    """Ratios over the path."""
    return {"ratio": picture(found)}
