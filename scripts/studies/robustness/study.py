"""What a table does on another plant than it was tuned for: worn parts, another cut, numbers of the library's range.

For each case: named conditions of service, and every parameter at the ends of its sensible range; the same passes
everywhere. The named plants and the ends that hurt also with a table tuned for the true plant.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from plant_models import Plant
from scripts.studies.cases import Case, named_cases
from scripts.studies.entrance import from_the_entrance
from scripts.studies.options import option
from scripts.studies.robustness.condition import conditions
from scripts.studies.robustness.findings import CaseRow, EndsRow, OutcomeRow, Robustness
from scripts.studies.robustness.perturbation import Perturbation, sensible_ends
from scripts.studies.robustness.trial import Trial, trial_of
from scripts.studies.side_by_side import side_by_side
from scripts.studies.study import Method, Tell
from scripts.studies.tuned_table import tuned_table
from synth.retarder.configuration.plant_parameter import Parameter, parameters
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.simulation.stratified_passes import stratified_passes

FRESH = 15485863
"""Added to the configured seed: passes that no tuning has seen."""

WORTH_TUNING = 1.1
"""Ends of sensible ranges with a larger rms ratio are also tuned for."""


@dataclass(frozen=True)
class Options:
    """What is studied."""

    config: Path | None = option(None, "configuration; the built-in default book without it")
    cases: tuple[str, ...] = option(("22:2", "52:3", "85:4"), "mass, t : target, m/s")
    passes: int = option(20_000, "passes on each plant", (200, 10**6))
    no_retuning: bool = option(False, "tune no table for a true plant")


def run(options: Options, tell: Tell) -> Robustness:
    """Tune the tables, then change what is under them."""
    config = from_the_entrance(options.config)
    seed = config.validation.seed + FRESH
    rows = []
    for case in named_cases(config, options.cases):
        rows.append(case_row(case, config, seed, options))
        tell(f"{case.name}: {len(rows[-1].conditions)} conditions, {len(rows[-1].sensible)} parameters")
    return Robustness(config.sha256, seed, options.passes, tuple(rows))


def case_row(case: Case, config: ResolvedConfig, seed: int, options: Options) -> CaseRow:
    """The table of a case on its nominal plant, under the named conditions, and with one parameter at a time off."""
    plant = case.plant
    table = tuned_table(config, plant, case.target_m_s)
    trial = trial_of(case.name, table, plant, stratified_passes(seed, 0, options.passes))
    cut_class = next(each for each in config.cuts if each.label == case.label)
    every = {p.key: p for p in parameters(config, cut_class, plant, case.target_m_s)}
    named = conditions(plant, every["cut.mass_t"])
    sensible = one_at_a_time(trial, [p for p in every.values() if p.sensible is not None])
    wanted = [*named, *ends_that_hurt(plant, every, sensible)]
    tuned = {} if options.no_retuning else tuned_for(config, trial, wanted)
    return CaseRow(
        case=trial.label,
        nominal=trial.outcome(Perturbation("nominal")),
        sensible=tuple(with_ends_tuned(row, tuned) for row in sensible),
        conditions=tuple(with_tuned(outcome, tuned) for outcome in side_by_side(trial.outcome, named)),
    )


def one_at_a_time(trial: Trial, ranged: Sequence[Parameter]) -> tuple[EndsRow, ...]:
    """Every parameter at both ends of its sensible range, the largest rms first."""

    def both(parameter: Parameter) -> EndsRow:
        low, high = sensible_ends(trial.plant, parameter)
        values = low.value, high.value
        return EndsRow(
            parameter.key, parameter.name, parameter.nominal, values, trial.outcome(low), trial.outcome(high)
        )

    return tuple(sorted(side_by_side(both, ranged), key=lambda row: -row.worst.rms_m_s))


def ends_that_hurt(plant: Plant, by_key: Mapping[str, Parameter], sensible: Sequence[EndsRow]) -> list[Perturbation]:
    """The worse ends of the ranges that tables are also tuned for."""
    ends = {end.name: end for row in sensible for end in sensible_ends(plant, by_key[row.key])}
    return [ends[row.worst.name] for row in sensible if row.worst.ratio > WORTH_TUNING]


def tuned_for(config: ResolvedConfig, trial: Trial, wanted: Sequence[Perturbation]) -> dict[str, OutcomeRow]:
    """What tables tuned for the true plants do there, by the name of the perturbation."""

    def one(perturbation: Perturbation) -> OutcomeRow:
        table = tuned_table(config, perturbation.change(trial.plant), trial.target_m_s)
        return trial.outcome(perturbation, table)

    return {p.name: outcome for p, outcome in zip(wanted, side_by_side(one, wanted), strict=True)}


def with_tuned(outcome: OutcomeRow, tuned: Mapping[str, OutcomeRow]) -> OutcomeRow:
    """`outcome` with the rms of the table tuned for its plant, if there is one."""
    best = tuned.get(outcome.name)
    return outcome if best is None else replace(outcome, retuned_rms_m_s=best.rms_m_s)


def with_ends_tuned(row: EndsRow, tuned: Mapping[str, OutcomeRow]) -> EndsRow:
    """`with_tuned` of both ends."""
    return replace(row, less=with_tuned(row.less, tuned), more=with_tuned(row.more, tuned))


METHOD = Method(Options, Options(cases=("52:3",), passes=200, no_retuning=True), Robustness, run)
