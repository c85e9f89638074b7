"""Figures of watched passes, each with its 95 % interval."""

from __future__ import annotations

import numpy as np

from scripts.studies.book import Measure
from scripts.studies.radar_faults.findings import Exits, FaultRow
from scripts.studies.radar_faults.watched_passes import WatchedPasses
from synth.problem.aim import OVERSPEED_M_S
from synth.simulation.passes import ExitSample
from synth.simulation.replicates import Mean, mean_of, rms_of, rms_quotient, share_of
from tuning_tables.programs.alarms import HEAVIER_ALARM, LIGHTER_ALARM, LOST_ALARM, SENSOR_ALARM


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
