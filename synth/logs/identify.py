"""From a log to the numbers of its position: estimate, what of it the passes really tell and why the rest cannot
be told, and whether the model holds.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from plant_models.frozen_arrays import Floats, frozen_arrays
from synth.frame.faults import InputError
from synth.logs import unknowns as asked
from synth.logs.estimate import Estimate, estimate
from synth.logs.fitting_passes import FittingPasses
from synth.logs.likelihood import likelihood_of
from synth.logs.residual_tests import ResidualTest, residual_tests, wrong
from synth.logs.unknowns import slope_of, unknowns_of, values_at
from synth.retarder.configuration.resolved_config import ResolvedConfig

MOST_LEFT = 0.7
"""Of what was unknown before: a number of which more than this is still unknown, is not identified."""

CLOSE = 0.9
"""Correlation of the errors of two numbers from which on they are identified together better than apart."""

ALWAYS = (
    "Force slope and mean friction act by their product: the slope is identified for a mean friction of 1.",
    "Grade and mean running resistance act by their difference: resistance is identified for the configured grade.",
    "Computing delay and valve delays act by their sums: valve delays are those for the configured computing delay.",
)
"""What no log of passes can part, however long."""

WITHOUT_GAUGE = (
    "Without a pressure gauge delays, time constants and dead band are seen only by the motion: they are identified "
    "together much better than one by one."
)

SPEED_AS_PATH = "The path was summed up from the measured speed: what the sensor shows too much cannot be identified."


@dataclass(frozen=True)
class Finding:
    """One number: estimate, 95 % interval, what was taken before, and how much of what was unknown is `left` (0 to 1).

    `with_others`: (key, correlation) of numbers whose errors go with its own.
    """

    key: str
    unit: str
    value: float
    interval: tuple[float, float]
    before: float
    left: float
    with_others: tuple[tuple[str, float], ...]

    @property
    def identified(self) -> bool:
        """The passes tell it; if not, it stays as it was."""
        return self.left <= MOST_LEFT

    @property
    def within(self) -> bool:
        """What was taken before is inside the interval."""
        return self.interval[0] <= self.before <= self.interval[1]


def findings_of(found: Estimate) -> tuple[Finding, ...]:
    """All numbers of `found`."""
    # Of the law after the passes: the sandwich tells how the estimate scatters, not how much is known.
    left = np.sqrt(np.diag(np.linalg.inv(np.eye(len(found.u)) + found.information)))
    correlation = found.correlation()
    return tuple(_findings(found, left, correlation))


def _findings(found: Estimate, left: np.ndarray, correlation: np.ndarray) -> Iterator[Finding]:
    for number, unknown in enumerate(found.unknowns):
        others = tuple(
            (found.unknowns[i].key, float(correlation[number, i]))
            for i in np.argsort(-np.abs(correlation[number]))
            if i != number and abs(correlation[number, i]) >= CLOSE
        )
        yield Finding(
            unknown.key,
            "" if unknown.unit == "1" else unknown.unit,
            unknown.value(float(found.u[number])),
            found.interval(number),
            unknown.value(0.0),
            float(left[number]),
            others,
        )


def reasons(found: Estimate, path_is_independent: bool) -> tuple[str, ...]:
    """Why some numbers cannot be told, for a reader."""
    keys = {unknown.key for unknown in found.unknowns}
    more = () if asked.GAUGE_NOISE in keys else (WITHOUT_GAUGE,)
    return (*ALWAYS, *more, *(() if path_is_independent else (SPEED_AS_PATH,)))


LEAST_PASSES = 40
"""Fewer tell nothing of twenty numbers."""


@frozen_arrays
class Fit:
    """How well numbers describe n passes: friction ξ of each cut (m,), its standard deviation (m,), standardised
    innovations of the readings (k,), pressures at all rows (n,)."""

    friction: Floats
    friction_std: Floats
    innovations: Floats
    pressure_kpa: Floats

    @property
    def innovation_rms(self) -> float:
        """1 where the numbers are right."""
        return float(np.sqrt(np.mean(self.innovations**2)))


@dataclass(frozen=True, eq=False)
class Identified:
    """What the passes say. `before`, `after`: how well the numbers of the configuration and the identified ones fit."""

    config: ResolvedConfig
    passes: FittingPasses
    estimate: Estimate
    findings: tuple[Finding, ...]
    reasons: tuple[str, ...]
    tests: tuple[ResidualTest, ...]
    before: Fit
    after: Fit

    def __repr__(self) -> str:
        told = sum(finding.identified for finding in self.findings)
        holds = "the model does not hold" if self.wrong else "no test says that the model does not hold"
        return f"Identified({told} of {len(self.findings)} numbers identified from {len(self.passes)} passes; {holds})"

    @property
    def wrong(self) -> tuple[ResidualTest, ...]:
        """Tests that say that the model does not hold."""
        return wrong(self.tests)

    @property
    def origin(self) -> str:
        """Of the numbers, in words."""
        return f"{len(self.passes)} passes"


def require_enough(passes: FittingPasses) -> None:
    """`InputError` for too few passes."""
    if len(passes) < LEAST_PASSES:
        raise InputError(f"identify: the log has {len(passes)} sound passes; {LEAST_PASSES} are needed at least")


def identify(passes: FittingPasses, config: ResolvedConfig, threads: int) -> Identified:
    """Everything about one log; passes stopped by hand tell as much as others."""
    unknowns = unknowns_of(passes, config.parameters)
    found = estimate(passes, unknowns, threads)
    start = values_at(unknowns, np.zeros(len(unknowns)))
    gauge = {key: value for key, value in found.values.items() if key == asked.GAUGE_NOISE}
    return Identified(
        config, passes, found, findings_of(found), reasons(found, passes.log.path_is_independent),
        residual_tests(passes, found, threads),
        fit(passes, start | gauge, slope_of(unknowns)), fit(passes, found.values, slope_of(unknowns)),
    )  # fmt: skip


def fit(passes: FittingPasses, values: dict[str, float], slope_key: str) -> Fit:
    """How well `values` describe the passes."""
    at = likelihood_of(passes, slope_key).at(values)
    readings = at.innovation[: at.readings] / np.sqrt(at.variance[: at.readings])
    return Fit(at.cuts.friction, np.sqrt(at.cuts.friction_variance), readings, at.pressure_kpa)
