"""The numbers that drifts are counted from, and what each pass says for each drift: the logarithm of its
likelihood with the drift over that without, at many sizes.

The likelihood is that of the estimate (`likelihood_of`): there is no second physics for the watch.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np

from plant_models.frozen_arrays import Floats, Ints, frozen_arrays
from plant_models.library import SourcedValue
from synth.frame.faults import InputError
from synth.logs import unknowns as asked
from synth.logs.drift.causes import Cause
from synth.logs.estimate import estimate
from synth.logs.fitting_passes import FittingPasses
from synth.logs.likelihood import Innovations, Likelihood, likelihood_of
from synth.logs.unknowns import OF_VALVES, slope_of, unknowns_of

LEAST_REFERENCE = 200
"""Fewer passes leave errors in the numbers that look like drifts."""

LEAST_GAUGE_NOISE_KPA = 0.3


def configured(passes: FittingPasses, parameters: Sequence[SourcedValue]) -> tuple[dict[str, float], str]:
    """(numbers by key, key of the force slope) as configured.

    No configuration has the noise of the gauge: it is taken from `passes` by the median of what the gauge is off, which
    a drive that goes another way for some seconds a pass hardly moves.
    """
    unknowns = unknowns_of(passes, parameters)
    values, slope_key = {each.key: each.value(0.0) for each in unknowns}, slope_of(unknowns)
    if asked.GAUGE_NOISE in values:
        some = passes.taken(np.linspace(0, len(passes) - 1, min(len(passes), 300)).astype(np.int64))
        pressure = likelihood_of(some, slope_key).pressures(values)[1]
        off = some.log.pressure_kpa - pressure
        off = off[np.isfinite(off)]
        spread = float(np.median(np.abs(off - np.median(off)))) / 0.6744897501960817
        values[asked.GAUGE_NOISE] = max(spread, LEAST_GAUGE_NOISE_KPA)
    return values, slope_key


def require_enough(reference: FittingPasses) -> None:
    """`InputError` for a reference that is too short."""
    if len(reference) < LEAST_REFERENCE:
        raise InputError(
            f"the reference has {len(reference)} passes; give {LEAST_REFERENCE} or more of a position in order, so "
            "that an error of its numbers is not taken for a drift"
        )


def of_reference(
    reference: FittingPasses, parameters: Sequence[SourcedValue], values: dict[str, float], threads: int
) -> dict[str, float]:
    """`values`, with those in their place that make the passes of `reference` most likely."""
    found = estimate(reference, unknowns_of(reference, parameters), threads).values
    return values | {key: value for key, value in found.items() if key in values}


CHUNK = 250
"""Passes worked on at a time."""


@frozen_arrays
class Evidence:
    """Of m passes for c causes: `ratios[i]` (m, sizes of cause i), logarithms, 0 at the neutral size.

    `exit_m_s` (m,): speed of each pass at its last reading, as the filter knows it then.
    """

    causes: tuple[Cause, ...]
    ratios: tuple[Floats, ...]
    exit_m_s: Floats

    def __len__(self) -> int:
        return len(self.exit_m_s)

    def taken(self, numbers: Ints) -> Evidence:
        """Of some passes, in this order, with repetition where a number is given twice."""
        return replace(self, ratios=tuple(each[numbers] for each in self.ratios), exit_m_s=self.exit_m_s[numbers])


def evidence_of(
    passes: FittingPasses, values: Mapping[str, float], causes: Sequence[Cause], slope_key: str, threads: int = 1
) -> Evidence:
    """What `passes` say for drifts from the numbers `values`. The result does not depend on `threads`."""
    numbers = np.arange(len(passes))
    chunks = [passes.taken(numbers[i : i + CHUNK]) for i in range(0, len(passes), CHUNK)]
    with ThreadPoolExecutor(threads) as pool:
        parts = list(pool.map(lambda part: _of_chunk(likelihood_of(part, slope_key), values, causes), chunks))
    ratios = tuple(np.concatenate([part.ratios[i] for part in parts]) for i in range(len(causes)))
    return Evidence(tuple(causes), ratios, np.concatenate([part.exit_m_s for part in parts]))


def _of_chunk(likelihood: Likelihood, values: Mapping[str, float], causes: Sequence[Cause]) -> Evidence:
    pressures = likelihood.pressures(values)
    base = likelihood.at(values, pressures)
    passes = likelihood.passes
    known = base.log_likelihood(len(passes))
    found: dict[tuple[str, ...], Floats] = {}
    ratios = []
    for cause in causes:
        if not cause.keys:
            ratios.append(of_gauge_offset(base, passes, values, cause.sizes))
            continue
        if cause.keys not in found:
            same = None if set(cause.keys) & set(OF_VALVES) else pressures
            columns = [
                np.zeros(len(passes))
                if size == cause.scale.neutral
                else likelihood.at(cause.moved(values, size), same).log_likelihood(len(passes)) - known
                for size in cause.sizes
            ]
            found[cause.keys] = np.array(columns).T
        ratio = found[cause.keys]
        if cause.category:
            of_category = np.array([category == cause.category for category in passes.log.category])
            ratio = np.where(of_category[:, None], ratio, 0.0)
        ratios.append(ratio)
    return Evidence(tuple(causes), tuple(ratios), exit_speeds(base, passes, values))


def of_gauge_offset(
    base: Innovations, passes: FittingPasses, values: Mapping[str, float], sizes: Sequence[float]
) -> Floats:
    """The same for a gauge that shows too much by each of `sizes`: Σ (2 r d − d²)/2σ² of its readings, (m, sizes)."""
    read = int(np.isfinite(passes.log.pressure_kpa).sum())
    these = slice(base.readings, base.readings + read)
    where = base.pass_of[these]
    total = np.bincount(where, base.innovation[these], len(passes))
    count = np.bincount(where, minlength=len(passes))
    d = np.asarray(sizes)
    return np.asarray((total[:, None] * d - 0.5 * count[:, None] * d**2) / values[asked.GAUGE_NOISE] ** 2)


def exit_speeds(base: Innovations, passes: FittingPasses, values: Mapping[str, float]) -> Floats:
    """Filtered speed at the last reading of each pass, (m,), NaN where the filter never began.

    A correction moves the prediction by P/S of the innovation, so the rest, R/S, is what the reading is off after it.
    """
    speeds = np.full(len(passes), np.nan)
    rows = np.flatnonzero(np.isfinite(passes.log.speed_m_s))
    last = base.pass_of[: base.readings]
    at = np.concatenate((np.flatnonzero(np.diff(last) != 0), [len(last) - 1])) if len(last) else np.zeros(0, np.int64)
    reading_of_pass = np.full(len(passes), -1)
    reading_of_pass[passes.log.pass_of_row[rows]] = rows
    noise = spread_of_reading(passes, values) ** 2
    for number in at.tolist():
        one = int(last[number])
        reading = float(passes.log.speed_m_s[reading_of_pass[one]]) - values.get(asked.BIAS, 0.0)
        speeds[one] = reading - float(base.innovation[number] * noise / base.variance[number])
    return speeds


def spread_of_reading(passes: FittingPasses, values: Mapping[str, float]) -> float:
    """Standard deviation of one reading, m/s."""
    from plant_models.speed_sensor import measured_speed_std

    return measured_speed_std(values[asked.NOISE], passes.plant.sensor.resolution_m_s)
