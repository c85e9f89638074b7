"""What the study `any-time` has found: controllers on common passes, and what permissions give."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from enum import Enum

from scripts.studies.near_target import NEAR_M_S
from scripts.studies.study import Findings, MarkdownTable, around, table
from synth.retarder.permissions.permission import Permission
from synth.simulation.replicates import Interval

CUBIC, POLISHED, PLAIN = "at rest, cubic", "any time, cubic and pressure", "any time, cubic"
ENERGY, ENERGY_AT_ANY_TIME = "energy rule", "energy rule, any time"
RULES = (ENERGY, ENERGY_AT_ANY_TIME)
NAMES = (CUBIC, POLISHED, PLAIN, *RULES)
"""Controllers of the table of gains."""


@dataclass(frozen=True)
class Ratio:
    """rms / rms of another controller on the same passes, with its 95 % interval (paired)."""

    value: float
    ci95: Interval

    @property
    def cell(self) -> str:
        """'0.87 [0.83, 0.90]'."""
        return around(self.value, self.ci95, 2)


class Ways(Enum):
    """When a regulator asks its lines; the values are those of the findings.

    `GAUGE`: at rest, where the gauge shows that the pressure commanded is reached; `TIMES`: at rest, where sound valves
    would have reached it; `ANY_TIME`: at every sample.
    """

    GAUGE = "at rest, by gauge"
    TIMES = "at rest, by times"
    ANY_TIME = "any time"


@dataclass(frozen=True)
class Way:
    """One regulator beside a stuck valve: rms, share of cuts outside `NEAR_M_S`, share of cuts that stall."""

    rms_m_s: float
    outside: float
    stalled: float


@dataclass(frozen=True)
class StuckFigures:
    """One fault of the valves: regulators by the value of `Ways`, and the rms at any time over those at rest."""

    ways: dict[str, Way]
    to_gauge: Ratio
    to_times: Ratio


@dataclass(frozen=True)
class SilentGauge:
    """Ratios of the rms where the gauge shows nothing.

    `going_on`: lines for any time, asked at every sample, over lines for rest; `waiting`: the same, asked at rest;
    `gain`: waiting over going on.
    """

    going_on: Ratio
    waiting: Ratio
    gain: Ratio


@dataclass(frozen=True)
class Told:
    """One controller; ratios to the polished stage-locked cubics, of all passes and of those near the target."""

    rms_m_s: float
    rms_ci95_m_s: Interval
    switchings: float
    ratio: Ratio
    near_ratio: Ratio


@dataclass(frozen=True)
class CaseRow:
    """One case with valves so many times as fast: all controllers, and ratios of the polished surfaces to others.

    `gauge`: rms with a gauge that shows so many times the true pressure, over that with a true one; `wrong`: rms over
    that of the cubics at rest where something else is wrong, by its name; `silent`: where the gauge shows nothing;
    `stuck`: where valves do not open, by their name. These three only with valves as they are.
    """

    case: str
    valves: float
    controllers: dict[str, Told]
    polished_to: dict[str, Ratio]
    gauge: dict[str, Ratio]
    wrong: dict[str, Ratio]
    silent: SilentGauge | None
    stuck: dict[str, StuckFigures]


@dataclass(frozen=True)
class PermissionRow:
    """One case as configured, with an approach if its position has one, and what permissions of the hardware give.

    `ratios`: rms over that of the table as configured, by name of the permission; `prediction_ratio`: predicted /
    simulated rms of commands at any time; `switchings_of`: by name of the permission.
    """

    case: str
    rms_m_s: float
    switchings: float
    ratios: dict[str, Ratio]
    prediction_ratio: float
    switchings_of: dict[str, float]


@dataclass(frozen=True)
class AnyTime(Findings):
    """All cases."""

    config_sha256: str
    seed: int
    passes: int
    rows: tuple[CaseRow, ...]
    permissions: tuple[PermissionRow, ...]

    def tables(self) -> Mapping[str, MarkdownTable]:
        """`permissions`: what they give beside tables as configured; `gains`: all controllers, a row a case.

        `gauge`: what a wrong one costs; `wrong`: what else may be wrong; `silent`, `stuck`: a gauge that shows nothing,
        valves that do not open.
        """
        heads = ("valves", "case", *NAMES, f"{POLISHED} / {CUBIC}", *(f"{POLISHED} / {rule}" for rule in RULES),
                 "the same near the target")  # fmt: skip
        asked_for = {name for row in self.permissions for name in row.ratios}
        names = [each.value for each in Permission if each.value in asked_for]
        granted = ("case", "rms, m/s / switchings", *names, "predicted / simulated, any time")
        told = (permission_cells(row, names) for row in self.permissions)
        wrong = ("valves", "case", *(f"shows × {factor}" for factor in self.rows[0].gauge))
        asked = {"permissions": table("rms of the table as configured; ratios to it [95 %]", granted, told)}
        return {
            **(asked if self.permissions else {}),
            "gains": table("rms, m/s / switchings a pass; ratios of the rms [95 %]", heads, map(gain_cells, self.rows)),
            "gauge": table("rms with a wrong gauge / with a true one [95 %]", wrong, map(gauge_cells, self.rows)),
            "wrong": table(f"rms of {POLISHED} / {CUBIC} where something is wrong [95 %]", *wrong_rows(self.rows)),
            "silent": table("rms where the gauge shows nothing [95 %]", SILENT_HEADS, silent_rows(self.rows)),
            "stuck": table("rms, m/s; ratios [95 %]; % of cuts", stuck_heads(), stuck_rows(self.rows)),
        }

    def sentences(self) -> tuple[str, ...]:
        """How much was simulated."""
        return (f"{self.passes} stratified passes a controller, seed {self.seed}",)


def gain_cells(row: CaseRow) -> tuple[str, ...]:
    """The cells of one case."""
    c = row.controllers
    rms = [f"{c[name].rms_m_s:.4f} / {c[name].switchings:.1f}" for name in NAMES]
    to_rules = (row.polished_to[rule].cell for rule in RULES)
    ratios = [c[POLISHED].ratio.cell, *to_rules, c[POLISHED].near_ratio.cell]
    return (f"× {row.valves:g}", row.case, *rms, *ratios)


def wrong_rows(rows: Sequence[CaseRow]) -> tuple[tuple[str, ...], Iterator[tuple[str, ...]]]:
    """A row for each thing that is wrong, a column for each case in which it was tried."""
    tried = [row for row in rows if row.wrong]
    heads = ("wrong", *(row.case for row in tried))
    return heads, ((name, *(row.wrong[name].cell for row in tried)) for name in (tried[0].wrong if tried else ()))


SILENT_HEADS = ("case", f"{POLISHED}, going on / {CUBIC}", f"the same, waiting / {CUBIC}", "waiting / going on")


def silent_rows(rows: Sequence[CaseRow]) -> Iterator[tuple[str, ...]]:
    """A row for each case in which the gauge was silent."""
    for row in rows:
        if row.silent is not None:
            yield row.case, row.silent.going_on.cell, row.silent.waiting.cell, row.silent.gain.cell


def stuck_heads() -> tuple[str, ...]:
    """Heads of the table of valves that do not open."""
    ways = " / ".join(way.value for way in Ways)
    ratios = (f"{Ways.ANY_TIME.value} / {way.value}" for way in (Ways.GAUGE, Ways.TIMES))
    return ("stuck", "case", f"rms, m/s: {ways}", *ratios, f"outside {NEAR_M_S:g} m/s, %", "stalled, %")


def stuck_rows(rows: Sequence[CaseRow]) -> Iterator[tuple[str, ...]]:
    """A row for each fault in each case in which valves were stuck; the regulators in the order of `Ways`."""
    tried = [row for row in rows if row.stuck]
    for name in tried[0].stuck if tried else ():
        for row in tried:
            found = row.stuck[name]
            ways = [found.ways[way.value] for way in Ways]
            yield (
                name, row.case, " / ".join(f"{way.rms_m_s:.4f}" for way in ways),
                found.to_gauge.cell, found.to_times.cell,
                " / ".join(f"{100 * way.outside:.1f}" for way in ways),
                " / ".join(f"{100 * way.stalled:.2f}" for way in ways),
            )  # fmt: skip


def gauge_cells(row: CaseRow) -> tuple[str, ...]:
    """What a wrong gauge costs."""
    return (f"× {row.valves:g}", row.case, *(ratio.cell for ratio in row.gauge.values()))


def permission_cells(row: PermissionRow, names: Sequence[str]) -> tuple[str, ...]:
    """The cells of one case as configured."""
    figures = f"{row.rms_m_s:.4f} / {row.switchings:.1f}"
    given = (f"{row.ratios[name].cell} / {row.switchings_of[name]:.1f}" for name in names)
    return (row.case, figures, *given, f"{row.prediction_ratio:.2f}")
