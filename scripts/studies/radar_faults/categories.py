"""Figures of watched passes, each with its 95 % interval; and cuts that are told to be of their own class and of
others: how often that is noticed, and what it brings.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from plant_models import Plant
from scripts.studies.book import Measure
from scripts.studies.estimator.wrong_study import braking, weighing
from scripts.studies.radar_faults.findings import CategoryRow, Exits, FaultRow
from scripts.studies.radar_faults.watched_passes import WatchedPasses, passes_by_weight, watched_passes
from synth.problem.problem import OVERSPEED_M_S
from synth.simulation.closed_loop import TableController, close_loop
from synth.simulation.passes import ExitSample
from synth.simulation.random_passes import RandomPasses
from synth.simulation.replicates import Mean, mean_of, rms_of, rms_quotient, share_of
from tuning_tables.programs.decide import HEAVIER_ALARM, LIGHTER_ALARM, LOST_ALARM, SENSOR_ALARM


def fault_row(fault: str, target_m_s: float, before: WatchedPasses, after: WatchedPasses) -> FaultRow:
    """Both controllers in one fault, on the same passes."""
    weight, (first, last) = before.sample.weight, (before.sample, after.sample)
    stopped = last.stalled.astype(np.float64) - first.stalled
    fast = too_fast(last, target_m_s).astype(np.float64) - too_fast(first, target_m_s)
    errors, others = (each.exit_speed_m_s - target_m_s for each in (last, first))
    return FaultRow(
        fault=fault,
        before=exits_of(before, target_m_s, watches=False),
        after=exits_of(after, target_m_s, watches=True),
        stopped_more=measure(mean_of(stopped, weight)),
        too_fast_more=measure(mean_of(fast, weight)),
        rms_ratio=Measure(*rms_quotient(errors, others, weight)),
    )


def exits_of(passes: WatchedPasses, target_m_s: float, watches: bool) -> Exits:
    """One controller; `watches`: it has an estimator, and so alarms."""
    sample = passes.sample

    def alarm(bit: int) -> Measure | None:
        return Measure(*share_of((passes.seen & bit) != 0, sample.weight)) if watches else None

    return Exits(
        stopped=Measure(*share_of(sample.stalled, sample.weight)),
        too_fast=Measure(*share_of(too_fast(sample, target_m_s), sample.weight)),
        rms=rms_measure(sample, target_m_s),
        lost=alarm(LOST_ALARM),
        sensor=alarm(SENSOR_ALARM),
        category=alarm(LIGHTER_ALARM | HEAVIER_ALARM),
    )


def too_fast(sample: ExitSample, target_m_s: float) -> np.ndarray[tuple[int, ...], np.dtype[np.bool_]]:
    """Which passes leave above the limit."""
    return np.asarray(sample.exit_speed_m_s - target_m_s > OVERSPEED_M_S)


def rms_measure(sample: ExitSample, target_m_s: float) -> Measure:
    """rms of the exit; a cut that stops counts as exit speed 0."""
    return Measure(*rms_of(sample.exit_speed_m_s - target_m_s, sample.weight))


def measure(mean: Mean) -> Measure:
    """A mean with its interval."""
    return Measure(mean.value, mean.ci95)


@dataclass(frozen=True)
class CutClass:
    """A class of cuts and its table with estimator."""

    plant: Plant
    controller: TableController

    @property
    def name(self) -> str:
        """'52 t'."""
        return f"{self.plant.cut.mass_t:g} t"


def mistaken_for(cut: Plant, other: Plant) -> Plant:
    """What rolls is the cut of `cut`; the rest, with what may be commanded on the approach, is that of `other`."""
    return replace(other, cut=cut.cut, resistance=cut.resistance)


def mistaken_rows(classes: Sequence[CutClass], target_m_s: float, passes: RandomPasses) -> tuple[CategoryRow, ...]:
    """Every cut under the table of every class."""
    return tuple(
        row_of(cut, classes, told, "as it is", mistaken_for(cut.plant, told.plant), target_m_s, passes)
        for cut in classes for told in classes
    )  # fmt: skip


def own_rows(classes: Sequence[CutClass], target_m_s: float, passes: RandomPasses) -> tuple[CategoryRow, ...]:
    """Every cut told to be of its own class: what other tables take over there, they take over wrongly."""
    return tuple(
        row_of(each, classes, each, name, plant, target_m_s, passes)
        for each in classes for name, plant in variants(each.plant)
    )  # fmt: skip


def variants(plant: Plant) -> tuple[tuple[str, Plant], ...]:
    """The plant as it is, and others that the same table must serve."""
    return (
        ("as it is", plant),
        ("friction × 0.8", braking(plant, 0.8)),
        ("friction × 1.2", braking(plant, 1.2)),
        ("mass − 10 %", weighing(plant, 0.9)),
        ("mass + 10 %", weighing(plant, 1.1)),
    )


def row_of(
    cut: CutClass, classes: Sequence[CutClass], told: CutClass, name: str, plant: Plant, target_m_s: float,
    passes: RandomPasses,
) -> CategoryRow:  # fmt: skip
    """One cut told to be of one class, under its table alone and where tables of `classes` may take over."""
    loop = close_loop(plant, told.controller.stages)
    draws, number = loop.draws(passes), classes.index(told)
    alone = watched_passes(loop, told.controller, draws)
    by_weight = passes_by_weight(loop, [each.controller for each in classes], number, draws)
    weight = draws.weight
    return CategoryRow(
        f"{cut.name} to {target_m_s:g} m/s", told.name, name,
        Measure(*share_of((alone.at_end & (LIGHTER_ALARM | HEAVIER_ALARM)) != 0, weight)),
        rms_measure(alone.sample, target_m_s), Measure(*share_of(too_fast(alone.sample, target_m_s), weight)),
        Measure(*share_of(by_weight.table != number, weight)),
        rms_measure(by_weight.sample, target_m_s), Measure(*share_of(too_fast(by_weight.sample, target_m_s), weight)),
    )  # fmt: skip
