"""Reading a configuration file: TOML → `Settings` → `ResolvedConfig`, every fault as one sentence."""

from __future__ import annotations

from pathlib import Path

from synth.frame.settings.settings_file import BUILT_IN, settings_in
from synth.frame.settings.toml_file import Tree, read_text, toml_tree
from synth.retarder.configuration.own_types import with_own_types
from synth.retarder.configuration.resolved_config import ResolvedConfig, resolve
from synth.retarder.configuration.settings import Settings


def load_config(path: Path | None) -> ResolvedConfig:
    """The configuration in the file `path`, or the built-in default; `InputError` on any fault."""
    if path is None:
        return resolve(Settings(), BUILT_IN)
    return parse_config(read_text(path), str(path))


def parse_config(text: str, file: str) -> ResolvedConfig:
    """The configuration written in `text`; `file`: what messages call it, and where paths in it begin."""
    tree, library = with_own_types(toml_tree(text, file), file)
    return resolve(valid_settings(tree, file), file, library)


def valid_settings(tree: Tree, where: str) -> Settings:
    """The settings in `tree`; `InputError` with a sentence for each fault, which begins with `where`."""
    return settings_in(Settings, tree, where)
