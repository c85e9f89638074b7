"""Tables by case: those that a tune of a configuration makes, and those of a book."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace

from plant_models import Plant
from synth.frame.workers.engine import Watcher
from synth.retarder.class_setup import ClassSetup, class_setup, origin_of, validation_passes
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.retarder.estimation.tuning_days import simulated_prediction
from synth.retarder.failed_case import FailedCase, attempted, require_none
from synth.retarder.served_class import plant_for
from synth.retarder.tuned_table import read_back, solutions, tuned_table, validated_table, with_prediction
from synth.simulation.controllers import TableController
from synth.solver.backward_induction import Solution
from synth.solver.descent import one_blas_thread
from tuning_tables import ControllerTable

Case = tuple[str, float]
"""Label of a cut class, and target in m/s."""


@dataclass(frozen=True)
class TunedTables:
    """Tables by case, in the order of a configuration; `failed`: its cases without one."""

    tables: Mapping[Case, ControllerTable]
    failed: tuple[FailedCase, ...] = ()

    @property
    def whole(self) -> Mapping[Case, ControllerTable]:
        """All cases, for who needs every one; `PlantError` where one has no table."""
        require_none(self.failed)
        return self.tables


def cases_of(config: ResolvedConfig) -> tuple[Case, ...]:
    """All cases of `config`, in its order."""
    return tuple((label, target) for label, _ in config.plants() for target in config.targets_of(label))


def class_setups(config: ResolvedConfig, created: str) -> tuple[ClassSetup, ...]:
    """What the targets of each class of `config` share."""
    origin, passes = origin_of(config.sha256, created), validation_passes(config)
    return tuple(class_setup(config, label, plant, passes, origin) for label, plant in config.plants())


@one_blas_thread()
def tuned_tables(config: ResolvedConfig, setups: Sequence[ClassSetup], threads: int, watcher: Watcher) -> TunedTables:
    """The tables of all cases of `config`, as they are read back; not yet simulated."""

    def of_case(setup: ClassSetup, solution: Solution) -> ControllerTable | FailedCase:
        label, target = setup.label, solution.aim.target_speed_m_s
        made = attempted(lambda: read_back(tuned_table(setup, solution).table), label, target, config)
        watcher.done(made.sentence if isinstance(made, FailedCase) else f"{label} to {target:g} m/s tuned")
        return made

    def of_class(setup: ClassSetup) -> list[tuple[Case, ControllerTable | FailedCase]]:
        found = solutions(setup.design, config.aims_of(setup.label))
        return [((setup.label, each.aim.target_speed_m_s), of_case(setup, each)) for each in found]

    with ThreadPoolExecutor(threads) as pool:
        results = [pair for found in pool.map(of_class, setups) for pair in found]
    tables = {case: made for case, made in results if not isinstance(made, FailedCase)}
    return TunedTables(tables, tuple(made for _, made in results if isinstance(made, FailedCase)))


def tables_by_case(
    tables: Sequence[ControllerTable], config: ResolvedConfig, source: str
) -> dict[Case, ControllerTable]:
    """The tables of a book by the class of `config` that each is for; `InputError` for one that fits none.

    The dead band may be another one: it is identified anew with every log.
    """
    band_kpa = config.retarder.position.pneumatics.dead_band_kpa
    found = {}
    for table in tables:
        here = replace(table, retarder=replace(table.retarder, dead_band_kpa=band_kpa))
        found[plant_for(here, config, source)[0], table.target_speed_m_s] = table
    return found


def restated(setup: ClassSetup, table: ControllerTable) -> ControllerTable:
    """`table` with what it does on the plant of `setup`: kept lines, figures of the identified numbers."""
    band_kpa = setup.plant.position.pneumatics.dead_band_kpa
    told = replace(
        table, generator=setup.origin.generator, created=setup.origin.created, validated=None,
        retarder=replace(table.retarder, dead_band_kpa=band_kpa),
    )  # fmt: skip
    if told.estimator is None:
        return with_prediction(setup.check, told).table
    sample = setup.passes.run(TableController(told))
    return replace(told, predicted=simulated_prediction(sample, told.target_speed_m_s))


def finished(
    setups: Sequence[ClassSetup], tables: Mapping[Case, ControllerTable], unchanged: frozenset[Case]
) -> tuple[ControllerTable, ...]:
    """`tables` with the figures of simulated passes, in the order of the cases; those `unchanged` restated before."""
    by_label = {setup.label: setup for setup in setups}
    found = []
    for case, table in tables.items():
        setup = by_label[case[0]]
        kept = restated(setup, table) if case in unchanged else table
        found.append(validated_table(setup, kept, read_back).table)
    return tuple(found)


def plants_of(config: ResolvedConfig) -> dict[str, Plant]:
    """Plants by label."""
    return dict(config.plants())
