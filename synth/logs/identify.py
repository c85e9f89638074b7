"""From a log to the numbers of its position: estimate, what it tells, and whether the model holds."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from plant_models.frozen_arrays import Floats, frozen_arrays
from synth.frame.input_error import InputError
from synth.logs import unknowns as asked
from synth.logs.estimate import Estimate, estimate
from synth.logs.fitting_passes import FittingPasses
from synth.logs.identifiability import Finding, findings_of, reasons
from synth.logs.likelihood import likelihood_of
from synth.logs.residual_tests import ResidualTest, residual_tests, wrong
from synth.logs.unknowns import slope_of, unknowns_of, values_at
from synth.retarder.configuration.resolved_config import ResolvedConfig

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
