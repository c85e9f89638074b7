"""Reading a file with a table [sweep]: every fault as one sentence, each condition as an ordinary configuration."""

from __future__ import annotations

import re
from copy import deepcopy
from dataclasses import dataclass
from pathlib import Path

from pydantic import ValidationError
from pydantic_core import ErrorDetails

from plant_models.library import BUILT_IN, Library
from plant_models.library.near_miss import near_miss
from synth.frame.input_error import InputError
from synth.frame.settings.fault_words import ALLOWED, shown
from synth.frame.settings.file_fault import key_path
from synth.frame.settings.section import setting_limits
from synth.frame.settings.toml_file import Tree, read_text, toml_tree
from synth.retarder.configuration.config_file import valid_settings
from synth.retarder.configuration.own_types import with_own_types
from synth.retarder.configuration.plant_settings import DEFAULT_CUTS, CutSettings
from synth.retarder.configuration.resolved_config import ResolvedConfig, resolve
from synth.retarder.configuration.settings import Settings
from synth.retarder.sweep.sweep_settings import CONDITION_SECTIONS, SweepSettings, SweptCuts
from tuning_tables.excerpt import excerpt

AS_CONFIGURED = ""
"""Name of the only condition where the file lists none."""

NAME = re.compile(r"[A-Za-z0-9](?:[A-Za-z0-9._-]{0,29}[A-Za-z0-9_-])?")

TAKEN = re.compile(r"sweep|(?:con|prn|aux|nul|com[0-9]|lpt[0-9])(?:\..*)?", re.IGNORECASE)
"""Names of no condition: the folder of the sweep's own files, and the devices of Windows and its shares."""


@dataclass(frozen=True)
class Condition:
    """A condition: `tree` is its whole configuration as TOML would give it, `config` the same resolved.

    The tree names types, of which `library` has the user's own.
    """

    name: str
    tree: Tree
    config: ResolvedConfig
    library: Library = BUILT_IN


@dataclass(frozen=True)
class SweepFile:
    """What a file asks for."""

    settings: SweepSettings
    conditions: tuple[Condition, ...]


def load_sweep(path: Path) -> SweepFile:
    """The sweep in the file `path`; `InputError` on any fault."""
    return parse_sweep(read_text(path), str(path))


def parse_sweep(text: str, file: str) -> SweepFile:
    """The sweep written in `text`; `file` is what messages call it."""
    tree, library = with_own_types(toml_tree(text, file), file)
    raw = tree.pop("sweep", {})
    if not isinstance(raw, dict):
        raise InputError(f"{file}: sweep is {shown(raw)}; it must be a table, [sweep]")
    try:
        settings = SweepSettings.model_validate(raw)
    except ValidationError as error:
        raise InputError(*(f"{file}: {sentence}" for sentence in sweep_faults(error))) from None
    base = valid_settings(tree, file)
    names = condition_names(settings, file)
    swept = swept_tree(tree, base, settings)
    resolve(valid_settings(swept, file), file, library)  # a fault of the file itself is told before one of a condition
    conditions = []
    for place, name in enumerate(names):
        changed = {key: value for key, value in settings.condition[place].items() if key != "name"} if name else {}
        where = f'{file}: in sweep.condition[{place}], "{name}"' if name else file
        merged = overlaid(swept, changed)
        config = resolve(valid_settings(merged, where), where, library)
        if config.regulator.estimator and settings.interpolation_loss_m_s is not None:
            raise InputError(
                f"{file}: regulator.estimator is true and sweep.interpolation_loss_m_s is "
                f"{settings.interpolation_loss_m_s:g}, but lines for the estimated speed have no exact prediction to "
                "measure that loss by; leave out one of the two"
            )
        conditions.append(Condition(name, merged, config, library))
    return SweepFile(settings, tuple(conditions))


def swept_tree(tree: Tree, base: Settings, settings: SweepSettings) -> Tree:
    """`tree` with the classes, targets and passes of the sweep written into it."""
    swept = deepcopy(tree)
    cuts = [cut for each in settings.cut for cut in each.cuts()] or tree.get("cut") or default_cuts()
    swept["cut"] = [dict(cut) for cut in cuts]
    if settings.exit_speeds_m_s is not None:
        swept.setdefault("targets", {})["exit_speeds_m_s"] = list(settings.exit_speeds_m_s)
    swept.setdefault("validation", {})["passes"] = settings.passes
    return swept


def default_cuts() -> list[Tree]:
    """The built-in classes as [[cut]] tables."""
    return [cut.model_dump(exclude_defaults=True) for cut in DEFAULT_CUTS]


def condition_names(settings: SweepSettings, file: str) -> list[str]:
    """The names of the conditions, which must be file names and differ also where case does not count."""
    if not settings.condition:
        return [AS_CONFIGURED]
    names: list[str] = []
    for place, condition in enumerate(settings.condition):
        key = f"sweep.condition[{place}]"
        name = condition.get("name")
        if not isinstance(name, str) or not NAME.fullmatch(name):
            raise InputError(
                f"{file}: {key}.name is {shown(name)}; it must be made of at most 31 letters, digits, dots, hyphens "
                "and underscores, with no dot at the end"
            )
        if TAKEN.fullmatch(name):
            raise InputError(
                f"{file}: {key}.name is {name!r}, which is a folder of the sweep itself or a device of Windows; "
                "give it another name"
            )
        if name.lower() in (other.lower() for other in names):
            raise InputError(f"{file}: {key}.name is {name!r}, which another condition has; give it another name")
        for section in condition:
            if section not in ("name", *CONDITION_SECTIONS):
                raise InputError(
                    f"{file}: {key}.{excerpt(section)} cannot be changed by a condition; "
                    f"{near_miss(section, ('name', *CONDITION_SECTIONS))}"
                )
        names.append(name)
    return names


def overlaid(tree: Tree, changes: Tree) -> Tree:
    """`tree` with the values of `changes` in their places; tables are merged, all else is replaced."""
    merged = deepcopy(tree)
    for key, value in changes.items():
        below = merged.get(key)
        merged[key] = overlaid(below, value) if isinstance(below, dict) and isinstance(value, dict) else deepcopy(value)
    return merged


def sweep_faults(error: ValidationError) -> list[str]:
    """Every fault within [sweep] as a sentence; mistyped keys come before the others."""
    found = error.errors(include_url=False)
    return [fault_sentence(fault) for fault in sorted(found, key=lambda fault: fault["type"] != "extra_forbidden")]


def fault_sentence(fault: ErrorDetails) -> str:
    """One pydantic error as 'key is value; what is allowed'."""
    location, kind, value = fault["loc"], fault["type"], fault["input"]
    section: type[SweepSettings] | type[SweptCuts] = SweptCuts if location[0] == "cut" else SweepSettings
    key = key_path(("sweep", *location))
    if kind == "extra_forbidden":
        elsewhere = str(location[-1]) in CutSettings.model_fields and section is SweptCuts
        hint = "did you mean mass_per_car_t?" if elsewhere else near_miss(str(location[-1]), section.model_fields)
        return f"{key} = {shown(value)} is an unknown key; {hint}"
    if kind == "missing":
        return f"{key} is missing; add it to {key_path(('sweep', *location[:-1]))}"
    if kind == "value_error":
        return f"{key} is {shown(value)}; {fault['ctx']['error']}"
    if kind in ("greater_than_equal", "less_than_equal"):
        low, high = setting_limits(section.model_fields[str(location[-1])]) or (0.0, 0.0)
        return f"{key} is {shown(value)}; it must be from {low:g} to {high:g}"
    if location in (("cut",), ("condition",)):
        return f"{key} is {shown(value)}; it must be a list of tables: write [[{key}]], not [{key}]"
    return f"{key} is {shown(value)}; it must be {ALLOWED.get(kind, fault['msg'])}"
