"""A commented configuration with point sensors: a position, its sensors, and the cuts that come there."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from plant_models.library import BUILT_IN, WHEEL_SENSORS, PositionEntry
from synth.retarder.configuration.config_file import parse_config
from synth.retarder.configuration.config_template import lines, origin, quoted, source_lines, toml_value
from synth.retarder.configuration.plant_settings import DEFAULT_CUTS, CutSettings, PositionSettings
from synth.retarder.configuration.point_sensors.resolved_sensors import SECTION, ResolvedSensors
from synth.retarder.configuration.point_sensors.settings import PointSensorSettings
from synth.retarder.configuration.resolved_config import ResolvedConfig, resolve
from synth.retarder.configuration.settings import Settings

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
    """What `sensors tune` takes where no configuration is given."""
    return parse_config(default_sensors_toml(), BUILT_IN_SENSORS)


def default_sensors_toml(position_name: str = DUMPER_POSITION) -> str:
    """A configuration of a position of the library with sensors at equal distances; it reads back the same.

    `InputError` if the library has no such position.
    """
    position = PositionSettings(name=position_name)
    entry = resolve(Settings(position=position), "retarder-synth init").retarder
    config = resolve(
        Settings(
            position=position,
            sensors=PointSensorSettings(path_m=usual_places(entry)),
            cut=EMPTY_CUTS if position_name == DUMPER_POSITION else DEFAULT_CUTS,
        ),
        "retarder-synth init",
    )
    assert config.sensors is not None
    text = (*lines(config), *section_lines(config.sensors))
    return "\n".join((*text, *source_lines(text))) + "\n"


def usual_places(entry: PositionEntry) -> tuple[float, ...]:
    """Places from ahead of the entrance to behind the exit, at equal distances, rounded to decimetres."""
    first = -AHEAD_S * entry.entry.high_m_s
    last = entry.position.zones_m[-1][1] + LONGEST_CAR_M
    step = (last - first) / (USUAL_SENSORS - 1)
    return tuple(round(first + step * number, 1) for number in range(USUAL_SENSORS))


def section_lines(resolved: ResolvedSensors) -> Iterator[str]:
    """The section [sensors]."""
    yield from ("", "[sensors]")
    yield "# Point sensors (retarder-synth sensors tune): they stand in place of [sensor] and [regulator] approach_m."
    yield f"# one of the library: {', '.join(BUILT_IN.names(WHEEL_SENSORS))}; or the path of your own file"
    yield f"type = {quoted(resolved.type)}"
    places, *numbers = resolved.provenance
    yield "# m from the entrance of the first retarder to the middle of each sensor's base, rising, at least 0.3 apart;"
    yield "# the first at the entrance or ahead of it, and one behind the exit may log. Yours stand where you put them."
    yield f"path_m = {toml_value(places.value)}"
    yield '# at whose passages the regulator decides: "first_axle" or "every_axle"'
    yield f"decides_on = {quoted(resolved.decides_on)}"
    for value in numbers:
        yield from (f"# {origin(value)}", f"{value.key.removeprefix(SECTION)} = {toml_value(value.value)}")
