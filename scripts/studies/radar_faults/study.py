"""What a controller does in faults of the radar, and whether it notices a wrong weight category, with the tables
of a case as a tune makes them, for the measured speed and for the estimated one.

Every case with the table for the measured speed ("before") and that for the estimated one ("after"), on the same passes
with the same faults. Then cuts that are told to be of each class: under the estimating table of that class alone, and
where the tables of other classes may take over.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from plant_models import Plant
from plant_models.frozen_arrays import Floats
from scripts.studies.cases import CREATED, OTHER_PLANTS, Case, named_cases, of_masses, side_by_side
from scripts.studies.changed_plants import FAULT_STREAM
from scripts.studies.radar_faults.categories import CutClass, fault_row, mistaken_rows, own_rows
from scripts.studies.radar_faults.faults import RADAR_FAULTS, RadarFault
from scripts.studies.radar_faults.findings import CaseRow, CategoryRow, RadarFaults
from scripts.studies.radar_faults.watched_passes import WatchedPasses, watched_passes
from scripts.studies.study import Method, Tell, option
from synth.problem.problem import Aim
from synth.retarder.class_setup import class_setup, origin_of, validation_passes
from synth.retarder.configuration.config_file import load_config, parse_config
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.retarder.tuned_table import solutions, tuned_table
from synth.simulation.closed_loop import TableController, close_loop, simulate
from synth.simulation.passes import ExitSample
from synth.simulation.random_passes import RandomPasses
from synth.simulation.stratified_passes import stratified_passes


@dataclass(frozen=True)
class TunedCase:
    """A case, its table without estimator and the one with it."""

    case: Case
    before: TableController
    after: TableController


def tuned_case(config: ResolvedConfig, case: Case) -> TunedCase:
    """Both tables of `case`, one of `config`."""
    made = (table_of(config, case.label, case.plant, case.target_m_s, estimator) for estimator in (False, True))
    return TunedCase(case, *made)


def table_of(config: ResolvedConfig, label: str, plant: Plant, target_m_s: float, estimator: bool) -> TableController:
    """The table of the class `label`, rounded as a controller has it."""
    regulated = replace(config, regulator=config.regulator.model_copy(update={"estimator": estimator}))
    origin = origin_of(config.sha256, CREATED)
    setup = class_setup(regulated, label, plant, validation_passes(config).part(0, 1), origin)
    (solution,) = solutions(setup.design, [Aim(target_m_s, config.criterion)])
    return TableController(tuned_table(setup, solution).table)


def cases_of(config: ResolvedConfig, words: Sequence[str], long_cut: bool) -> tuple[tuple[ResolvedConfig, Case], ...]:
    """The cases of `config` that `words` name; with `long_cut` the three gondolas of another configuration too."""
    found = [(config, case) for case in named_cases(config, words)]
    if long_cut:
        other = parse_config(dict(OTHER_PLANTS)["three cars"], "three cars")
        ((label, plant),) = other.plants()
        found.append((other, Case(label, plant, min(other.targets_of(label)))))
    return tuple(found)


FRESH = 15485863
"""Added to the configured seed: passes that no tuning has seen."""

TOGETHER = 2000
"""Passes simulated at a time: they have 3000 readings each."""

MOMENT, SPIKES = 2, 3
"""Streams of chance: when faults begin, and which readings are spikes."""


@dataclass(frozen=True)
class Options:
    """What is studied."""

    config: Path | None = option(None, "configuration; the built-in default book without it")
    cases: tuple[str, ...] = option(("22:3", "36:2", "52:2", "52:3", "85:4"), "mass, t : target, m/s")
    no_long_cut: bool = option(False, "leave out the cut of three gondolas")
    masses_t: tuple[float, ...] = option(
        (), "classes that are exchanged, by their masses, t, ascending; all without it"
    )
    category_targets_m_s: tuple[float, ...] = option((2.0, 3.0), "exit speeds of the tables that are exchanged")
    passes: int = option(20_000, "fresh passes with each fault, and of each pair of classes", (200, 10**6))


def run(options: Options, tell: Tell) -> RadarFaults:
    """Tune the tables, break the radar, exchange the tables."""
    config = load_config(options.config)
    seed = config.validation.seed + FRESH
    passes = stratified_passes(seed, 0, options.passes)

    def case_row(order: tuple[ResolvedConfig, Case]) -> CaseRow:
        found = case_row_of(tuned_case(*order), passes, seed)
        tell(f"{found.case}: {len(found.faults)} faults")
        return found

    rows = side_by_side(case_row, cases_of(config, options.cases, not options.no_long_cut))
    named = of_masses(config, options.masses_t).plants()
    mistaken: list[CategoryRow] = []
    own: list[CategoryRow] = []
    for target in options.category_targets_m_s:
        classes = classes_of(config, named, target)
        tell(f"tables of {len(classes)} classes to {target:g} m/s exchanged")
        mistaken += mistaken_rows(classes, target, passes)
        own += own_rows(classes, target, passes)
    return RadarFaults(config.sha256, seed, options.passes, rows, tuple(mistaken), tuple(own))


def classes_of(config: ResolvedConfig, named: Sequence[tuple[str, Plant]], target_m_s: float) -> tuple[CutClass, ...]:
    """Every class with its estimating table to one exit speed."""
    return tuple(
        side_by_side(lambda each: CutClass(each[1], table_of(config, *each, target_m_s, estimator=True)), named)
    )


def case_row_of(tuned: TunedCase, passes: RandomPasses, seed: int) -> CaseRow:
    """Both controllers of a case in every fault."""
    case = tuned.case
    starts_s = moments_s(simulate(case.plant, tuned.before, passes).transit_time_s, seed)
    rows = []
    for fault in RADAR_FAULTS:
        both = (with_fault(case.plant, each, passes, fault, starts_s, seed) for each in (tuned.before, tuned.after))
        rows.append(fault_row(fault.name, case.target_m_s, *both))
    return CaseRow(case.name, tuple(rows))


def moments_s(transit_s: NDArray[np.floating], seed: int) -> Floats:
    """When the fault of each pass begins: uniform over the time that it takes without, alike for all faults."""
    return np.asarray(chance(seed, MOMENT).random(len(transit_s)) * transit_s, dtype=np.float64)


def with_fault(
    plant: Plant, controller: TableController, passes: RandomPasses, fault: RadarFault,
    starts_s: Floats, seed: int,
) -> WatchedPasses:  # fmt: skip
    """All passes with the fault, some at a time."""
    loop, parts = close_loop(plant, controller.stages), []
    for number, start in enumerate(range(0, len(passes), TOGETHER)):
        stop = min(start + TOGETHER, len(passes))
        part, own = passes.part(start, stop), chance(seed, SPIKES, number)
        faulty = fault.happens_to(part, plant, starts_s[start:stop], own)
        parts.append(watched_passes(loop, controller, loop.draws(faulty)))
    return joined(parts)


def joined(parts: list[WatchedPasses]) -> WatchedPasses:
    """All parts, one after the other."""
    samples = [part.sample for part in parts]
    names = vars(samples[0])
    sample = ExitSample(**{name: np.concatenate([getattr(each, name) for each in samples]) for name in names})
    words = (np.concatenate([getattr(part, name) for part in parts]) for name in ("seen", "at_end", "table"))
    return WatchedPasses(sample, *words)


def chance(seed: int, *stream: int) -> np.random.Generator:
    """Random numbers of faults, of none of the passes."""
    return np.random.Generator(np.random.SFC64(np.random.SeedSequence(seed, spawn_key=(FAULT_STREAM, *stream))))


SMALLEST = Options(cases=("52:3",), no_long_cut=True, masses_t=(22.0, 52.0), category_targets_m_s=(3.0,), passes=200)
METHOD = Method(Options, SMALLEST, RadarFaults, run)
