"""A configuration as its author wrote it, so that it can be written again with other numbers."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from plant_models.library import BUILT_IN, Library
from synth.configuration.config_file import valid_settings
from synth.configuration.own_types import with_own_types
from synth.configuration.resolved_config import ResolvedConfig, resolve
from synth.configuration.toml_file import Tree, read_text, toml_tree


@dataclass(frozen=True)
class ConfigSource:
    """A configuration as its author wrote it: names in place of paths, and his own types. None: the built-in one."""

    place: str
    tree: Tree
    library: Library

    def resolved(self) -> ResolvedConfig:
        """Every default filled in."""
        return resolve(valid_settings(self.tree, self.place), self.place, self.library)


def config_source(path: Path | None) -> ConfigSource:
    """The configuration in the file `path`; `InputError` on any fault."""
    if path is None:
        return ConfigSource("built-in configuration", {}, BUILT_IN)
    tree, library = with_own_types(toml_tree(read_text(path), str(path)), str(path))
    return ConfigSource(str(path), tree, library)
