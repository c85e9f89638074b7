"""The watch on the passes of a position: charts, and what is behind the first alarm."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from plant_models.frozen_arrays import Bools, Floats, Ints, frozen_arrays
from synth.logs import unknowns as asked
from synth.logs.drift.causes import causes_of
from synth.logs.drift.charts import CategoryExits, Charts, charts_of, running_medians
from synth.logs.drift.diagnosis import FURTHER, Diagnosis, DriftSize, diagnosed, drift_size
from synth.logs.drift.evidence import Evidence, evidence_of
from synth.logs.fitting_passes import FittingPasses
from synth.problem.problem import OVERSPEED_M_S


@dataclass(frozen=True)
class ExitCost:
    """Exits of `passes` passes with a known target: rms of exit speed − target, and the share above it by 0.3 m/s."""

    passes: int
    rms_m_s: float
    overspeed: float


@dataclass(frozen=True)
class Drift:
    """What is behind an alarm; pass numbers are those of the log that was given, from 0.

    `last`: the passes up to this one gave the size; `before`, `after` its beginning: what it costs.
    """

    diagnosis: Diagnosis
    size: DriftSize
    last: int
    before: ExitCost
    after: ExitCost


@frozen_arrays
class Watch:
    """Charts along the passes that nobody stopped by hand, `errors_m_s` (m,) of their exits, and the drift if any.

    Passes are numbered along these; `number_of` (m,): the pass of the log that each is.
    """

    passes: FittingPasses
    number_of: Ints
    evidence: Evidence
    charts: Charts
    errors_m_s: Floats
    drift: Drift | None

    @cached_property
    def full_brake(self) -> Bools:
        """Passes with the highest stage that their class may be given until their last row, (m,): they may have left
        too fast whatever the table."""
        log = self.passes.log
        top = np.array([plant.top_stage for _, plant in self.passes.plants])[self.passes.class_of]
        return np.asarray(log.stage[log.first_row[1:] - 1] >= top)

    @cached_property
    def exits(self) -> tuple[CategoryExits, ...]:
        """Of each weight category that has any with a known target."""
        category = np.array(self.passes.log.category)
        known = np.isfinite(self.errors_m_s)
        found = []
        for name in sorted(set(self.passes.log.category)):
            numbers = np.flatnonzero((category == name) & known)
            if len(numbers):
                errors = self.errors_m_s[numbers]
                found.append(CategoryExits(name, numbers, errors, running_medians(errors)))
        return tuple(found)


def watch(passes: FittingPasses, values: Mapping[str, float], slope_key: str, threads: int = 1) -> Watch:
    """Watch `passes` for drifts from the numbers `values`. The result does not depend on `threads`."""
    number_of = np.flatnonzero(~passes.log.stopped_by_hand)
    kept = passes.taken(number_of)
    causes = causes_of(kept, values, slope_key)
    evidence = evidence_of(kept, values, causes, slope_key, threads)
    return explained(kept, number_of, evidence, charts_of(evidence), values, slope_key)


def explained(
    passes: FittingPasses, number_of: Ints, evidence: Evidence, charts: Charts, values: Mapping[str, float],
    slope_key: str,
) -> Watch:  # fmt: skip
    """The watch on `passes` whose `evidence` and `charts` are known: what is behind the first alarm."""
    errors = evidence.exit_m_s - passes.log.target_m_s
    found = diagnosed(evidence, charts)
    if found is None:
        return Watch(passes, number_of, evidence, charts, errors, None)
    first, last = found.first, min(found.alarm + FURTHER, len(passes) - 1)
    with_it = passes.taken(np.arange(first.begin, last + 1))
    size = drift_size(with_it, values, first.cause, slope_key, first.size)
    if first.cause.keys == (asked.BIAS,):
        # The filter took the readings for true.
        errors = np.where(np.arange(len(passes)) >= first.begin, errors - size.size, errors)
    drift = Drift(found, size, last, cost_of(errors[: first.begin]), cost_of(errors[first.begin :]))
    return Watch(passes, number_of, evidence, charts, errors, drift)


def cost_of(errors_m_s: Floats) -> ExitCost:
    """Of the exit errors that are known; NaN of none."""
    known = errors_m_s[np.isfinite(errors_m_s)]
    if len(known) == 0:
        return ExitCost(0, float("nan"), float("nan"))
    return ExitCost(len(known), float(np.sqrt(np.mean(known**2))), float(np.mean(known > OVERSPEED_M_S)))
