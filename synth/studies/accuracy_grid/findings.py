"""What the study `accuracy-grid` has found: all cases, and the verdict."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from synth.studies.accuracy_grid.figures import Figures, GridCase
from synth.studies.accuracy_grid.limits import Limit, limits
from synth.studies.markdown_table import MarkdownTable, table
from synth.studies.study import Findings


@dataclass(frozen=True)
class Grid(Findings):
    """All cases, and the minutes that they took."""

    seed: int
    passes: int
    minutes: float
    cases: tuple[GridCase, ...]

    @property
    def known(self) -> tuple[tuple[GridCase, Figures], ...]:
        """The cases that are served, with their figures."""
        return tuple((case, case.figures) for case in self.cases if case.figures is not None)

    @property
    def verdict(self) -> tuple[Limit, ...]:
        """What is asked, found, met."""
        return limits(self.cases, self.minutes)

    def tables(self) -> Mapping[str, MarkdownTable]:
        """`limits`: a row a limit; `cases`: a row a case that is served."""
        verdict = [(each.asked, each.found if each.met else f"**{each.found}: not met**") for each in self.verdict]
        heads = ("case", "told", "told, with estimator", "with estimator", "table", "best baseline",
                 "predicted / simulated: with, without", "switchings: with, without, baseline")  # fmt: skip
        return {
            "limits": table("limits", ("asked", "found"), verdict),
            "cases": table("rms of the cases that are served, m/s", heads, (cells(*each) for each in self.known)),
        }

    def sentences(self) -> tuple[str, ...]:
        """How many cases."""
        return (
            f"{len(self.known)} of {len(self.cases)} cases are served, or too near to the limit to tell; "
            f"{self.passes} passes each, seed {self.seed}",
        )

    def faults(self) -> tuple[str, ...]:
        """Limits that are not met."""
        return tuple(f"not met: {each.asked}; found {each.found}" for each in self.verdict if not each.met)


def cells(case: GridCase, figures: Figures) -> tuple[str, ...]:
    """The cells of one case."""
    best = figures.best_baseline
    rms = (figures.told, figures.told_estimated, figures.estimated, figures.table)
    switchings = (figures.estimated, figures.table, figures.baselines[best])
    return (
        case.case, *(f"{each.rms_m_s:.4f}" for each in rms), f"{best} {figures.baselines[best].rms_m_s:.4f}",
        f"{figures.honesty_estimated:.2f}, {figures.honesty:.2f}",
        ", ".join(f"{each.switchings:.1f}" for each in switchings),
    )  # fmt: skip
