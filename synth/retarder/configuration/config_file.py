"""Reading a configuration file: TOML → `Settings` → `ResolvedConfig`, every fault as one sentence."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from plant_models.library import BUILT_IN, Library
from synth.frame.settings.settings_file import BUILT_IN as BUILT_IN_PLACE
from synth.frame.settings.settings_file import settings_in
from synth.frame.settings.toml_file import Tree, read_text, toml_tree
from synth.frame.settings.toml_text import toml_text
from synth.retarder.configuration.own_types import with_own_types
from synth.retarder.configuration.resolved_config import ResolvedConfig, resolve
from synth.retarder.configuration.settings import Settings


def load_config(path: Path | None) -> ResolvedConfig:
    """The configuration in the file `path`, or the built-in default; `InputError` on any fault."""
    return config_source(path).resolved()


def parse_config(text: str, file: str) -> ResolvedConfig:
    """The configuration written in `text`; `file`: what messages call it, and where paths in it begin."""
    return source_of_text(text, file).resolved()


def valid_settings(tree: Tree, where: str) -> Settings:
    """The settings in `tree`; `InputError` with a sentence for each fault, which begins with `where`."""
    return settings_in(Settings, tree, where)


TYPES: Final = "types"
"""The folder of own types beside a configuration that is written."""


@dataclass(frozen=True)
class ConfigSource:
    """A configuration as its author wrote it: names in place of paths, and his own types. None: the built-in one."""

    place: str
    tree: Tree
    library: Library

    @property
    def reads(self) -> tuple[Path, ...]:
        """The files of his own types."""
        return tuple(Path(each.place) for each in self.library.own)

    def resolved(self) -> ResolvedConfig:
        """Every default filled in."""
        return resolve(valid_settings(self.tree, self.place), self.place, self.library)

    def files(self, name: str) -> dict[str, bytes]:
        """The files that tell it, by their paths in the folder of the configuration `name`; `place` is its head."""
        tree: dict[str, Any] = dict(self.tree)
        if self.library.own:
            tree["library"] = [f"{TYPES}/"]
        files = {f"{TYPES}/{each.kind.folder}/{each.name}.toml": each.text.encode() for each in self.library.own}
        head = f"# {self.place[:1].upper()}{self.place[1:]}.\n"
        return {**files, name: (head + toml_text(tree)).encode("utf-8")}


def config_source(path: Path | None) -> ConfigSource:
    """The configuration in the file `path`; `InputError` on any fault."""
    if path is None:
        return ConfigSource(BUILT_IN_PLACE, {}, BUILT_IN)
    return source_of_text(read_text(path), str(path))


def source_of_text(text: str, place: str) -> ConfigSource:
    """The configuration written in `text`; `place`: what messages call it, and where paths in it begin."""
    tree, library = with_own_types(toml_tree(text, place), place)
    return ConfigSource(place, tree, library)
