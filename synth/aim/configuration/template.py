"""A commented aim configuration to start from: every default written out with its unit, range and origin."""

from __future__ import annotations

import json
from collections.abc import Iterator

from plant_models.library import (
    BUILT_IN,
    CAR_MIXES,
    POSITIONS,
    TRACKS,
    WEIGHT_CATEGORIES,
    YARD_CATEGORIES,
    Kind,
    SourcedValue,
    TrackEntry,
    load_track,
    load_weight_categories,
)
from plant_models.library.car_mix_entry import load_car_mix
from plant_models.rolling.roll_track import RollTrack
from synth.aim.configuration.parameters import DEFAULT_EXIT_STD_M_S
from synth.aim.configuration.settings import (
    DEFAULT_MIX,
    DEFAULT_TRACK,
    AimAcceptanceSettings,
    AimedSettings,
    CutsSettings,
    ResistanceSettings,
    WeatherSettings,
)
from synth.aim.configuration.simulation_settings import SimulationSettings
from synth.frame.settings.numbers import numbers_of
from synth.frame.settings.output import OutputSettings
from synth.frame.settings.section import Section, setting_unit
from synth.retarder.configuration.config_template import origin, quoted, source_lines, switch_lines

HEAD = """\
# Aim configuration of retarder-synth (retarder-synth aim). Every line shows its default and may be left out.
# A comment says: unit; sensible range (limits, for settings of the tool); origin. Sources stand at the end.
# ASSUMED: no citable source stands behind the number; replace it by that of your yard."""


def default_aim_toml() -> str:
    """The defaults as TOML; it reads back to the same aim configuration."""
    text = tuple(lines(load_track(DEFAULT_TRACK)))
    return "\n".join((*text, *source_lines(text))) + "\n"


def lines(track: TrackEntry) -> Iterator[str]:
    """The lines of the file."""
    yield HEAD
    yield from (f"# Note: {note}" for note in track.notes)
    yield '# title = "…"'
    yield '# Your own types (docs/own-types.md) are found in folders: library = ["my-types/"]'
    yield f"# one of the library: {names(WEIGHT_CATEGORIES)}; or the path of your own file"
    yield f"weight_categories = {quoted(YARD_CATEGORIES)}"
    yield from track_lines(track)
    values = {value.key: value for value in track.provenance}
    yield from ("", "[position]", f"# the park position, one of the library: {names(POSITIONS)}; or your own")
    yield f"name = {quoted(track.position)}"
    yield from (line for key in ("entrance_m", "exit_m") for line in value_lines(values[f"position.{key}"]))
    yield from ("", "[stretch]", "# where cuts roll freely between the bunch position and the park position")
    stretch = ("from_m", "to_m", "speed_mean_m_s", "speed_std_m_s")
    yield from (line for key in stretch for line in value_lines(values[f"stretch.{key}"]))
    yield from ("", "[weather]", *setting_lines("weather", WeatherSettings()))
    yield from (
        "",
        "[resistance]",
        '# "hump-norm": gamma law by weight category, or "tb-10062": normal law by mass and',
    )
    yield from ("# temperature, from the Chinese norm", 'law = "hump-norm"')
    yield from setting_lines("resistance", ResistanceSettings())
    yield from cut_lines()
    yield from aim_lines()
    yield from ("", "[simulation]", *setting_lines("simulation", SimulationSettings()))
    yield from ("", "[acceptance]", *setting_lines("acceptance", AimAcceptanceSettings()))
    yield from ("", "[output]", *switch_lines(OutputSettings))


def track_lines(track: TrackEntry) -> Iterator[str]:
    """[track]; its elements and bends stand as comments in the form that replaces them."""
    values = {value.key: value for value in track.provenance}
    yield from ("", "[track]", f"# one of the library: {names(TRACKS)}; or the path of your own file")
    yield f"name = {quoted(track.name)}"
    yield "# In place of its elements and bends (remove the leading # of all lines of a list; metres from the crest):"
    yield f"# {origin(values['track.grade_permille'])}"
    yield from (f"# {line}" for line in element_lines(track.track))
    yield f"# {origin(values['bends.turn_deg'])}"
    yield from (f"# {line}" for line in bend_lines(track.track))


def element_lines(track: RollTrack) -> Iterator[str]:
    """The elements of a track as TOML."""
    breaks = track.breaks_m
    yield "elements = ["
    for begins, ends, grade in zip(breaks[:-1], breaks[1:], track.profile.grades_permille, strict=True):
        yield f"    {{ from_m = {begins!r}, to_m = {ends!r}, grade_permille = {grade!r} }},"
    yield "]"


def bend_lines(track: RollTrack) -> Iterator[str]:
    """The bends of a track as TOML."""
    yield "bends = ["
    for bend in track.bends:
        turned = f"switches = {bend.switches}, turn_deg = {bend.turn_deg!r}"
        yield f"    {{ from_m = {bend.from_m!r}, to_m = {bend.to_m!r}, {turned} }},"
    yield "]"


def cut_lines() -> Iterator[str]:
    """[cuts]."""
    mix, defaults = load_car_mix(DEFAULT_MIX), CutsSettings()
    values = {value.key: value for value in mix.provenance}
    yield from ("", "[cuts]", f"# one of the library: {names(CAR_MIXES)}; or the path of your own file")
    yield f"mix = {quoted(mix.name)}"
    for key in ("following_share", "underload_mean_t"):
        yield from value_lines(values[key])
    members = ", ".join(quoted(member.name) for member in load_weight_categories().members)
    yield from ("# weight categories that get a table", f"categories = [{members}]")
    yield from ("# numbers of cars in a cut, at most 60 each, increasing", f"cars = {list(defaults.cars)}")


def aim_lines() -> Iterator[str]:
    """[aim]."""
    defaults = AimedSettings()
    yield from ("", "[aim]", *setting_lines("aim", defaults))
    yield "# m; increasing; what the head of a cut has still to roll when its last axle leaves the position"
    yield f"free_distances_m = {list(defaults.free_distances_m)}"
    yield '# what is known of a cut beside its cars: its weight "category", or besides its resistance, "measured"'
    yield f"knowledge = {json.dumps(list(defaults.knowledge))}"
    yield "# m/s; standard deviation of the exit speed about the commanded one"
    yield f"exit_std_m_s = {DEFAULT_EXIT_STD_M_S!r}"
    yield "# or, in its place, a book of the position's controller tables: closed loops say how exact they are"
    yield '# tables = "out/book.h5"'
    yield '# tables_config = "my.toml"  # the configuration that it was tuned with; left out: the built-in one'


def setting_lines(name: str, section: Section) -> Iterator[str]:
    """The numerical settings of a section."""
    values = {value.key.rpartition(".")[2]: value for value in numbers_of(section, name)}
    for key, field in type(section).model_fields.items():
        if setting_unit(field):
            yield f"# {field.description}"
            yield from (f"# {origin(values[key])}", f"{key} = {getattr(section, key)!r}")


def value_lines(value: SourcedValue) -> Iterator[str]:
    """A number of the library."""
    yield from (f"# {origin(value)}", f"{value.key.rpartition('.')[2]} = {value.value!r}")


def names(kind: Kind) -> str:
    """Names of the library's types of a kind."""
    return ", ".join(BUILT_IN.names(kind))
