"""Reading a file with a table [sweep]: every fault as one sentence, each condition as an ordinary configuration."""

from __future__ import annotations

import json
from collections.abc import Iterator
from copy import deepcopy
from dataclasses import dataclass, replace

from pydantic import ValidationError

from plant_models.library import BUILT_IN, Library, SourcedValue
from synth.frame.faults import InputError
from synth.frame.settings.numbers import numbers_of
from synth.frame.settings.settings_file import faults_in
from synth.frame.settings.toml_file import Tree, toml_tree
from synth.retarder.configuration.config_file import valid_settings
from synth.retarder.configuration.own_types import with_own_types
from synth.retarder.configuration.plant_settings import DEFAULT_CUTS
from synth.retarder.configuration.resolved_config import ResolvedConfig, resolve
from synth.retarder.sweep.sweep_settings import SweepSettings, SweepTable
from tuning_tables.json_text import canonical_json


@dataclass(frozen=True)
class Condition:
    """A condition: `tree` is its whole configuration as TOML would give it, `config` the same resolved.

    `name`: '' for the only one where the file lists none. The tree names types, of which `library` has the user's own.
    """

    name: str
    tree: Tree
    config: ResolvedConfig
    library: Library = BUILT_IN

    def said(self, sentence: str) -> str:
        """`sentence`, and before it which condition it is about."""
        return f"{self.name}: {sentence}" if self.name else sentence

    def file(self, name: str) -> str:
        """The name of a file of its own in the directory of the sweep."""
        return f"{self.name}/{name}" if self.name else name


@dataclass(frozen=True)
class SweepFile:
    """What a file asks for; `base`: the configuration that conditions differ from."""

    settings: SweepSettings
    base: ResolvedConfig
    conditions: tuple[Condition, ...]

    @property
    def canonical_json(self) -> str:
        """That of the configuration, and of all of them by name where there are conditions."""
        if not self.settings.condition:
            return self.base.canonical_json()
        found = {each.name: json.loads(each.config.canonical_json()) for each in self.conditions}
        return canonical_json({"conditions": found}).decode()

    def parameters(self) -> Iterator[SourcedValue]:
        """Every number: of the configuration, of [sweep], and what is other under a condition."""
        yield from self.base.parameters
        yield from numbers_of(self.settings, "sweep")
        known = set(self.base.parameters)
        for condition in self.conditions:
            others = (each for each in condition.config.parameters if each not in known)
            yield from (replace(each, key=condition.said(each.key)) for each in others)


def parse_sweep(text: str, file: str) -> SweepFile:
    """The sweep written in `text`; `file` is what messages call it."""
    tree, library = with_own_types(toml_tree(text, file), file)
    try:
        settings = SweepTable.model_validate({"sweep": tree.pop("sweep", {})}).sweep
    except ValidationError as error:
        raise InputError(*(f"{file}: {sentence}" for sentence in faults_in(error, SweepTable))) from None
    valid_settings(tree, file)
    swept = swept_tree(tree, settings)
    base = resolve(valid_settings(swept, file), file, library)
    if base.regulator.estimator and settings.interpolation_loss_m_s is not None:
        raise InputError(
            f"{file}: regulator.estimator is true and sweep.interpolation_loss_m_s is "
            f"{settings.interpolation_loss_m_s:g}, but lines for the estimated speed have no exact prediction to "
            "measure that loss by; leave out one of the two"
        )
    conditions = []
    for place, condition in enumerate(settings.condition):
        where = f'{file}: in sweep.condition[{place}], "{condition.name}"'
        merged = overlaid(swept, condition.changes())
        config = resolve(valid_settings(merged, where), where, library)
        conditions.append(Condition(condition.name, merged, config, library))
    return SweepFile(settings, base, tuple(conditions) or (Condition("", swept, base, library),))


def swept_tree(tree: Tree, settings: SweepSettings) -> Tree:
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


def overlaid(tree: Tree, changes: Tree) -> Tree:
    """`tree` with the values of `changes` in their places; tables are merged, all else is replaced."""
    merged = deepcopy(tree)
    for key, value in changes.items():
        below = merged.get(key)
        merged[key] = overlaid(below, value) if isinstance(below, dict) and isinstance(value, dict) else deepcopy(value)
    return merged
