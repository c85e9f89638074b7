"""A configuration with every default filled in: plant values, settings, and the origin of each number."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

from annotated_types import Ge, Le
from pydantic.fields import FieldInfo

from plant_models import EntrySpeed, Plant, PlantError
from plant_models.library import RetarderEntry, SourcedValue, load_retarder, retarder_names
from plant_models.library.near_miss import near_miss
from plant_models.library.sourced_value import SET_BY_USER
from synth.configuration.cut_class import CutClass, category_warnings, resolve_cut
from synth.configuration.grid_warnings import grid_warnings
from synth.configuration.settings import (
    NUMERICAL_SECTIONS,
    AcceptanceSettings,
    CriterionSettings,
    FitSettings,
    GridSettings,
    OutputSettings,
    RegulatorSettings,
    Section,
    Settings,
    ValidationSettings,
)
from synth.faults.input_error import InputError
from synth.problem.aim import Aim
from synth.problem.criterion import Criterion
from synth.problem.estimator_resolution import estimator_resolution
from synth.problem.problem import Problem
from synth.problem.resolution import Resolution
from tuning_tables.canonical import canonical_json
from tuning_tables.excerpt import excerpt

TOOL_DEFAULT = "default of the tool"

LONGEST_SENTENCE = 400
"""Characters of what the plant says of a value, which it repeats."""

KEY_OF_PLANT_MESSAGE = {
    "pneumatics: ": "retarder.pneumatics.",
    "force: ": "retarder.force.",
    "retarder: ": "retarder.",
    "retarder: stages ": "retarder.pneumatics.dead_band_kpa: stages ",
    "track profile: grades_permille": "track.grade_permille",
    "track profile: starts_m": "track.grade_permille: starts_m",
    "entry: ": "entry.",
    "friction: ": "friction.",
    "sensor: ": "sensor.",
    "criterion: ": "criterion.",
    "targets: target_speed_m_s": "targets.exit_speeds_m_s",
    "targets: ": "targets.exit_speeds_m_s: ",
}
"""How the plant's messages begin, and the key path in a configuration file that this means."""


@dataclass(frozen=True)
class ResolvedConfig:
    """Everything that a tune depends on.

    `parameters`: every number with unit, range, source, confidence and whether it is assumed; source
    'configuration' marks what the user changed. `warnings`: sentences about values outside their sensible
    range.
    """

    title: str
    retarder: RetarderEntry
    entry: EntrySpeed
    cuts: tuple[CutClass, ...]
    targets_m_s: tuple[float, ...]
    criterion_settings: CriterionSettings
    grid: GridSettings
    fit: FitSettings
    regulator: RegulatorSettings
    validation: ValidationSettings
    acceptance: AcceptanceSettings
    output: OutputSettings
    parameters: tuple[SourcedValue, ...]
    warnings: tuple[str, ...]

    def plants(self) -> tuple[tuple[str, Plant], ...]:
        """(label, plant) of every cut class."""
        at = self.retarder
        return tuple(
            (c.label, Plant(at.position, c.cut, at.profile, at.friction, c.resistance, at.sensor, self.entry))
            for c in self.cuts
        )

    def problems(self) -> tuple[tuple[str, Problem], ...]:
        """(label, problem) of every cut class and target, targets innermost."""
        return tuple(
            (label, Problem(p, Aim(v, self.criterion))) for label, p in self.plants() for v in self.targets_m_s
        )

    @property
    def criterion(self) -> Criterion:
        """The criterion settings as the solver takes them."""
        return self.criterion_settings.criterion()

    @property
    def resolution(self) -> Resolution:
        """The grid settings as the solver takes them."""
        return self.grid.resolution(self.retarder.sensor.sample_period_s)

    @property
    def design_resolutions(self) -> tuple[Resolution, ...]:
        """Every grid that lines of a class are designed on: one more where the regulator has an estimator."""
        if not self.regulator.estimator:
            return (self.resolution,)
        finer = estimator_resolution(self.resolution, self.retarder.sensor, min(self.targets_m_s))
        return self.resolution, finer

    def canonical_json(self) -> str:
        """What the results depend on, in the canonical form of RFC 8785 (title and [output] are left out)."""
        tree: dict[str, Any] = {"format": "retarder-config", "version": 1}
        tree["retarder"] = {"name": self.retarder.name, "law": self.retarder.law}
        for parameter in self.retarder.provenance:
            *path, name = parameter.key.split(".")
            table = tree
            for part in path:
                table = table.setdefault(part, {})
            table[name] = parameter.value
        tree["cut"] = [c.canonical() for c in self.cuts]
        sections = {
            "criterion": self.criterion_settings,
            "grid": self.grid,
            "fit": self.fit,
            "regulator": self.regulator,
            "validation": self.validation,
            "acceptance": self.acceptance,
        }
        tree |= {name: section.model_dump() for name, section in sections.items()}
        return canonical_json(tree).decode("utf-8")

    @property
    def sha256(self) -> str:
        """SHA-256 of `canonical_json` in UTF-8, hexadecimal."""
        return hashlib.sha256(self.canonical_json().encode()).hexdigest()


def resolve(settings: Settings, file: str) -> ResolvedConfig:
    """Fill in the library's values; `InputError` names `file`, key and value of whatever does not fit."""
    retarder = resolve_retarder(settings, file)
    cuts = tuple(resolve_cut(cut, i, retarder, file) for i, cut in enumerate(settings.cut))
    labels = [c.label for c in cuts]
    for i, label in enumerate(labels):
        if label in labels[:i]:
            raise InputError(
                f"{file}: cut[{i}].label is {label!r}, as is that of cut[{labels.index(label)}]; "
                "give one of the two another label"
            )
    low, high = retarder.entry_speed_m_s
    targets = resolve_targets(retarder.target_speeds_m_s, high, file)
    parameters = (
        *retarder.provenance,
        *(value for c in cuts for value in c.provenance),
        *(value for name in NUMERICAL_SECTIONS for value in setting_values(name, getattr(settings, name))),
    )
    try:
        config = ResolvedConfig(
            title=retarder.title if settings.title is None else settings.title,
            retarder=retarder,
            entry=EntrySpeed(low, high),
            cuts=cuts,
            targets_m_s=targets,
            criterion_settings=settings.criterion,
            grid=settings.grid,
            fit=settings.fit,
            regulator=settings.regulator,
            validation=settings.validation,
            acceptance=settings.acceptance,
            output=settings.output,
            parameters=parameters,
            warnings=tuple(range_warnings(parameters)) + tuple(category_warnings(cuts)),
        )
        config.problems()
        coarse = tuple(grid_warnings(config.resolution, retarder.sensor, targets))
        config = replace(config, warnings=config.warnings + coarse)
        if config.regulator.estimator and config.criterion.requirement is not None:
            raise InputError(
                f"{file}: regulator.estimator is true, but criterion.p_overspeed and criterion.worst_friction_* can be "
                "kept only without an estimator; leave one of the two out"
            )
        if config.regulator.estimator:
            estimator_resolution(config.resolution, retarder.sensor, min(targets))
    except PlantError as error:
        raise InputError(f"{file}: {excerpt(with_key_path(str(error)), LONGEST_SENTENCE)}") from None
    return config


def resolve_retarder(settings: Settings, file: str) -> RetarderEntry:
    """The library's position with the user's values in it."""
    name = settings.retarder.name
    if name not in retarder_names():
        raise InputError(
            f"{file}: retarder.name is {excerpt(name)!r}, which the library does not hold; "
            f"{near_miss(name, retarder_names())}"
        )
    zones = settings.retarder.zones_m
    if zones is not None and zones[0][0] != 0.0:
        raise InputError(
            f"{file}: retarder.zones_m begins with {zones[0]}; the first zone must start at 0, the entrance"
        )
    try:
        retarder = load_retarder(name).with_values(settings.library_overrides())
        pressures = retarder.position.stage_pressures_kpa
        for start in pressures:
            for end in pressures:  # a regulator that hunts is found here, not in the middle of a solve
                retarder.position.pneumatics.respond(start, end, retarder.position.force.touch_pressure_kpa)
    except PlantError as error:
        raise InputError(f"{file}: {excerpt(with_key_path(str(error)), LONGEST_SENTENCE)}") from None
    return retarder


def resolve_targets(speeds_m_s: tuple[float, ...], highest_entry_m_s: float, file: str) -> tuple[float, ...]:
    """The targets, which must be different and below the highest entry speed."""
    for speed in speeds_m_s:
        if not 0.3 <= speed < highest_entry_m_s:
            raise InputError(
                f"{file}: targets.exit_speeds_m_s holds {speed!r}; a target must be at least 0.3 m/s and below the "
                f"highest entry speed, entry.high_m_s = {highest_entry_m_s:g}"
            )
    named: dict[str, float] = {}
    for speed in speeds_m_s:
        name = f"{speed:g}"
        if name in named:
            raise InputError(
                f"{file}: targets.exit_speeds_m_s holds {named[name]!r} and {speed!r}, but tables are named by six "
                "digits of their target; give each only once"
            )
        named[name] = speed
    return speeds_m_s


def setting_values(name: str, section: Section) -> Iterator[SourcedValue]:
    """The numerical settings of a section with unit, limits and origin."""
    for key, field in type(section).model_fields.items():
        value = getattr(section, key)
        source = TOOL_DEFAULT if value == field.default else SET_BY_USER
        yield SourcedValue(f"{name}.{key}", float(value), setting_unit(field), setting_limits(field), source, "")


def setting_unit(field: FieldInfo) -> str:
    """Unit of a field made by `synth.configuration.settings.setting`."""
    extra = field.json_schema_extra
    return str(extra["unit"]) if isinstance(extra, dict) and "unit" in extra else ""


def setting_limits(field: FieldInfo) -> tuple[float, float] | None:
    """Lowest and highest allowed value of a field, or None."""
    low = [float(m.ge) for m in field.metadata if isinstance(m, Ge)]  # type: ignore[arg-type]  # ge is a number here
    high = [float(m.le) for m in field.metadata if isinstance(m, Le)]  # type: ignore[arg-type]
    return (low[0], high[0]) if low and high else None


def range_warnings(parameters: tuple[SourcedValue, ...]) -> Iterator[str]:
    """A sentence for every value outside its sensible range."""
    for p in parameters:
        if p.range is not None and not p.in_range:
            yield f"{p.key} is {p.value!r}; its sensible range is {p.range[0]:g} to {p.range[1]:g} {p.unit}"


def with_key_path(sentence: str) -> str:
    """The plant's sentence with the key path of the configuration in place of the plant's own name."""
    for prefix in sorted(KEY_OF_PLANT_MESSAGE, key=len, reverse=True):
        if sentence.startswith(prefix):
            return KEY_OF_PLANT_MESSAGE[prefix] + sentence.removeprefix(prefix)
    return sentence
