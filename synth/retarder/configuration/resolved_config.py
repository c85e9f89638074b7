"""A configuration with every default filled in: plant values, settings, and the origin of each number."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass, replace
from typing import Any

from plant_models import EntryLaw, Plant, PlantError
from plant_models.errors import near_miss
from plant_models.library import (
    BUILT_IN,
    WEIGHT_CATEGORIES,
    Library,
    PositionEntry,
    SourcedValue,
    load_weight_categories,
)
from plant_models.library.position_entry import MEAN_CV, REGULATOR
from plant_models.library.retarder_entry import DAY_SPREAD
from plant_models.library.sourced_value import SET_BY_USER
from synth.frame.faults import InputError
from synth.frame.settings.numbers import numbers_of, range_warnings
from synth.problem.criterion import Criterion
from synth.problem.problem import Aim, Problem
from synth.problem.resolution import Resolution, design_resolution, estimator_resolution, finer_for_check, grid_warnings
from synth.retarder.configuration.cut_class import (
    CutClass,
    Surroundings,
    category_warnings,
    resolve_cut,
    resolve_targets,
)
from synth.retarder.configuration.plant_fault import in_file, require_held
from synth.retarder.configuration.resolved_position import (
    ResolvedSensors,
    require_served,
    resolve_position,
    resolve_sensors,
)
from synth.retarder.configuration.settings import (
    NUMERICAL_SECTIONS,
    AcceptanceSettings,
    CriterionSettings,
    FitSettings,
    GridSettings,
    RegulatorSettings,
    Settings,
    TuneOutputSettings,
    ValidationSettings,
)
from tuning_tables.errors import excerpt
from tuning_tables.json_text import canonical_json


@dataclass(frozen=True)
class ResolvedConfig:
    """Everything that a tune depends on.

    `parameters`: every number with unit, range, source, confidence and whether it is assumed; source
    'configuration' marks what the user changed. `retarder`: the position, with what [regulator] says of it. `entry`,
    `targets_m_s`: of the classes that have none of their own. `sensors`: point sensors, None where the file has none.
    `warnings`: sentences about values outside their sensible range.
    """

    title: str
    retarder: PositionEntry
    sensors: ResolvedSensors | None
    entry: EntryLaw
    cuts: tuple[CutClass, ...]
    targets_m_s: tuple[float, ...]
    criterion_settings: CriterionSettings
    grid: GridSettings
    fit: FitSettings
    regulator: RegulatorSettings
    validation: ValidationSettings
    acceptance: AcceptanceSettings
    output: TuneOutputSettings
    parameters: tuple[SourcedValue, ...]
    warnings: tuple[str, ...]

    def __repr__(self) -> str:
        return f"ResolvedConfig({self.title}: {len(self.cuts)} cut classes, sha256 {self.sha256[:8]}…)"

    def plants(self) -> tuple[tuple[str, Plant], ...]:
        """(label, plant) of every cut class."""
        return tuple((c.label, self.plant_of(c)) for c in self.cuts)

    def plant_of(self, c: CutClass) -> Plant:
        """The plant of one of the classes; `PlantError` names the class."""
        at, entry = self.retarder, c.entry or self.entry
        try:
            approach = replace(at.approach, entrance_stage=c.entrance_stage)
            return Plant(at.position, c.cut, at.profile, at.friction, c.resistance, at.sensor, entry, approach)
        except PlantError as fault:
            raise PlantError(f"{fault} (cut class {c.label})") from fault

    def targets_of(self, label: str) -> tuple[float, ...]:
        """Commanded exit speeds of the class `label`."""
        (own,) = (c.targets_m_s for c in self.cuts if c.label == label)
        return self.targets_m_s if own is None else own

    def aims_of(self, label: str) -> tuple[Aim, ...]:
        """The same, with what a pass costs that misses one."""
        return tuple(Aim(target, self.criterion) for target in self.targets_of(label))

    @property
    def lowest_target_m_s(self) -> float:
        """Of all classes."""
        return min(target for c in self.cuts for target in self.targets_of(c.label))

    def problems(self) -> tuple[tuple[str, Problem], ...]:
        """(label, problem) of every cut class and target, targets innermost."""
        return tuple(
            (label, Problem(p, Aim(v, self.criterion))) for label, p in self.plants() for v in self.targets_of(label)
        )

    @property
    def criterion(self) -> Criterion:
        """The criterion settings as the solver takes them."""
        return self.criterion_settings.criterion()

    @property
    def resolution(self) -> Resolution:
        """The grid settings as the solver takes them."""
        return self.grid.resolution(self.retarder.sensor.sample_period_s)

    def resolution_of(self, plant: Plant) -> Resolution:
        """The grid that lines of a class are designed on."""
        return self.resolution.for_pass(plant.pass_m)

    def grids(self, plant: Plant) -> tuple[Resolution, ...]:
        """The grid that lines of a class are designed on, and that on which their tables are predicted, if any is."""
        measured = self.resolution_of(plant)
        if self.regulator.estimator:
            return (estimator_resolution(measured, self.retarder.sensor, self.lowest_target_m_s),)
        return measured, finer_for_check(measured)

    def canonical_json(self) -> str:
        """What the results depend on, in the canonical form of RFC 8785.

        Left out are title and [output]; what an approach and commands at any time add, where there are none; and the
        spreads from day to day where nothing is designed for them.
        """
        of_days = {MEAN_CV, DAY_SPREAD}
        tree: dict[str, Any] = {"format": "retarder-config", "version": 1}
        tree["retarder"] = {"name": self.retarder.name, "law": self.retarder.law}
        for parameter in self.retarder.provenance:
            if parameter.key in {*REGULATOR, *of_days} and parameter.value == 0.0:
                continue
            if parameter.key in of_days and not self.regulator.estimator:
                continue
            *path, name = parameter.key.split(".")
            table = tree
            for part in path:
                table = table.setdefault(part, {})
            table[name] = parameter.value
        tree["cut"] = [c.canonical() for c in self.cuts]
        if self.retarder.approach.length_m > 0.0 or self.sensors is not None:
            stages = (self.plant_of(c).entrance_stage for c in self.cuts)
            tree["cut"] = [{**c, "entrance_stage": stage} for c, stage in zip(tree["cut"], stages, strict=True)]
        if self.sensors is not None:
            tree["sensors"] = self.sensors.canonical()
        tree.setdefault("regulator", {})["estimator"] = self.regulator.estimator
        if self.regulator.at_any_time:
            tree["regulator"] |= {"commands": self.regulator.commands, "pressure": self.regulator.pressure}
        sections = {
            "criterion": self.criterion_settings,
            "grid": self.grid,
            "fit": self.fit,
            "validation": self.validation,
            "acceptance": self.acceptance,
        }
        tree |= {name: section.model_dump() for name, section in sections.items()}
        return canonical_json(tree).decode("utf-8")

    @property
    def sha256(self) -> str:
        """SHA-256 of `canonical_json` in UTF-8, hexadecimal."""
        return hashlib.sha256(self.canonical_json().encode()).hexdigest()


def resolve(settings: Settings, file: str, library: Library = BUILT_IN) -> ResolvedConfig:
    """Fill in the library's values; `InputError` names `file`, key and value of whatever does not fit."""
    position = resolve_position(settings, file, library)
    require_held(f"{file}: weight_categories", WEIGHT_CATEGORIES, settings.weight_categories, library)
    with in_file(file):
        categories = load_weight_categories(settings.weight_categories, library)
    cuts = resolve_cuts(settings, Surroundings(position, categories, library, file))
    sensors = None if settings.sensors is None else resolve_sensors(settings.sensors, file, library)
    parameters = (
        *position.provenance,
        *(sensors.provenance if sensors is not None else ()),
        *(value for c in cuts for value in c.provenance),
        *(value for name in NUMERICAL_SECTIONS for value in numbers_of(getattr(settings, name), name)),
    )
    parameters = with_sources(parameters, settings, file)
    config = ResolvedConfig(
        title=position.title if settings.title is None else settings.title,
        retarder=position,
        sensors=sensors,
        entry=position.entry,
        cuts=cuts,
        targets_m_s=position.target_speeds_m_s,
        criterion_settings=settings.criterion,
        grid=settings.grid,
        fit=settings.fit,
        regulator=settings.regulator.model_copy(update={"approach_m": None, "initial_stage": None}),
        validation=settings.validation,
        acceptance=settings.acceptance,
        output=settings.output,
        parameters=parameters,
        warnings=tuple(range_warnings(parameters)) + tuple(category_warnings(cuts, categories)),
    )
    with in_file(file):
        config = with_grid_warnings(config, file)
    if sensors is not None:
        require_served(sensors, config.plants(), file)
    return config


def with_sources(parameters: tuple[SourcedValue, ...], settings: Settings, file: str) -> tuple[SourcedValue, ...]:
    """`parameters` with what [sources] says of those that the file sets; `InputError` for any other key."""
    sources = settings.sources
    set_here = settings.library_overrides().keys() | {v.key for v in parameters if v.source == SET_BY_USER}
    for key in sources:
        if key not in set_here:
            raise InputError(
                f"{file}: sources has {excerpt(key)!r}, which this file sets to no value of its own: "
                f"{near_miss(key, set_here) if set_here else 'leave it out'}"
            )
    return tuple(
        replace(value, source=sources[value.key], confidence="") if value.key in sources else value
        for value in parameters
    )


def resolve_cuts(settings: Settings, at: Surroundings) -> tuple[CutClass, ...]:
    """The classes; `InputError` with the first fault of each of them, and of the targets."""
    cuts: list[CutClass] = []
    faults: list[str] = []
    for i, cut in enumerate(settings.cut):
        try:
            cuts.append(resolve_cut(cut, i, at))
        except InputError as fault:
            faults += fault.sentences
    places: dict[str, int] = {}
    for i, label in enumerate(c.label for c in cuts if len(cuts) == len(settings.cut)):
        if label in places:
            faults.append(
                f"{at.file}: cut[{i}].label is {label!r}, as is that of cut[{places[label]}]; give one of the two "
                "another label"
            )
        places.setdefault(label, i)
    try:
        resolve_targets("targets.exit_speeds_m_s", at.position.target_speeds_m_s, at.position.entry, at.file)
    except InputError as fault:
        faults += fault.sentences
    if faults:
        raise InputError(*faults)
    return tuple(cuts)


def with_grid_warnings(config: ResolvedConfig, file: str) -> ResolvedConfig:
    """`config` with a warning where its grid is too coarse; refused where problems or regulator make no sense."""
    config.problems()  # refuses what makes no sense
    lowest = config.lowest_target_m_s
    designed = estimator_resolution(config.resolution, config.retarder.sensor, lowest)
    resolution = designed if config.regulator.estimator else config.resolution
    coarse = tuple(grid_warnings(resolution, config.retarder.sensor, (lowest,)))
    require_plain_criterion(config, file)
    if config.regulator.at_any_time:
        for _, problem in config.problems():
            problem.plant.drive_at_any_time()  # refuses what is not modelled
            design_resolution(problem.plant, problem.target_speed_m_s)
    return replace(config, warnings=config.warnings + coarse)


def require_plain_criterion(config: ResolvedConfig, file: str) -> None:
    """Only a regulator without estimator that commands at rest keeps a requirement; raises `InputError`."""
    if config.criterion.requirement is None:
        return
    for asked, said, kept in (
        (config.regulator.estimator, "estimator is true", "estimator = false"),
        (config.regulator.at_any_time, 'commands is "any_time"', 'commands = "at_rest"'),
    ):
        if asked:
            raise InputError(
                f"{file}: regulator.{said}, but criterion.p_overspeed and criterion.worst_friction_* can be kept only "
                f"with {kept}; set that, or leave the requirement out"
            )
