"""What a tune for a radar finds out about one case (cut class × target speed): its table, what that is compared with,
what becomes of it off nominal, and what less time in the position costs. Plain values, no kernel behind them.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np

from plant_models.frozen_arrays import frozen_arrays
from synth.problem.requirement import Finding
from synth.retarder.comparison.measured import Comparison, Measured
from synth.retarder.tuned_case import Feasibility, GridCheck, TunedCase
from synth.simulation.exit_statistics import ExitStatistics
from synth.simulation.replicates import Interval
from synth.solver.switching_lines import SwitchingLines
from synth.solver.tabulate import lines_of
from tuning_tables import ControllerTable

if TYPE_CHECKING:
    from synth.retarder.tuned_table import AnyEstimate


@dataclass(frozen=True)
class Outcome:
    """`change`: what differs from the plant of the table; figures of `passes` passes of it, with 95 % intervals.

    `ratio`: rms / rms of the same passes on the plant of the table (paired), None where these have no error.
    `overspeed`: share that leaves more than 0.3 m/s too fast, `stalled`: that stops inside.
    """

    change: str
    passes: int
    rms_m_s: float
    rms_ci95_m_s: Interval
    ratio: float | None
    ratio_ci95: Interval | None
    overspeed: float
    overspeed_ci95: Interval
    stalled: float
    stalled_ci95: Interval


@dataclass(frozen=True)
class OffNominal:
    """`outcome` of the condition `key`, called `name`; None where no such plant can be, and `impossible` says why."""

    key: str
    name: str
    outcome: Outcome | None
    impossible: str = ""


PRICES_M2_S3: Final = (0.0, 1e-5, 3e-5, 1e-4, 3e-4, 1e-3)
"""What a second costs, from nothing on."""

NEARLY_FREE: Final = 1.01
"""A price is nearly free that makes no rms larger by more than this factor, beyond its 95 % interval."""


@dataclass(frozen=True)
class ParetoPoint:
    """A table for one price of a second; `ratio`: its rms over that of the table for the lowest price, paired."""

    time_price_m2_s3: float
    statistics: ExitStatistics
    predicted_rms_m_s: float
    ratio: float
    ratio_ci95: Interval


@dataclass(frozen=True)
class ParetoFront:
    """The points of one case by rising price; prices for which no table can be made are left out."""

    label: str
    target_speed_m_s: float
    points: tuple[ParetoPoint, ...]

    @property
    def name(self) -> str:
        """'gondola-4-22t to 3 m/s'."""
        return f"{self.label} to {self.target_speed_m_s:g} m/s"

    def at(self, time_price_m2_s3: float) -> ParetoPoint | None:
        """The point of a price, if it has one."""
        return next((each for each in self.points if each.time_price_m2_s3 == time_price_m2_s3), None)

    def saved_s(self, point: ParetoPoint) -> float:
        """How much sooner cuts leave than at the lowest price, in the mean."""
        return self.points[0].statistics.time_s - point.statistics.time_s


def nearly_free(fronts: Sequence[ParetoFront]) -> float:
    """The highest price up to which each is nearly free; the lowest if none is."""
    free = PRICES_M2_S3[0]
    for price in PRICES_M2_S3:
        found = [point for front in fronts if (point := front.at(price)) is not None]
        if len(found) < len(fronts) or any(point.ratio_ci95[0] > NEARLY_FREE for point in found):
            break
        free = price
    return free


def told(fronts: Sequence[ParetoFront]) -> str:
    """What is nearly free, in a sentence."""
    price, more = nearly_free(fronts), f"{NEARLY_FREE - 1.0:.0%}"
    if price == PRICES_M2_S3[0]:
        return (
            f"Already a price of {PRICES_M2_S3[1]:g} m2/s3 on a second makes some rms more than {more} larger beyond "
            "its 95 % interval, or leaves a case without a table (criterion.time_price_m2_s3)."
        )
    change = [-front.saved_s(point) for front in fronts if (point := front.at(price)) is not None]
    return (
        f"A price of {price:g} m2/s3 on a second makes no rms more than {more} larger beyond its 95 % interval, and "
        f"changes the mean time in the position by {min(change):+.2f} to {max(change):+.2f} s "
        "(criterion.time_price_m2_s3)."
    )


LINE_NODES = 301


@frozen_arrays
class CaseResult(TunedCase):
    """One case of tables with lines or surfaces, and beside its closed loop everything that it is compared with.

    `grid`: whether the grid of the design for the measured speed and commands at rest is to be believed; `finding`:
    what the criterion's requirement took; `estimate`: where an estimator is asked for, how its lines were designed;
    `ties`: see `share_of_ties`; `front`: where it is asked for, what less time in the position costs; `off_nominal`:
    what the table does on other plants than its own.
    """

    table: ControllerTable
    grid: GridCheck
    finding: Finding | None
    estimate: AnyEstimate | None
    comparison: Comparison
    feasibility: Feasibility
    ties: float
    front: ParetoFront | None
    off_nominal: tuple[OffNominal, ...]

    @property
    def table_lines(self) -> SwitchingLines:
        """The lines of the table, sampled densely."""
        return lines_of(self.table, np.linspace(self.plant.start_m, self.plant.exit_m, LINE_NODES))

    @property
    def controllers(self) -> tuple[Measured, ...]:
        """All controllers that had the passes: the table first."""
        return (self.measured, *self.comparison.entries)

    @property
    def remarks(self) -> tuple[str, ...]:
        """See `TunedCase`."""
        return () if self.finding is None else (self.finding.sentence,)

    @property
    def warnings(self) -> tuple[str, ...]:
        """See `TunedCase`."""
        found = list(super().warnings)
        if not self.grid.is_believed:
            found.append(
                f"on the grid of its design the rms is {self.grid.design_rms_m_s:.4f} m/s, without it "
                f"{self.grid.independent_rms_m_s:.4f}: there may be better lines; lower grid.speed_step_m_s"
            )
        sensor = self.plant.sensor
        if sensor.missed_share > 0.0 and self.table.predicted.passes is None:
            found.append(
                f"the prediction of the table counts on every reading, but {100.0 * sensor.missed_share:g} % are lost "
                "(sensor.missed_share): the simulation knows it, and regulator.estimator = true predicts with it"
            )
        return tuple(found)


def fronts_of(cases: Iterable[CaseResult]) -> tuple[ParetoFront, ...]:
    """What less time in the position costs, by case, where that was asked for."""
    return tuple(case.front for case in cases if case.front is not None)
