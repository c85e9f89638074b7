"""A configuration as a file: read, TOML → `Settings` → `ResolvedConfig`, every fault as one sentence; and a commented
one to start from, that of a position of the library.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from plant_models.library import BUILT_IN, Library, PositionEntry
from synth.frame.faults import InputError
from synth.frame.settings.numbers import Told, Usual, told_numbers
from synth.frame.settings.settings_file import BUILT_IN as BUILT_IN_PLACE
from synth.frame.settings.settings_file import settings_in
from synth.frame.settings.template import template, toml_text
from synth.frame.settings.toml_file import Tree, read_text, toml_tree
from synth.retarder.configuration.own_types import with_own_types
from synth.retarder.configuration.plant_settings import (
    DEFAULT_CUTS,
    DEFAULT_POSITION,
    CutSettings,
    PointSensorSettings,
    PositionSettings,
)
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
