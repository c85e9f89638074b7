"""The numbers that drifts are counted from: those of the configuration, or of passes known to be in order."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from plant_models.library import SourcedValue
from synth.frame.input_error import InputError
from synth.logs import unknowns as asked
from synth.logs.estimate import estimate
from synth.logs.fitting_passes import FittingPasses
from synth.logs.likelihood import likelihood_of
from synth.logs.unknowns import slope_of, unknowns_of

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
