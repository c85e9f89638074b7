"""What a table does on another plant than it was tuned for: wrong parameters, worn parts, faulty sensors.

For each case: every assumed parameter at −50 % and +50 % and at the ends of its sensible range, the strongest swept in
steps of 5 %, all assumed parameters together, named conditions of service; the same passes everywhere. The strongest
parameters, the ends of sensible ranges that hurt, the named plants and points of the sweeps also with a table tuned for
the true plant.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from scripts.studies.cases import Case, named_cases
from scripts.studies.entrance import from_the_entrance
from scripts.studies.options import option
from scripts.studies.robustness.condition import conditions
from scripts.studies.robustness.experiments import one_at_a_time, sweep, together
from scripts.studies.robustness.findings import CaseRow, EndsRow, OutcomeRow, Robustness, SweepRow
from scripts.studies.robustness.perturbation import Perturbation, ends_by, one_off, sensible_ends
from scripts.studies.robustness.sensor_fault import no_fault
from scripts.studies.robustness.trial import Trial, trial_of
from scripts.studies.side_by_side import side_by_side
from scripts.studies.study import Method, Tell
from scripts.studies.tuned_table import tuned_table
from synth.configuration.plant_parameter import LEFT_OUT, Parameter, parameters
from synth.configuration.resolved_config import ResolvedConfig
from synth.simulation.stratified_passes import stratified_passes

FRESH = 15485863
"""Added to the configured seed: passes that no tuning has seen."""

HALF, WORST_TUNED, TUNED_SWEEPS, RETUNED_AT = 0.5, 3, 2, (-0.5, -0.25, 0.25, 0.5)

WORTH_TUNING = 1.1
"""Ends of sensible ranges with a larger rms ratio are also tuned for."""


@dataclass(frozen=True)
class Options:
    """What is studied."""

    config: Path | None = option(None, "configuration; the built-in default book without it")
    cases: tuple[str, ...] = option(("22:2", "52:3", "85:4"), "mass, t : target, m/s")
    passes: int = option(20_000, "passes on each plant", (200, 10**6))
    swept: int = option(4, "strongest parameters that are swept", (1, 20))
    steps: int = option(10, "steps of a sweep on either side of the nominal value, up to 50 %", (1, 50))
    spans: tuple[float, ...] = option((0.2, 0.5), "of all parameters together", (0.01, 0.5))
    points: int = option(400, "of each Latin hypercube", (10, 10**5))
    point_passes: int = option(5000, "passes at a point of a Latin hypercube", (200, 10**6))
    no_retuning: bool = option(False, "tune no table for a true plant")


@dataclass(frozen=True)
class Bench:
    """A case with its trial, its parameters, the named conditions, and one parameter at a time already off."""

    trial: Trial
    parameters: Mapping[str, Parameter]
    named: tuple[Perturbation, ...]
    halves: tuple[EndsRow, ...]
    sensible: tuple[EndsRow, ...]


def run(options: Options, tell: Tell) -> Robustness:
    """Tune the tables, then change what is under them."""
    config = from_the_entrance(options.config)
    seed = config.validation.seed + FRESH
    benches = []
    for case in named_cases(config, options.cases):
        benches.append(bench_of(case, config, seed, options.passes))
        tell(f"{case.name}: one parameter at a time")
    keys = strongest([bench.halves for bench in benches])[: options.swept]
    rows = []
    for bench in benches:
        rows.append(case_row(bench, keys, config, options))
        tell(f"{bench.trial.label}: {len(rows[-1].conditions)} conditions, {len(rows[-1].sweeps)} sweeps, hypercubes")
    return Robustness(config.sha256, seed, options.passes, config.acceptance.rms_m_s, dict(LEFT_OUT), tuple(rows))


def bench_of(case: Case, config: ResolvedConfig, seed: int, passes: int) -> Bench:
    """The table of a case on its nominal plant, and with one parameter at a time off."""
    table = tuned_table(config, case.plant, case.target_m_s)
    trial = trial_of(case.name, table, case.plant, stratified_passes(seed, 0, passes))
    cut_class = next(each for each in config.cuts if each.label == case.label)
    every = {p.key: p for p in parameters(config, cut_class, case.plant, case.target_m_s)}
    named = conditions(case.plant, every["cut.mass_t"], seed)
    ranged = [p for p in every.values() if p.sensible is not None]
    halves = one_at_a_time(trial, list(every.values()), ends_by(HALF))
    return Bench(trial, every, named, halves, one_at_a_time(trial, ranged, sensible_ends))


def strongest(cases: Sequence[Sequence[EndsRow]]) -> list[str]:
    """Keys of the assumed parameters by the geometric mean over the cases of their worse rms ratio."""
    effect: dict[str, float] = {}
    for row in (row for case in cases for row in case):
        if row.assumed and row.nominal != 0.0:
            effect[row.key] = effect.get(row.key, 0.0) + math.log(row.worst.ratio)
    return sorted(effect, key=lambda key: -effect[key])


def case_row(bench: Bench, keys: Sequence[str], config: ResolvedConfig, options: Options) -> CaseRow:
    """All of one case."""
    trial, plant = bench.trial, bench.trial.plant
    swept = [bench.parameters[key] for key in keys]
    points = {p.key: [(x, one_off(plant, p, x)) for x in RETUNED_AT] for p in swept[:TUNED_SWEEPS]}
    hurt = list(worth_tuning(bench, points))
    tuned = {} if options.no_retuning else tuned_for(config, trial, hurt)
    steps = [round(HALF * i / options.steps, 6) for i in range(-options.steps, options.steps + 1)]
    few = trial.first(min(options.passes, options.point_passes))
    every = list(bench.parameters.values())
    return CaseRow(
        case=trial.label,
        nominal=trial.outcome(Perturbation("nominal")),
        halves=tuple(with_ends_tuned(row, tuned) for row in bench.halves),
        sensible=tuple(with_ends_tuned(row, tuned) for row in bench.sensible),
        conditions=tuple(with_tuned(outcome, tuned) for outcome in side_by_side(trial.outcome, bench.named)),
        sweeps=tuple(
            with_points(sweep(trial, p, steps, config.acceptance.rms_m_s), points.get(p.key, ()), tuned) for p in swept
        ),
        together=tuple(
            together(few, every, span, options.points, config.validation.seed) for span in options.spans
        ),
    )  # fmt: skip


def worth_tuning(bench: Bench, points: Mapping[str, Sequence[tuple[float, Perturbation]]]) -> list[Perturbation]:
    """The perturbations that tables are also tuned for, each once."""
    plant, by_key = bench.trial.plant, bench.parameters
    worst = [
        one_off(plant, by_key[row.key], -HALF if row.worst is row.less else HALF) for row in bench.halves[:WORST_TUNED]
    ]
    plants = [p for p in bench.named if p.fault is no_fault]
    ends = {p.name: p for row in bench.sensible for p in sensible_ends(plant, by_key[row.key])}
    hurt = [ends[row.worst.name] for row in bench.sensible if row.worst.ratio > WORTH_TUNING]
    swept = [p for each in points.values() for _, p in each]
    return list({p.name: p for p in [*worst, *plants, *hurt, *swept]}.values())


def tuned_for(config: ResolvedConfig, trial: Trial, wanted: Sequence[Perturbation]) -> dict[str, OutcomeRow]:
    """What tables tuned for the true plants do there, by the name of the perturbation."""

    def one(perturbation: Perturbation) -> OutcomeRow:
        table = tuned_table(config, perturbation.change(trial.plant), trial.target_m_s)
        return trial.outcome(perturbation, table)

    return {p.name: outcome for p, outcome in zip(wanted, side_by_side(one, wanted), strict=True)}


def with_tuned(outcome: OutcomeRow, tuned: Mapping[str, OutcomeRow]) -> OutcomeRow:
    """`outcome` with the rms of the table tuned for its plant, if there is one."""
    best = tuned.get(outcome.name)
    if best is None:
        return outcome
    return replace(outcome, retuned_rms_m_s=best.rms_m_s, retuned_ci95_m_s=best.rms_ci95_m_s)


def with_ends_tuned(row: EndsRow, tuned: Mapping[str, OutcomeRow]) -> EndsRow:
    """`with_tuned` of both ends."""
    return replace(row, less=with_tuned(row.less, tuned), more=with_tuned(row.more, tuned))


def with_points(
    row: SweepRow, points: Sequence[tuple[float, Perturbation]], tuned: Mapping[str, OutcomeRow]
) -> SweepRow:
    """`row` with the rms of tables tuned for some of its points."""
    return replace(row, retuned=tuple((x, tuned[p.name].rms_m_s) for x, p in points if p.name in tuned))


SMALLEST = Options(cases=("52:3",), passes=200, swept=1, steps=1, spans=(0.2,), points=10, point_passes=200,
                   no_retuning=True)  # fmt: skip
METHOD = Method(Options, SMALLEST, Robustness, run)
