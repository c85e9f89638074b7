"""The kinds of files that a user writes: what `init` prints of each, what a name may be behind it, and its schema.

What makes text and schema is imported when it is asked for, so that the list costs nothing.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from pkgutil import resolve_name
from typing import TYPE_CHECKING, Any, Final

from synth.frame.arguments import library_names

if TYPE_CHECKING:
    from plant_models.library import Kind


@dataclass(frozen=True)
class FileKind:
    """A kind of files; `word` as it is typed, `title` of such a file, `help` what it is for.

    `text`: the file with the name that is given, "" for none; `InputError`. `schema`: its JSON Schema. `folder`: of
    the library, where the names are; "" where there is one file alone.
    """

    word: str
    title: str
    text: Callable[[str], str]
    schema: Callable[[], Mapping[str, Any]]
    folder: str = ""

    @property
    def names(self) -> list[str]:
        """What may be given as a name, of the library."""
        return library_names(self.folder) if self.folder else []

    @property
    def schema_name(self) -> str:
        """The file beside those of this kind in which editors find the schema."""
        return f"{self.word}.schema.json"


def declared(word: str, title: str, model: str, text: str) -> FileKind:
    """A kind with one file, made by the function `text` of the declared `model`, each "module:NAME"."""

    def made(name: str) -> str:
        if name:
            from synth.frame.faults import InputError

            raise InputError(f"init {word} {name}: there is one such file, without a name; leave {name} out")
        found: str = resolve_name(text)()
        return found

    return FileKind(word, title, made, partial(model_schema, title, model))


def model_schema(title: str, model: str) -> Mapping[str, Any]:
    """The schema of a declared model, which is called "module:NAME"."""
    from synth.frame.settings.numbers import schema_of

    return schema_of(resolve_name(model), title)


SETTINGS: Final = "synth.retarder.configuration.settings:Settings"


def configuration_text(name: str) -> str:
    """The configuration of the position `name`."""
    from plant_models.library import BUILT_IN, POSITIONS
    from synth.retarder.configuration.config_file import default_config_toml
    from synth.retarder.configuration.plant_fault import require_held

    if not name:
        return default_config_toml()
    return default_config_toml(require_held("retarder-synth init configuration", POSITIONS, name, BUILT_IN))


def point_sensors_text(name: str) -> str:
    """A configuration with point sensors, of the position `name` or as the file `name` has it."""
    from plant_models.library import BUILT_IN, POSITIONS
    from synth.retarder.configuration.config_file import default_sensors_toml, filled_sensors_toml
    from synth.retarder.configuration.plant_fault import require_held

    if name.endswith(".toml"):
        return filled_sensors_toml(Path(name))
    if not name:
        return default_sensors_toml()
    return default_sensors_toml(require_held("retarder-synth init point-sensors", POSITIONS, name, BUILT_IN))


def kind_of(folder: str) -> Kind:
    """The kind of types whose files lie in `folder`."""
    from plant_models.library.library import HUMPS, KINDS

    (kind,) = (kind for kind in (*KINDS, HUMPS) if kind.folder == folder)
    return kind


def type_text(folder: str, name: str) -> str:
    """The file of the type `name`, or of a usual one."""
    from synth.cli.type_template import type_toml

    return type_toml(kind_of(folder), name or None)


def type_schema(folder: str) -> Mapping[str, Any]:
    """That of the files of types."""
    from plant_models.library.type_schema import type_schema as schema

    return schema(kind_of(folder))


def of_library(word: str, title: str, folder: str) -> FileKind:
    """A kind of types."""
    return FileKind(word, title, partial(type_text, folder), partial(type_schema, folder), folder)


def hump_text(name: str) -> str:
    """The file of the hump `name`."""
    from plant_models.errors import near_miss
    from plant_models.library.hump_entry import hump_names
    from synth.frame.faults import InputError
    from synth.hump import hump_file

    if name and name not in hump_names():
        raise InputError(f"init hump {name}: the library has no such hump; {near_miss(name, hump_names())}")
    return hump_file.hump_text(Path(name or USUAL_HUMP))


USUAL_HUMP: Final = "medium"
"""What is printed where no hump is named."""


def hump_schema() -> Mapping[str, Any]:
    """That of hump files."""
    from plant_models.library.hump_schema import hump_schema as schema

    return schema()


FILE_KINDS: Final = (
    FileKind(
        "configuration",
        "Configuration of tables",
        configuration_text,
        partial(model_schema, "Configuration of retarder-synth", SETTINGS),
        "positions",
    ),
    FileKind(
        "point-sensors",
        "Configuration of tables for point sensors",
        point_sensors_text,
        partial(model_schema, "Configuration with point sensors of retarder-synth", SETTINGS),
        "positions",
    ),
    declared(
        "sweep",
        "Configuration with a sweep",
        "synth.retarder.sweep.sweep_settings:SweepFileSettings",
        "synth.retarder.sweep.sweep_settings:default_sweep_toml",
    ),
    declared(
        "aim",
        "Configuration of aim tables",
        "synth.aim.configuration.settings:AimFileSettings",
        "synth.aim.configuration.aim_file:default_aim_toml",
    ),
    declared(
        "trial",
        "Configuration of a hump trial",
        "synth.hump.configuration.settings:HumpTrialSettings",
        "synth.hump.configuration.trial_file:default_trial_toml",
    ),
    declared(
        "computer",
        "Configuration of a control computer",
        "synth.computer.settings:ComputerSettings",
        "synth.computer.settings:default_computer_toml",
    ),
    declared(
        "short-hump",
        "Short file that hump make turns into a hump file",
        "synth.hump.making.short_hump:ShortHump",
        "synth.hump.making.short_file:example_short_toml",
    ),
    declared(
        "yard",
        "Yard that hump watch watches",
        "synth.hump.watching.settings:YardWatchSettings",
        "synth.hump.watching.settings:example_yard_toml",
    ),
    FileKind("hump", "Hump file", hump_text, hump_schema, "humps"),
    of_library("position", "Position of retarders", "positions"),
    of_library("retarder", "Type of retarder", "retarders"),
    of_library("car", "Type of car", "cars"),
    of_library("sensor", "Type of radar", "sensors"),
    of_library("wheel-sensor", "Type of point speed sensor", "wheel_sensors"),
    of_library("weight-categories", "Set of weight categories", "weight_categories"),
    of_library("track", "Track of an aim configuration", "tracks"),
    of_library("car-mix", "Mix of cars", "car_mixes"),
)
"""In the order of the help; the first is what `init` prints where no kind is typed."""
