"""A commented configuration to start from: that of a position of the library."""

from __future__ import annotations

from synth.frame.settings.template import template
from synth.frame.settings.told import Told, Usual, told_numbers
from synth.retarder.configuration.plant_settings import DEFAULT_POSITION, PositionSettings
from synth.retarder.configuration.resolved_config import ResolvedConfig, resolve
from synth.retarder.configuration.settings import Settings


def default_config_toml(position_name: str = DEFAULT_POSITION) -> str:
    """The defaults for a position of the library as TOML; it reads back to the same configuration.

    `InputError` if the library has no such position.
    """
    config = resolve(Settings(position=PositionSettings(name=position_name)), "retarder-synth init")
    return template(Settings(), "Configuration", "tune", known_of(config), config.retarder.notes)


def known_of(config: ResolvedConfig) -> Usual:
    """What position and weight categories have, by the keys of the configuration."""
    return {
        **told_numbers(config.parameters),
        "title": Told(config.title),
        "position.name": Told(config.retarder.name),
        **{f"cut[{place}].category": Told(cut.cut.category) for place, cut in enumerate(config.cuts)},
    }
