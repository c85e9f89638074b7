"""The position that a configuration names, with the user's types and values in it."""

from __future__ import annotations

from plant_models.library import POSITIONS, RETARDERS, SENSORS, Library, PositionEntry
from plant_models.library.position_entry import position_with_types
from synth.frame.input_error import InputError
from synth.retarder.configuration.plant_fault import in_file, require_held
from synth.retarder.configuration.plant_settings import DEFAULT_POSITION
from synth.retarder.configuration.settings import Settings


def resolve_position(settings: Settings, file: str, library: Library) -> PositionEntry:
    """The library's position, other types in it where the file says so, and the values that it sets."""
    name = require_held(f"{file}: position.name", POSITIONS, settings.position.name or DEFAULT_POSITION, library)
    types = (("retarder.type", RETARDERS, settings.retarder.type), ("sensor.type", SENSORS, settings.sensor.type))
    for key, kind, chosen in types:
        if chosen is not None:
            require_held(f"{file}: {key}", kind, chosen, library)
    zones = settings.retarder.zones_m
    if zones is not None and zones[0][0] != 0.0:
        raise InputError(
            f"{file}: retarder.zones_m begins with {zones[0]}; the first zone must start at 0, the entrance"
        )
    with in_file(file):
        entry = position_with_types(name, library, settings.retarder.type, settings.sensor.type)
        return entry.with_values(settings.library_overrides())
