"""`retarder-synth init`: a configuration or a type to start from, and what the library holds."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from pkgutil import resolve_name
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from plant_models.library import Kind


@dataclass(frozen=True)
class Printed:
    """A configuration that is printed: its title, and as "module:NAME" its model and the function that makes its
    text."""

    title: str
    model: str
    text: str


CONFIGURATIONS: Final = {
    "": Printed(
        "Configuration",
        "synth.retarder.configuration.settings:Settings",
        "synth.retarder.configuration.config_template:default_config_toml",
    ),
    "point sensors": Printed(
        "Configuration with point sensors",
        "synth.retarder.configuration.settings:Settings",
        "synth.retarder.configuration.point_sensors.template:default_sensors_toml",
    ),
    "aim": Printed(
        "Aim configuration",
        "synth.aim.configuration.settings:AimFileSettings",
        "synth.aim.configuration.template:default_aim_toml",
    ),
    "hump": Printed(
        "Hump trial configuration",
        "synth.hump.configuration.settings:HumpTrialSettings",
        "synth.hump.configuration.template:default_trial_toml",
    ),
    "short hump": Printed(
        "Short hump file",
        "synth.hump.making.short_hump:ShortHump",
        "synth.hump.making.template:example_short_toml",
    ),
    "computer": Printed(
        "Configuration of a control computer",
        "synth.computer.settings:ComputerSettings",
        "synth.computer.template:default_computer_toml",
    ),
    "sweep": Printed(
        "Configuration with a sweep",
        "synth.retarder.sweep.sweep_settings:SweepFileSettings",
        "synth.retarder.sweep.template:default_sweep_toml",
    ),
}
"""The configurations by what asks for them, as `init_command` calls it."""


def init_command(types: dict[str, str | None], show_list: bool, as_json: bool) -> int:
    """Print a commented configuration, the file of one type, or the library's list.

    `types`: by folder of the library, the type that is asked for; '' for a usual one, None for none. A position under
    "retarders" asks for a configuration with it. Under "aim" '' asks for an aim configuration, a name for the file of a
    track or a car mix; under "hump" '' for a hump trial configuration, a name for the file of a hump; under "short
    hump", "computer" and "sweep" '' for theirs; under "point sensors" '' or the name of a position for one with point
    sensors.
    """
    if show_list:
        return print_list(as_json)
    print_file(*asked_for(types), as_json)
    return 0


def print_file(key: str, text: str, as_json: bool) -> None:
    """Print the `text` of a file; in JSON under a `key`."""
    print(json.dumps({key: text}, ensure_ascii=False) if as_json else text, end="\n" if as_json else "")


def tables_command(trial: Path | None, position_number: int | None, alone: bool, as_json: bool) -> int:
    """Print the configuration of the tables that a position needs in the hump `trial`; `alone`: nothing else of `init`
    is asked for."""
    from synth.frame.input_error import InputError

    if trial is None:
        raise InputError("init --position-number is for --for TRIAL.toml, the trial whose position it is; add that")
    if not alone:
        raise InputError("init --for prints the configuration of tables for a trial; give none of the other options")
    from synth.hump.tables.tables_configuration import tables_toml

    print_file("configuration", tables_toml(trial, position_number), as_json)
    return 0


def schema_command(types: dict[str, str | None]) -> int:
    """Print the JSON Schema of the configuration that is asked for, as `init_command` calls it."""
    from synth.frame.input_error import InputError
    from synth.frame.settings.schema import schema_of

    asked = [folder for folder, name in types.items() if name is not None]
    if len(asked) > 1 or (asked and (asked[0] not in CONFIGURATIONS or types[asked[0]])):
        raise InputError(
            "init --schema: there are schemas of configurations; give it alone, or with --sensors, --aim, --hump, "
            "--short-hump, --computer or --sweep"
        )
    asked_of = CONFIGURATIONS[asked[0] if asked else ""]
    print(schema_of(resolve_name(asked_of.model), f"{asked_of.title} of retarder-synth"), end="")
    return 0


def asked_for(types: dict[str, str | None]) -> tuple[str, str]:
    """(key in JSON, text) of what is to be printed; `InputError` where two files are asked for at once."""
    from synth.frame.input_error import InputError

    asked = [(kind, name) for kind, name in types.items() if name is not None]
    if len(asked) > 1:
        raise InputError("init prints one file at a time; give one of its options")
    kind, name = asked[0] if asked else ("", "")
    if kind in CONFIGURATIONS and not name:
        return "configuration", resolve_name(CONFIGURATIONS[kind].text)()
    return NAMED[kind](name) if kind in NAMED else type_file(kind, name)


def type_file(folder: str, name: str) -> tuple[str, str]:
    """As `asked_for`: the file of the type `name`, or of a usual one; of a position its configuration."""
    from plant_models.library import BUILT_IN, KINDS, POSITIONS, RETARDERS
    from synth.cli.type_template import type_toml
    from synth.retarder.configuration.config_template import default_config_toml
    from synth.retarder.configuration.position_choice import require_held

    (kind,) = (kind for kind in KINDS if kind.folder == folder)
    if kind == RETARDERS and name and name not in BUILT_IN.names(RETARDERS):
        require_held("retarder-synth init: --retarder", POSITIONS, name, BUILT_IN)
        return "configuration", default_config_toml(name)
    return "type", type_toml(kind, name or None)


def aim_type(name: str) -> tuple[str, str]:
    """As `asked_for`: the file of the track or car mix `name`."""
    from plant_models.library import BUILT_IN, CAR_MIXES, TRACKS
    from plant_models.library.near_miss import near_miss
    from synth.cli.type_template import type_toml
    from synth.frame.input_error import InputError

    for kind in (TRACKS, CAR_MIXES):
        if name in BUILT_IN.names(kind):
            return "type", type_toml(kind, name)
    known = (*BUILT_IN.names(TRACKS), *BUILT_IN.names(CAR_MIXES))
    raise InputError(f"init --aim {name}: the library has no such track or car mix; {near_miss(name, known)}")


def hump_type(name: str) -> tuple[str, str]:
    """As `asked_for`: the file of the hump `name`."""
    from plant_models.library.hump_entry import hump_names
    from plant_models.library.near_miss import near_miss
    from synth.frame.input_error import InputError
    from synth.hump.hump_file import hump_text

    if name not in hump_names():
        raise InputError(f"init --hump {name}: the library has no such hump; {near_miss(name, hump_names())}")
    return "type", hump_text(Path(name))


def no_types(option: str, noun: str, name: str) -> tuple[str, str]:
    """As `asked_for`: refused, for the library has no types of what `option` asks for."""
    from synth.frame.input_error import InputError

    raise InputError(f"init {option} {name}: the library has no {noun}; leave the name out")


def sensors_file(name: str) -> tuple[str, str]:
    """As `asked_for`: a configuration with point sensors, of the position `name` or as the file `name` has it."""
    from plant_models.library import BUILT_IN, POSITIONS
    from synth.retarder.configuration.point_sensors.template import default_sensors_toml, filled_sensors_toml
    from synth.retarder.configuration.position_choice import require_held

    if name.endswith(".toml"):
        return "configuration", filled_sensors_toml(Path(name))
    require_held("retarder-synth init: --sensors", POSITIONS, name, BUILT_IN)
    return "configuration", default_sensors_toml(name)


NAMED: Final[Mapping[str, Callable[[str], tuple[str, str]]]] = {
    "aim": aim_type,
    "hump": hump_type,
    "computer": partial(no_types, "--computer", "control computers"),
    "short hump": partial(no_types, "--short-hump", "short humps"),
    "point sensors": sensors_file,
    "sweep": partial(no_types, "--sweep", "sweeps"),
}
"""What an option for a configuration asks for by a name, by what `init_command` calls it."""


def print_list(as_json: bool) -> int:
    """What the library holds."""
    from plant_models.library import KINDS
    from synth.frame.terminal.printed_page import print_page

    titles = {kind.folder: titles_of(kind) for kind in KINDS}
    if as_json:
        document = {"retarders": titles["positions"], "library": titles}
        print(json.dumps(document, indent=1, ensure_ascii=False))
        return 0
    width = max(len(name) for found in titles.values() for name in found)
    page = []
    for kind in KINDS:
        page.append(f"{kind.folder}:")
        page += (f"  {name:<{width}}  {title}" for name, title in titles[kind.folder].items())
    print_page(*page)
    return 0


def titles_of(kind: Kind) -> dict[str, str]:
    """Titles of the types of a kind by name."""
    from plant_models.library import BUILT_IN
    from plant_models.library.data_file import parse_toml

    return {name: parse_toml(BUILT_IN.file(kind, name).text)["title"] for name in BUILT_IN.names(kind)}
