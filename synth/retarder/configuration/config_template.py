"""A commented configuration to start from: that of a position of the library."""

from __future__ import annotations

from pathlib import Path
from typing import Final

from plant_models.library import PositionEntry
from synth.frame.input_error import InputError
from synth.frame.settings.template import template
from synth.frame.settings.told import Told, Usual, told_numbers
from synth.retarder.configuration.config_file import config_source, parse_config, valid_settings
from synth.retarder.configuration.plant_settings import DEFAULT_CUTS, DEFAULT_POSITION, CutSettings, PositionSettings
from synth.retarder.configuration.point_sensors.settings import PointSensorSettings
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


DUMPER_POSITION: Final = "rnz-2m-dumper"
EMPTY_CUTS: Final = (
    CutSettings(car="gondola-4", mass_t=22.0, allowed_stage=3),
    CutSettings(car="gondola-6", mass_t=32.0, allowed_stage=3),
)
"""What comes behind a car dumper. Stage 3 with oil brakes no harder than stage 2, theirs elsewhere, without."""

BUILT_IN_SENSORS: Final = "built-in configuration with point sensors"

USUAL_SENSORS: Final = 9
AHEAD_S: Final = 1.0
"""How long the fastest cut rolls from the first sensor to the entrance: a change of stage is over by then."""

LONGEST_CAR_M: Final = 14.5
"""A little more than from the first axle to the last of a car: the last sensor stands behind the exit."""


def built_in_sensors() -> ResolvedConfig:
    """What `init point-sensors` prints."""
    return parse_config(default_sensors_toml(), BUILT_IN_SENSORS)


def default_sensors_toml(position_name: str = DUMPER_POSITION) -> str:
    """A configuration of a position of the library with sensors at equal distances; it reads back the same.

    `InputError` if the library has no such position.
    """
    position = PositionSettings(name=position_name)
    entry = resolve(Settings(position=position), "retarder-synth init").retarder
    settings = Settings(
        position=position,
        sensors=PointSensorSettings(path_m=usual_places(entry)),
        cut=EMPTY_CUTS if position_name == DUMPER_POSITION else DEFAULT_CUTS,
    )
    config = resolve(settings, "retarder-synth init")
    return template(settings, "Configuration with point sensors", "tune", known_of(config), entry.notes)


def filled_sensors_toml(path: Path) -> str:
    """The configuration at `path`, as `sensors` leaves one, with every default and comment.

    `InputError` for any fault, where it has no sensors, and where it names own types, which lie beside it.
    """
    source = config_source(path)
    settings, config = valid_settings(source.tree, source.place), source.resolved()
    if settings.sensors is None:
        raise InputError(f"{path}: there is no section [sensors]; 'retarder-synth sensors' leaves such files")
    if source.library.own:
        raise InputError(f"{path}: it names types of your own; copy the file with its folder of types instead")
    known, notes = known_of(config), config.retarder.notes
    return template(settings, "Configuration with point sensors", "tune", known, notes)


def usual_places(entry: PositionEntry) -> tuple[float, ...]:
    """Places from ahead of the entrance to behind the exit, at equal distances, rounded to decimetres."""
    first = -AHEAD_S * entry.entry.high_m_s
    last = entry.position.zones_m[-1][1] + LONGEST_CAR_M
    step = (last - first) / (USUAL_SENSORS - 1)
    return tuple(round(first + step * number, 1) for number in range(USUAL_SENSORS))
