"""One file of a library: which kind of thing it describes, its name, its text, and what messages call it."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Final

from plant_models.errors import PlantError

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
