"""What the study `convergence` has found: levels of refinement."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

from synth.studies.markdown_table import MarkdownTable, table
from synth.studies.study import Findings


@dataclass(frozen=True)
class Level:
    """One grid: steps as a share of the default; rms of the solver's own lines and of one fixed cubic.

    `least_probability`: of the exit by the cubic, below 0 where interpolation ripples; `lines_move_m_s`: mean distance
    to the lines of the next level.
    """

    share: float
    own_rms_m_s: float
    cubic_rms_m_s: float
    least_probability: float
    lines_move_m_s: float | None


@dataclass(frozen=True)
class Refinement:
    """Levels of one kind of step, the coarsest first."""

    kind: str
    levels: tuple[Level, ...]


@dataclass(frozen=True)
class CaseRow:
    """One case: refinements of the design grid; prediction of the cubic on the check grid and on half its steps."""

    case: str
    default_own_rms_m_s: float
    refinements: tuple[Refinement, ...]
    check_rms_m_s: float
    halved_check_rms_m_s: float


@dataclass(frozen=True)
class Convergence(Findings):
    """All cases."""

    config_sha256: str
    cases: tuple[CaseRow, ...]

    def tables(self) -> Mapping[str, MarkdownTable]:
        """`together`: a row a case; `levels`: a row a case, step and level; `orders`: a row a case and step."""
        levels = [
            (case.case, each.kind, f"{level.share:g}", mm(level.own_rms_m_s, 2), mm(level.lines_move_m_s, 1),
             mm(level.cubic_rms_m_s, 2), f"{level.least_probability:.1e}")
            for case in self.cases for each in case.refinements for level in each.levels
        ]  # fmt: skip
        heads = ("case", "step", "share of the default", "solver's own lines", "lines move", "one fixed cubic",
                 "least probability")  # fmt: skip
        orders = [order_cells(case.case, each) for case in self.cases for each in case.refinements]
        return {
            "together": table(
                "rms in mm/s, all steps together at twice, once, half, a quarter of the default",
                ("case", "solver's own lines", "one fixed cubic", "table prediction: check grid / halved"),
                map(together_cells, self.cases),
            ),
            "levels": table("rms and how far lines move on the next halving, mm/s", heads, levels),
            "orders": table(
                "observed orders, and the default grid against the finest",
                ("case", "step", "own lines: orders", "default", "fixed cubic: orders", "default"), orders,
            ),
        }  # fmt: skip


def mm(value_m_s: float | None, digits: int) -> str:
    """A speed in mm/s."""
    return "–" if value_m_s is None else f"{1e3 * value_m_s:.{digits}f}"


def together_cells(case: CaseRow) -> tuple[str, ...]:
    """The cells of one case."""
    levels = next(each for each in case.refinements if each.kind == "all together").levels
    change = 100.0 * (case.check_rms_m_s / case.halved_check_rms_m_s - 1.0)
    return (
        case.case,
        ", ".join(f"{1e3 * level.own_rms_m_s:.3g}" for level in levels),
        ", ".join(f"{1e3 * level.cubic_rms_m_s:.3g}" for level in levels),
        f"{mm(case.check_rms_m_s, 1)} / {mm(case.halved_check_rms_m_s, 1)} ({change:+.1f} %)",
    )


def order_cells(case: str, refinement: Refinement) -> tuple[str, ...]:
    """The cells of one kind of step."""
    cells = [case, refinement.kind]
    for values in zip(*((level.own_rms_m_s, level.cubic_rms_m_s) for level in refinement.levels), strict=True):
        cells.append(", ".join("–" if x is None else f"{x:.1f}" for x in orders(values)))
        cells.append(f"{100.0 * (values[1] / values[-1] - 1.0):+.2f} %")
    return tuple(cells)


def orders(values: Sequence[float]) -> list[float | None]:
    """Observed orders log2(d1/d2) of successive differences; None where one of them is 0."""
    d = [abs(b - a) for a, b in pairwise(values)]
    return [math.log2(a / b) if a > 0.0 and b > 0.0 else None for a, b in pairwise(d)]
