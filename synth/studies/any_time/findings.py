"""What the study `unlocked` has found: controllers on common passes, and the surfaces of one stage."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from synth.simulation.replicates import Interval
from synth.studies.markdown_table import MarkdownTable, around, table
from synth.studies.near_target import NEAR_M_S, NearTarget
from synth.studies.study import Findings

LINES, CUBIC, SEARCHED = "locked lines", "locked cubic, polished", "locked cubic, searched"
SURFACES, FITTED, COMPACT = "unlocked surfaces", "unlocked fit", "unlocked compact"
PLAIN, ENERGY = "unlocked, no pressure", "energy rule"
NAMES = (LINES, CUBIC, SEARCHED, SURFACES, FITTED, COMPACT, PLAIN, ENERGY)
SHOWN = (SEARCHED, SURFACES, COMPACT, PLAIN, ENERGY)
"""Controllers of the pictures of gains."""


@dataclass(frozen=True)
class Ratio:
    """rms / rms of another controller on the same passes, with its 95 % interval (paired)."""

    value: float
    ci95: Interval

    @property
    def cell(self) -> str:
        """'0.87 [0.83, 0.90]'."""
        return around(self.value, self.ci95, 2)


@dataclass(frozen=True)
class Told:
    """One controller; ratios to the polished stage-locked cubics, of all passes and of those near the target."""

    rms_m_s: float
    rms_ci95_m_s: Interval
    near: NearTarget
    bias_m_s: float
    switchings: float
    stalled: float
    ratio: Ratio
    near_ratio: Ratio


@dataclass(frozen=True)
class CaseRow:
    """One case with valves so many times as fast: all controllers, and ratios of the compact one to others."""

    case: str
    valves: float
    predicted_cost_m2_s2: float
    seconds: float
    controllers: dict[str, Told]
    compact_to: dict[str, Ratio]


@dataclass(frozen=True)
class SurfaceMap:
    """Both surfaces of one commanded stage, over pressure (rows) and path (columns), None where there is no command.

    `compact`: its lines in the compact form, by side, power of the pressure and power of the path; None for no line.
    """

    case: str
    exit_m: float
    stage: int
    stage_kpa: float
    band_kpa: float
    path_m: tuple[float, ...]
    pressure_kpa: tuple[float, ...]
    lower_m_s: tuple[tuple[float | None, ...], ...]
    upper_m_s: tuple[tuple[float | None, ...], ...]
    compact: tuple[tuple[tuple[float, ...], ...] | None, ...]


@dataclass(frozen=True)
class Unlocked(Findings):
    """All cases."""

    config_sha256: str
    seed: int
    passes: int
    evaluations: int
    rows: tuple[CaseRow, ...]
    surface: SurfaceMap | None

    def tables(self) -> Mapping[str, MarkdownTable]:
        """`gains`: a row a case, what compares like with like; `rms`: all controllers; `ratios`: all ratios."""
        heads = ("valves", "case", CUBIC, SEARCHED, "compact", "no pressure", ENERGY, f"compact / {SEARCHED}",
                 f"compact / {ENERGY}", f"near: compact / {CUBIC}")  # fmt: skip
        every = ("valves", "case", *NAMES)
        to = (f"compact / {name}" for name in self.rows[0].compact_to)
        ratios = ("valves", "case", f"compact / {CUBIC}", "near", *to, f"{SURFACES} / {CUBIC}")
        return {
            "gains": table("rms, m/s / switchings a pass; ratios of the rms [95 %]", heads, map(gain_cells, self.rows)),
            "rms": table(
                f"rms [within {NEAR_M_S:g} m/s of the target], mm/s / switchings", every, map(rms_cells, self.rows)
            ),
            "ratios": table("ratios of the rms on the same passes [95 %]", ratios, map(ratio_cells, self.rows)),
        }

    def sentences(self) -> tuple[str, ...]:
        """How much was simulated, and how long it took."""
        longest = max(row.seconds for row in self.rows)
        return (
            f"{self.passes} stratified passes a controller, seed {self.seed}; {self.evaluations} evaluations a search",
            f"the longest case took {longest:.0f} s, two at a time",
        )


def gain_cells(row: CaseRow) -> tuple[str, ...]:
    """The cells of one case."""
    c = row.controllers
    rms = [f"{c[name].rms_m_s:.4f} / {c[name].switchings:.1f}" for name in (CUBIC, SEARCHED, COMPACT, PLAIN, ENERGY)]
    ratios = [row.compact_to[SEARCHED].cell, row.compact_to[ENERGY].cell, c[COMPACT].near_ratio.cell]
    return (f"× {row.valves:g}", row.case, *rms, *ratios)


def rms_cells(row: CaseRow) -> tuple[str, ...]:
    """All controllers of one case."""
    told = [row.controllers[name] for name in NAMES]
    cells = (f"{1e3 * t.rms_m_s:.1f} [{1e3 * t.near.rms_m_s:.1f}] / {t.switchings:.1f}" for t in told)
    return (f"× {row.valves:g}", row.case, *cells)


def ratio_cells(row: CaseRow) -> tuple[str, ...]:
    """All ratios of one case."""
    compact, surfaces = row.controllers[COMPACT], row.controllers[SURFACES]
    ratios = (compact.ratio, compact.near_ratio, *row.compact_to.values(), surfaces.ratio)
    return (f"× {row.valves:g}", row.case, *(ratio.cell for ratio in ratios))
