"""What all targets of one cut class share: chains, passes, and what the tables are stamped with."""

from __future__ import annotations

from dataclasses import dataclass
from importlib.metadata import version

from plant_models import Plant
from synth.problem.resolution import finer_for_check
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.retarder.configuration.settings import RegulatorSettings
from synth.retarder.estimation.estimated_lines import estimate_chain
from synth.retarder.estimation.tuning_days import TuningDays, prediction_passes, tuning_days, tuning_row
from synth.simulation.common_passes import CommonPasses, common_passes
from synth.simulation.random_passes import PATH_CELLS, RandomPasses
from synth.simulation.stratified_passes import stratified_passes
from synth.solver.chain.chain import Chain, check_chain, persistent_chain
from tuning_tables import Generator

TUNING_PASSES = 600
"""Passes that baselines are tuned on: the first of the row after that of the validation."""

TRIM_PASSES = 1800
"""Passes that lines for the estimated speed are trimmed on: those that follow. With twice as many the mean rms of the
default book is the same within 0.5 %."""

Stamp = tuple[Generator, str, str]
"""What one table is stamped with: program and problem, its name, and when."""


@dataclass(frozen=True)
class Origin:
    """What tables are stamped with: program and problem, and when."""

    generator: Generator
    created: str

    def stamp(self, stem: str, target_speed_m_s: float) -> Stamp:
        """That of the table for a target, whose name, also as a file name, begins with `stem`."""
        return self.generator, f"{stem}-to-{target_speed_m_s:g}-m-s", self.created


@dataclass(frozen=True)
class EstimatorSetup:
    """Passes to trim lines on, the same shared out to days, and others to predict from."""

    tuning: RandomPasses
    days: TuningDays
    prediction: CommonPasses


@dataclass(frozen=True)
class ClassSetup:
    """`design`: the chain that lines are solved and polished on, for the speed that the regulator compares with them;
    `check`: the finer one that tables for the measured speed are predicted on, else `design`; `passes`: what every
    controller is simulated on; `table_stem`: how the names of the tables begin; `regulator`: when it commands, and what
    it knows; `estimator`: None for tables for the measured speed."""

    label: str
    table_stem: str
    plant: Plant
    degree: int
    design: Chain
    check: Chain
    passes: CommonPasses
    origin: Origin
    estimator: EstimatorSetup | None
    regulator: RegulatorSettings

    def stamp(self, target_speed_m_s: float) -> Stamp:
        """That of the table for a target."""
        return self.origin.stamp(self.table_stem, target_speed_m_s)


def class_setup(
    config: ResolvedConfig, label: str, plant: Plant, passes: RandomPasses, origin: Origin, table_stem: str = ""
) -> ClassSetup:
    """The setup of the class `label` of `config`, simulated on `passes`; `table_stem` is the label unless given."""
    compared, resolution = common_passes(plant, passes), config.resolution_of(plant)
    if config.regulator.estimator:
        estimator = estimator_setup(config, label, compared)
        design = check = estimate_chain(plant, resolution, min(config.targets_of(label)))
    else:
        estimator = None
        design, check = persistent_chain(plant, resolution), check_chain(plant, finer_for_check(resolution))
    return ClassSetup(
        label=label,
        table_stem=table_stem or label,
        plant=plant,
        degree=config.fit.degree,
        design=design,
        check=check,
        passes=compared,
        origin=origin,
        estimator=estimator,
        regulator=config.regulator,
    )


def estimator_setup(config: ResolvedConfig, label: str, compared: CommonPasses) -> EstimatorSetup:
    """Passes to design for the estimator of a plant; they are not those `compared`, nor anybody's."""
    seed = config.validation.seed
    tuning = trim_passes(seed, compared.plant)
    return EstimatorSetup(
        tuning=tuning,
        days=tuning_days(compared.plant, tuning),
        prediction=compared.of_others(prediction_passes(seed + 2, label)),
    )


def trim_passes(seed: int, plant: Plant) -> RandomPasses:
    """The passes that tables of `plant` are trimmed on, where those of the validation have `seed`."""
    return tuning_row(plant.friction)(seed + 1, TUNING_PASSES, TRIM_PASSES, PATH_CELLS)


def validation_passes(config: ResolvedConfig) -> RandomPasses:
    """The passes that every table of `config` is simulated on."""
    return stratified_passes(config.validation.seed, 0, config.validation.passes)


def origin_of(config_sha256: str, created: str) -> Origin:
    """This program, for the problem of that hash."""
    return Origin(Generator("retarder-synth", version("retarder-synth"), config_sha256), created)
