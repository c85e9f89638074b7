"""A library of types: the files that come with the program, and beside them the user's own."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from importlib.resources import files

from plant_models.errors import PlantError
from plant_models.library.near_miss import near_miss
from plant_models.library.type_file import POSITIONS, RETARDERS, Kind, TypeFile, TypeFileError


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
