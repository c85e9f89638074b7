"""What a table does on another plant than it was tuned for, on the same passes: worn parts, another cut, numbers
of the library's range; and the tables of the page on robustness.

For each case: named conditions of service, and every parameter at the ends of its sensible range; the same passes
everywhere. The named plants and the ends that hurt also with a table tuned for the true plant.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from plant_models import Plant
from scripts.studies.cases import Case, from_the_entrance, named_cases, side_by_side, tuned_table
from scripts.studies.robustness.condition import Perturbation, conditions, sensible_ends
from scripts.studies.study import ABSENT, Findings, MarkdownTable, Method, Tell, around, option, table
from synth.retarder.configuration.plant_values import Parameter, parameters
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.simulation.closed_loop import TableController, simulate
from synth.simulation.exit_statistics import exit_statistics, rms_ratio
from synth.simulation.passes import ExitSample
from synth.simulation.random_passes import RandomPasses
from synth.simulation.replicates import Interval
from synth.simulation.stratified_passes import stratified_passes
from tuning_tables import ControllerTable

SHOWN_RATIO = 1.25
"""A parameter stands in the table of sensible ranges where it multiplies the rms of a case by more than this."""


@dataclass(frozen=True)
class OutcomeRow:
    """A table on one plant; `ratio`: rms / rms on the nominal plant, paired; rms of a table tuned for this plant."""

    name: str
    note: str
    rms_m_s: float
    rms_ci95_m_s: Interval
    ratio: float
    ratio_ci95: Interval
    bias_m_s: float
    bias_ci95_m_s: Interval
    overspeed: float
    overspeed_ci95: Interval
    stalled: float
    stalled_ci95: Interval
    switchings: float
    retuned_rms_m_s: float | None = None

    @property
    def cell(self) -> str:
        """'0.350 [0.345, 0.354] / 0.349': rms and that of a table tuned for this plant."""
        tuned = "" if self.retuned_rms_m_s is None else f" / {self.retuned_rms_m_s:.3f}"
        return around(self.rms_m_s, self.rms_ci95_m_s, 3) + tuned


@dataclass(frozen=True)
class EndsRow:
    """One parameter low and high (`values`), all else nominal; `nominal`: its value in the plant."""

    key: str
    name: str
    nominal: float
    values: tuple[float, float]
    less: OutcomeRow
    more: OutcomeRow

    @property
    def worst(self) -> OutcomeRow:
        """The end with the larger rms."""
        return max(self.less, self.more, key=lambda outcome: outcome.rms_m_s)

    @property
    def worst_value(self) -> float:
        """The value at that end."""
        return self.values[0 if self.worst is self.less else 1]


@dataclass(frozen=True)
class CaseRow:
    """One table on all plants."""

    case: str
    nominal: OutcomeRow
    sensible: tuple[EndsRow, ...]
    conditions: tuple[OutcomeRow, ...]


@dataclass(frozen=True)
class Robustness(Findings):
    """All cases."""

    config_sha256: str
    seed: int
    passes: int
    cases: tuple[CaseRow, ...]

    def tables(self) -> Mapping[str, MarkdownTable]:
        """`conditions`, `ranges`."""
        return {"conditions": self.conditions(), "ranges": self.ranges()}

    @property
    def names(self) -> tuple[str, ...]:
        """The cases."""
        return tuple(case.case for case in self.cases)

    def conditions(self) -> MarkdownTable:
        """A row a named condition."""
        each = zip(*((case.nominal, *case.conditions) for case in self.cases), strict=True)
        rows = [
            (without_mass(found[0].name), *(one.cell for one in found),
             ", ".join(f"{100.0 * one.overspeed:.1f}" for one in found))
            for found in each
        ]  # fmt: skip
        title = "rms under named conditions, m/s [95 %] / of a table tuned for that plant; over-speed, %"
        return table(title, ("condition", *self.names, "over-speed"), rows)

    def ranges(self) -> MarkdownTable:
        """A row a parameter whose sensible range matters, at its worse end."""
        rows = [
            (name, *(f"{row.worst_value:.3g}: {row.worst.cell}" if row else ABSENT for row in found))
            for name, ratio, found in by_effect([case.sensible for case in self.cases])
            if ratio > SHOWN_RATIO
        ]
        title = "worse end of the library's sensible range: value, rms, m/s [95 %] / of a table tuned for that plant"
        return table(title, ("parameter", *self.names), rows)

    def sentences(self) -> tuple[str, ...]:
        """How much was simulated, and stalls."""
        stalls = [
            f"{case.case}, {row.name}: {100.0 * row.stalled:.2f} % of the cuts stall"
            for case in self.cases for row in (case.nominal, *case.conditions) if row.stalled > 0.0
        ]  # fmt: skip
        return (
            f"{self.passes} stratified passes a plant, seed {self.seed}",
            *(stalls or ["no cut stalls under a named condition"]),
        )


def by_effect(cases: Sequence[Sequence[EndsRow]]) -> list[tuple[str, float, list[EndsRow | None]]]:
    """(name, largest rms ratio in any case, its row in each case) of every parameter, by that ratio.

    A row is None where the plant of a case has no such parameter.
    """
    found = []
    for key, name in {row.key: row.name for rows in cases for row in rows}.items():
        mine = [next((row for row in rows if row.key == key), None) for rows in cases]
        found.append((name, max(row.worst.ratio for row in mine if row is not None), mine))
    return sorted(found, key=lambda each: -each[1])


def without_mass(name: str) -> str:
    """'lightest cut of the category, 22 t' without the mass, which differs from case to case."""
    return name.partition(" category, ")[0] + " category" if " category, " in name else name


@dataclass(frozen=True)
class Trial:
    """A table, the plant it was tuned for, common random passes, and how they end there."""

    label: str
    table: ControllerTable
    plant: Plant
    passes: RandomPasses
    nominal: ExitSample

    @property
    def target_m_s(self) -> float:
        """The commanded exit speed."""
        return self.table.target_speed_m_s

    def sample(self, perturbation: Perturbation, table: ControllerTable | None = None) -> ExitSample:
        """The passes under `perturbation`, by the trial's table or another; `PlantError` for an impossible plant."""
        return simulate(perturbation.change(self.plant), TableController(table or self.table), self.passes)

    def outcome(self, perturbation: Perturbation, table: ControllerTable | None = None) -> OutcomeRow:
        """Figures of `sample`, compared with the nominal passes of the trial's table."""
        sample = self.sample(perturbation, table)
        s = exit_statistics(sample, self.target_m_s)
        ratio, ratio_ci95 = rms_ratio(sample, self.nominal, self.target_m_s)
        return OutcomeRow(
            perturbation.name, perturbation.note, s.rms_m_s, s.rms_ci95_m_s, ratio, ratio_ci95, s.bias_m_s,
            s.bias_ci95_m_s, s.overspeed, s.overspeed_ci95, s.stalled, s.stalled_ci95, s.switchings,
        )  # fmt: skip


def trial_of(label: str, table: ControllerTable, plant: Plant, passes: RandomPasses) -> Trial:
    """The trial of `table`, tuned for `plant`."""
    return Trial(label, table, plant, passes, simulate(plant, TableController(table), passes))


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
