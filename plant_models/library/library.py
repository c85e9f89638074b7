"""A library of types: the files that come with the program, and beside them the user's own; of each file which
kind of thing it describes, its name, its text, and what messages call it.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import Final

from plant_models.errors import PlantError, near_miss

NAME: Final = re.compile(r"[A-Za-z0-9](?:[A-Za-z0-9._-]{0,38}[A-Za-z0-9_-])?")
"""Of a type: names go into labels of cut classes, and these into file names and tables."""

DEVICE: Final = re.compile(r"(?:con|prn|aux|nul|com[0-9]|lpt[0-9])(?:\..*)?", re.IGNORECASE)
"""Names that Windows gives to devices."""


class TypeFileError(PlantError):
    """A file of a library is at fault; every one of the `sentences` begins with the file."""

    def __init__(self, *sentences: str) -> None:
        super().__init__("\n".join(sentences))
        self.sentences = sentences


@dataclass(frozen=True)
class Kind:
    """A kind of types: the `folder` of a library that holds its files, and the `noun` in messages."""

    folder: str
    noun: str


RETARDERS: Final = Kind("retarders", "retarder")
CARS: Final = Kind("cars", "car")
SENSORS: Final = Kind("sensors", "sensor")
WEIGHT_CATEGORIES: Final = Kind("weight_categories", "set of weight categories")
POSITIONS: Final = Kind("positions", "position")
TRACKS: Final = Kind("tracks", "track")
CAR_MIXES: Final = Kind("car_mixes", "car mix")
HUMPS: Final = Kind("humps", "hump")
WHEEL_SENSORS: Final = Kind("wheel_sensors", "wheel sensor")

KINDS: Final = (POSITIONS, RETARDERS, CARS, SENSORS, WHEEL_SENSORS, WEIGHT_CATEGORIES, TRACKS, CAR_MIXES)
"""Kinds of which a configuration may name a user's file; humps are files of their own."""


@dataclass(frozen=True)
class TypeFile:
    """The `text` of a file that describes the type `name`.

    `place`: the path that messages begin with. `origin`: how the configuration names the file, which stands behind the
    source of each of its numbers; '' for a file that comes with the program. Raises `TypeFileError` for a bad name.
    """

    kind: Kind
    name: str
    text: str
    place: str
    origin: str = ""

    def __post_init__(self) -> None:
        if not NAME.fullmatch(self.name) or DEVICE.fullmatch(self.name):
            raise TypeFileError(
                f"{self.place}: it gives the {self.kind.noun} the name {self.name!r}, but a name must have at most "
                "40 letters, digits, dots, hyphens and underscores, begin with a letter or digit, end with no dot, and "
                "be no device of Windows: rename the file"
            )


@dataclass(frozen=True)
class Library:
    """The types of the program and `own`, the user's files; a plain value that can be sent to another machine.

    No file of the user's may take a name that the program or another of the user's files has given: a table says by the
    name what it was made for. Positions and retarders share their names: messages call both by the name alone.
    Raises `TypeFileError`.
    """

    own: tuple[TypeFile, ...] = ()

    def __post_init__(self) -> None:
        taken: dict[tuple[str, str], str] = {}
        for file in self.own:
            shared = (POSITIONS, RETARDERS) if file.kind in (POSITIONS, RETARDERS) else (file.kind,)
            for kind in shared:
                same = next((name for name in built_in_names(kind) if name.lower() == file.name.lower()), None)
                if same is not None:
                    raise TypeFileError(
                        f"{file.place}: its name {file.name} is that of a {kind.noun} that comes with the program; "
                        "tables could be taken for those of that one: rename the file"
                    )
            for kind in shared:
                key = (kind.folder, file.name.lower())
                if key in taken:
                    raise TypeFileError(
                        f"{file.place}: {taken[key]} gives the name {file.name}, too; rename one of the two files"
                    )
            taken[file.kind.folder, file.name.lower()] = file.place

    def names(self, kind: Kind) -> tuple[str, ...]:
        """Names of all types of a kind, sorted."""
        return tuple(sorted((*built_in_names(kind), *(file.name for file in self.own if file.kind == kind))))

    def file(self, kind: Kind, name: str) -> TypeFile:
        """The file of the type `name`; `PlantError` with a hint if there is none."""
        for file in self.own:
            if (file.kind, file.name) == (kind, name):
                return file
        if name not in built_in_names(kind):
            raise PlantError(f"{kind.noun} {name!r} is not in the library; {near_miss(name, self.names(kind))}")
        text = files("plant_models.library").joinpath(kind.folder, f"{name}.toml").read_text(encoding="utf-8")
        return TypeFile(kind, name, text, f"{kind.folder}/{name}.toml")


BUILT_IN = Library()
"""What comes with the program."""


@cache
def built_in_names(kind: Kind) -> tuple[str, ...]:
    """Names (without .toml) of the files of a kind that come with the program, sorted."""
    entries = files("plant_models.library").joinpath(kind.folder).iterdir()
    return tuple(sorted(e.name.removesuffix(".toml") for e in entries if e.name.endswith(".toml")))
