"""What the study `approach` has found, and its tables."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from scripts.studies.approach.pair import Figures, Rival
from scripts.studies.markdown_table import ABSENT, MarkdownTable, around, plus_minus, table
from scripts.studies.study import Findings
from synth.simulation.replicates import Interval


@dataclass(frozen=True)
class CaseRow:
    """One case from the entrance and from before it, with the best rule of thumb of each; `ratio`: rms / rms.

    `served_m_s`: the highest entry speed that the position can serve, without and with.
    """

    case: str
    without: Figures
    ahead: Figures
    ratio: float
    ratio_ci95: Interval
    rival_without: Rival
    rival: Rival
    served_m_s: tuple[float | None, float | None]


@dataclass(frozen=True)
class LengthRow:
    """rms of one case by the length of the approach."""

    case: str
    rms_m_s: tuple[float, ...]
    rms_ci95_m_s: tuple[Interval, ...]


@dataclass(frozen=True)
class AtEntrance:
    """rms of one case, with this stage allowed at the entrance."""

    case: str
    stage: int
    rms_m_s: float
    rms_ci95_m_s: Interval


@dataclass(frozen=True)
class FoundClosed:
    """rms where the regulator finds the brake at `stage`, and over that of a released brake, same table and passes."""

    case: str
    stage: int
    rms_m_s: float
    ratio: float
    ratio_ci95: Interval


@dataclass(frozen=True)
class Approaches(Findings):
    """All parts."""

    config_sha256: str
    seed: int
    passes: int
    length_m: float
    lengths_m: tuple[float, ...]
    cases: tuple[CaseRow, ...]
    by_length: tuple[LengthRow, ...]
    at_entrance: tuple[AtEntrance, ...]
    found_closed: tuple[FoundClosed, ...]

    def tables(self) -> Mapping[str, MarkdownTable]:
        """`gain`, `rivals`: a row a case; `length`: a column a length; `entrance`, `closed`: a row a stage."""
        ahead = f"from {self.length_m:g} m before it"
        stages = sorted({row.stage for row in self.at_entrance})
        by_case = dict.fromkeys(row.case for row in self.at_entrance)
        return {
            "gain": table(
                "rms, m/s ± half its 95 % interval; ratio of the two rms; cuts in 10 000 that no table "
                "stops; highest entry speed served, m/s",
                ("case", "from the entrance", ahead, "ratio", "brake saturated", "served up to"),
                map(gain_cells, self.cases),
            ),
            "rivals": table(
                "rms of the table / rms of the best tuned rule of thumb that may act from the same place",
                ("case", "from the entrance", ahead),
                ((row.case, rival_cell(row.rival_without), rival_cell(row.rival)) for row in self.cases),
            ),
            "length": table(
                "rms by the length of the approach, m/s ± half its 95 % interval",
                ("case", *(f"{x:g} m" for x in self.lengths_m)),
                ((row.case, *map(rms_cell, row.rms_m_s, row.rms_ci95_m_s)) for row in self.by_length),
            ),
            "entrance": table(
                "rms by the highest stage allowed at the entrance, m/s ± half its 95 % interval",
                ("case", *(f"stage {stage}" for stage in stages)),
                ((case, *self.entrance_cells(case, stages)) for case in by_case),
            ),
            "closed": table(
                "the same table where the brake is still at a stage when the regulator takes over: rms, m/s; over that "
                "of a released brake, 95 % interval",
                ("case", "stage", "rms", "ratio"),
                ((r.case, str(r.stage), f"{r.rms_m_s:.4f}", around(r.ratio, r.ratio_ci95, 3))
                 for r in self.found_closed),
            ),
        }  # fmt: skip

    def entrance_cells(self, case: str, stages: list[int]) -> list[str]:
        """The cells of one case, by stage."""
        mine = {row.stage: rms_cell(row.rms_m_s, row.rms_ci95_m_s) for row in self.at_entrance if row.case == case}
        return [mine.get(stage, ABSENT) for stage in stages]

    def sentences(self) -> tuple[str, ...]:
        """How much was simulated, and what lost."""
        lost = [row.case for row in self.cases if row.rival.table_ratio_ci95[0] > 1.0]
        return (
            f"{self.passes} stratified passes of seed {self.seed}, the same cuts in every column",
            f"a rule of thumb that acts from the same place is better beyond its interval: {', '.join(lost) or 'none'}",
        )

    def faults(self) -> tuple[str, ...]:
        """Cases that the approach makes worse beyond the interval."""
        worse = (row for row in self.cases if row.ratio_ci95[0] > 1.0)
        return tuple(f"{row.case}: worse with approach, ratio {around(row.ratio, row.ratio_ci95, 3)}" for row in worse)


def gain_cells(row: CaseRow) -> tuple[str, ...]:
    """The cells of one case."""
    served = " → ".join(ABSENT if speed is None else f"{speed:.2f}" for speed in row.served_m_s)
    return (
        row.case, rms_cell(row.without.rms_m_s, row.without.rms_ci95_m_s),
        rms_cell(row.ahead.rms_m_s, row.ahead.rms_ci95_m_s), around(row.ratio, row.ratio_ci95, 3),
        f"{in_10_000(row.without.brake_saturated)} → {in_10_000(row.ahead.brake_saturated)}", served,
    )  # fmt: skip


def in_10_000(share: float) -> str:
    """'184' or '7.5': of 10 000 cuts."""
    return f"{1e4 * share:.0f}" if share >= 0.01 else f"{1e4 * share:.2g}"


def rms_cell(rms_m_s: float, ci95_m_s: Interval) -> str:
    """'0.0382 ± 0.0004'."""
    return plus_minus(rms_m_s, ci95_m_s, 4)


def rival_cell(rival: Rival) -> str:
    """'0.78 [0.76, 0.80] (energy rule)'."""
    return f"{around(rival.table_ratio, rival.table_ratio_ci95, 2)} ({rival.name})"
