"""Shares of variance of every case: tables stay, the plant goes over the ranges of its parameters."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from plant_models.frozen_arrays import Floats
from synth.frame.faults import InputError
from synth.frame.printed_numbers import counted
from synth.frame.workers.engine import Tell
from synth.retarder.configuration.plant_values import Parameter
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.retarder.sensitivity.responses import OUTPUTS, FixedTables, Output, moving, responses, varied_parameters
from synth.retarder.sensitivity.shares import Estimates, Share, first_order, mean_estimates, noise_share
from synth.simulation.stratified_passes import stratified_passes

REPEATED = 100
"""Points that are simulated once more, with other passes."""

OTHER_PASSES = 1
"""Added to the seed for these."""


@dataclass(frozen=True)
class Trial:
    """`points` of the hypercube, `passes` at each, and the seed of both."""

    points: int
    passes: int
    seed: int


@dataclass(frozen=True)
class OutputShares:
    """Of one output over all points: mean, standard deviation, the shares of the inputs, and what remains.

    `together`: 1 − the sum of `shares` and `noise`: parameters that act together. `estimates`: what the shares are
    told from.
    """

    output: Output
    mean: float
    std: float
    shares: tuple[Share, ...]
    noise: Share
    together: Share
    estimates: Estimates
    noise_estimates: Estimates

    @property
    def varies(self) -> bool:
        """Whether there is any variance to share out."""
        return self.std > 0.0


@dataclass(frozen=True)
class CaseShares:
    """The outputs of one table, in the order of `OUTPUTS`; `nominal`: what they are where nothing varies."""

    label: str
    target_m_s: float
    nominal: tuple[float, ...]
    outputs: tuple[OutputShares, ...]


@dataclass(frozen=True)
class Sensitivity:
    """All cases; `keys` are those of the shares, `varied` the ranges by class. `overall`: means over the cases."""

    config: ResolvedConfig
    trial: Trial
    keys: tuple[str, ...]
    names: tuple[str, ...]
    varied: tuple[tuple[str, tuple[Parameter, ...]], ...]
    cases: tuple[CaseShares, ...]
    overall: tuple[OutputShares, ...]

    @property
    def held(self) -> tuple[str, ...]:
        """Keys that the user's configuration holds in every class."""
        return tuple(each.key for each in self.varied[0][1] if each.key not in self.keys)


def sensitivity(
    config: ResolvedConfig, fixed: Sequence[FixedTables], trial: Trial, threads: int, tell: Tell
) -> Sensitivity:
    """Simulate `fixed` over the ranges of their plants' parameters and share the variances out.

    `InputError` where nothing varies, `PlantError` where the ranges make an impossible plant.
    """
    every = [
        varied_parameters(config, each.cut_class, each.plant, max(table.target_speed_m_s for table in each.tables))
        for each in fixed
    ]
    keys = moving(every)
    if not keys:
        raise InputError("sensitivity: the configuration sets every number itself, so there is none to measure first")
    unit = unit_hypercube(len(keys), trial.points, trial.seed)
    cases: list[CaseShares] = []
    for each, varied in zip(fixed, every, strict=True):
        cases += class_shares(each, varied, keys, unit, trial, threads)
        tell(f"{each.cut_class.label}: {trial.points} plants, {counted(len(each.tables), 'table')}")
    names = {one.key: one.name for one in every[0]}
    return Sensitivity(
        config,
        trial,
        keys,
        tuple(names[key] for key in keys),
        tuple((each.cut_class.label, varied) for each, varied in zip(fixed, every, strict=True)),
        tuple(cases),
        tuple(mean_of_cases([case.outputs[i] for case in cases]) for i in range(len(OUTPUTS))),
    )


def class_shares(
    fixed: FixedTables, varied: Sequence[Parameter], keys: Sequence[str], unit: Floats, trial: Trial, threads: int
) -> list[CaseShares]:
    """The cases of one class."""
    by_key = {each.key: each for each in varied}
    passes = stratified_passes(trial.seed, 0, trial.passes)
    others = stratified_passes(trial.seed + OTHER_PASSES, 0, trial.passes)
    found = responses(fixed.plant, fixed.tables, by_key, keys, unit, passes, threads)
    again = responses(fixed.plant, fixed.tables, by_key, keys, unit[:REPEATED], others, threads)
    nominal = responses(fixed.plant, fixed.tables, {}, (), np.empty((1, 0)), passes, threads)
    return [
        CaseShares(
            fixed.cut_class.label,
            table.target_speed_m_s,
            tuple(nominal[i, :, 0].tolist()),
            tuple(output_shares(output, unit, found[i, o], again[i, o]) for o, output in enumerate(OUTPUTS)),
        )
        for i, table in enumerate(fixed.tables)
    ]


def output_shares(output: Output, unit: Floats, found: Floats, again: Floats) -> OutputShares:
    """The shares in `found` (points,), told from the points `unit` and the repeats `again`."""
    shares, noise = first_order(unit, found), noise_share(found, again)
    return shares_from(output, float(found.mean()), float(found.std()), shares, noise)


def shares_from(output: Output, mean: float, std: float, shares: Estimates, noise: Estimates) -> OutputShares:
    """The shares that the estimates tell."""
    both = Estimates(np.append(shares.whole, noise.whole), np.hstack([shares.without, noise.without]))
    told = tuple(shares.share(place) for place in range(len(shares.whole)))
    return OutputShares(output, mean, std, told, noise.share(0), both.rest.share(0), shares, noise)


def mean_of_cases(cases: Sequence[OutputShares]) -> OutputShares:
    """Means over the cases in which the output varies; over all where it does so nowhere."""
    counted = [case for case in cases if case.varies] or list(cases)
    return shares_from(
        cases[0].output,
        float(np.mean([case.mean for case in cases])),
        float(np.mean([case.std for case in cases])),
        mean_estimates([case.estimates for case in counted]),
        mean_estimates([case.noise_estimates for case in counted]),
    )


def unit_hypercube(parameters: int, points: int, seed: int) -> Floats:
    """Points of a Latin hypercube, (points, parameters), each number in [0, 1)."""
    from scipy.stats import qmc  # start-up: scipy only where it is needed

    unit: Floats = qmc.LatinHypercube(parameters, rng=np.random.default_rng(seed)).random(points)
    return unit


UNDECIDABLE = "not decidable with these passes"
MOST_NAMED = 3


def ranked(keys: Sequence[str], found: OutputShares) -> tuple[tuple[str, Share], ...]:
    """(key, share), the largest share first; equal ones in the order of the keys."""
    return tuple(sorted(zip(keys, found.shares, strict=True), key=lambda pair: -pair[1].value))


def measure_first(names: Sequence[str], found: OutputShares) -> str:
    """'measure first, for the rms exit error: … (24 % [20, 28] of its variance), …': at most three decided ones."""
    title = found.output.title
    if not found.varies:
        return f"the {title} is the same at every point, so nothing has to be measured for it"
    best = [(name, share) for name, share in ranked(names, found) if share.decided][:MOST_NAMED]
    if not best:
        return f"measure first, for the {title}: {UNDECIDABLE}; take more points"
    return f"measure first, for the {title}: " + "; ".join(f"{name}, {percent(share)}" for name, share in best)


def percent(share: Share) -> str:
    """'24 % [20, 28]'."""
    low, high = share.ci95
    return f"{100.0 * share.value:.0f} % [{100.0 * low:.0f}, {100.0 * high:.0f}]"
