"""The user's own types: the keys that name them, at the top of every configuration of tables and trains, the files
that it names by path, and those in the folders of its `library`.

Paths in a file begin at its folder. What is found is a plain value, and the configuration is left with names only: so a
unit of a sweep can be sent to another machine without any file.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from copy import deepcopy
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Final

from plant_models import PlantError
from plant_models.errors import close_name
from plant_models.library import (
    BUILT_IN,
    CAR_MIXES,
    CARS,
    KINDS,
    POSITIONS,
    RETARDERS,
    SENSORS,
    TRACKS,
    WEIGHT_CATEGORIES,
    WHEEL_SENSORS,
    YARD_CATEGORIES,
    Kind,
    Library,
    TypeFile,
    TypeFileError,
)
from plant_models.library.data_file import parse_toml
from synth.frame.faults import InputError
from synth.frame.settings.numbers import Title
from synth.frame.settings.section import Section, choice, many
from synth.frame.settings.toml_file import Tree, read_text
from tuning_tables.errors import excerpt


def named_type(default: str | None, kind: Kind, meaning: str) -> Any:
    """A key that names a type, of the library or the user's own; `default` None: what it is then is told elsewhere."""
    names = BUILT_IN.names(kind)
    return choice(default, f"{meaning}; one of {', '.join(names)}, or the path of your own file", names[0])


class TopKeys(Section):
    """Title, and where types are from."""

    title: Title | None = choice(None, "title of the page", "…")
    library: tuple[str, ...] = many(
        (), 0, 20, "folders", "folders with your own types (docs/how-to/own-types.md)", example=["my-types/"]
    )
    weight_categories: str = named_type(YARD_CATEGORIES, WEIGHT_CATEGORIES, "the weight categories")


SUFFIX: Final = ".toml"

MOST_FILES: Final = 1000
"""Of one folder of a library."""

INIT_WORDS: Final = {
    CARS: "car",
    RETARDERS: "retarder",
    POSITIONS: "position",
    SENSORS: "sensor",
    WHEEL_SENSORS: "wheel-sensor",
    WEIGHT_CATEGORIES: "weight-categories",
    TRACKS: "track",
    CAR_MIXES: "car-mix",
}
"""What has `retarder-synth init` print a file of a kind."""


@dataclass(frozen=True)
class Collection:
    """The own files found so far, each path once."""

    found: dict[Path, TypeFile] = field(default_factory=dict)

    def take(self, kind: Kind, path: Path, origin: str, named_by: str) -> str:
        """Take the file at `path`, and what it refers to by path; the name of its type."""
        try:
            key = path.resolve()
            there = path.exists()
        except (OSError, ValueError, RuntimeError):  # a name that no file can have
            key, there = path, False
        if not there:
            raise InputError(
                f"{named_by} names the file {excerpt(str(path), 200)!r}, which does not exist; "
                f"'retarder-synth init {INIT_WORDS[kind]}' prints one to start from"
            )
        known = self.found.get(key)
        if known is not None:
            return known.name
        file = type_file(kind, path, origin)
        self.found[key] = self.with_types_named(file, path) if kind == POSITIONS else file
        return file.name

    def with_types_named(self, file: TypeFile, path: Path) -> TypeFile:
        """The position `file` with names in place of the paths of its types, which are taken, too."""
        text = file.text
        for key, below in (("retarder", RETARDERS), ("sensor", SENSORS)):
            reference = top_level_string(text, key)
            if reference is not None and is_path(reference):
                origin = f"{file.origin.rpartition('/')[0]}/{reference}".removeprefix("/")
                name = self.take(below, path.parent / reference, origin, f"{path}: {key}")
                text = re.sub(rf"^{key}[ \t]*=.*$", f'{key} = "{name}"', text, count=1, flags=re.MULTILINE)
                if top_level_string(text, key) != name:
                    raise InputError(f"{path}: {key} is {excerpt(reference)!r}; write this key in a line of its own")
        return replace(file, text=text)


def with_own_types(tree: Tree, file: str) -> tuple[Tree, Library]:
    """`tree` with names in place of paths, and the library that has them; `file`: the configuration, in messages.

    Values of wrong types are left for whoever checks the tree. `InputError` for each file or folder that is not there
    or cannot be read, and for names that are taken.
    """
    collection, folder = Collection(), Path(file).parent
    named = deepcopy(tree)
    faults: list[str] = []
    for place, entry in enumerate(folders_in(tree)):
        try:
            take_folder(collection, folder / entry, entry, f"{file}: library[{place}]")
        except InputError as fault:
            faults += fault.sentences
    for table, key, kind, where in references_in(named):
        if is_path(table.get(key)):
            try:
                table[key] = collection.take(kind, folder / table[key], table[key], f"{file}: {where}")
            except InputError as fault:
                faults += fault.sentences
    if faults:
        raise InputError(*faults)
    try:
        return named, Library(tuple(collection.found.values()))
    except TypeFileError as error:
        raise InputError(*(excerpt(sentence, 400) for sentence in error.sentences)) from None


def folders_in(tree: Tree) -> list[str]:
    """The folders of the key `library`; none where it is no list of strings."""
    folders = tree.get("library")
    return [entry for entry in folders if isinstance(entry, str)] if isinstance(folders, list) else []


def take_folder(collection: Collection, folder: Path, entry: str, where: str) -> None:
    """Take every file of a library's folder."""
    if not folder.is_dir():
        raise InputError(
            f"{where} is {excerpt(entry, 200)!r}, and there is no such folder; give one that holds "
            f"{', '.join(kind.folder + '/' for kind in KINDS)} or some of these"
        )
    kinds = {kind.folder: kind for kind in KINDS}
    for below in sorted(path for path in folder.iterdir() if path.is_dir()):
        meant = close_name(below.name, kinds)
        if meant is None:
            continue
        files = sorted(below.glob(f"*{SUFFIX}"))
        if files and below.name not in kinds:
            raise InputError(f"{where}: {below} is no folder of a library; did you mean {meant}?")
        if len(files) > MOST_FILES:
            raise InputError(f"{where}: {below} holds {len(files)} files; at most {MOST_FILES} are read")
        for path in files:
            collection.take(kinds[below.name], path, f"{entry.rstrip('/')}/{below.name}/{path.name}", where)


def references_in(tree: Tree) -> Iterator[tuple[dict[str, Any], str, Kind, str]]:
    """(table, key, kind, dotted key) of every place of a configuration or sweep that may name a type."""
    yield tree, "weight_categories", WEIGHT_CATEGORIES, "weight_categories"
    yield from references_of_position(tree, "")
    for where, cut in tables_in(tree, "cut"):
        yield cut, "car", CARS, f"{where}.car"
        for below, cars in tables_in(cut, "consist"):
            yield cars, "car", CARS, f"{where}.{below}.car"
    sweep = tree.get("sweep")
    if isinstance(sweep, dict):
        for where, cut in tables_in(sweep, "cut"):
            yield cut, "car", CARS, f"sweep.{where}.car"
        for where, condition in tables_in(sweep, "condition"):
            yield from references_of_position(condition, f"sweep.{where}.")


def references_of_position(tree: Tree, prefix: str) -> Iterator[tuple[dict[str, Any], str, Kind, str]]:
    """The places that name a position and the types there, and those of an aim or hump trial configuration."""
    for section, key, kind in (
        ("position", "name", POSITIONS),
        ("retarder", "type", RETARDERS),
        ("sensor", "type", SENSORS),
        ("sensors", "type", WHEEL_SENSORS),
        ("track", "name", TRACKS),
        ("cuts", "mix", CAR_MIXES),
        ("cars", "mix", CAR_MIXES),
    ):
        table = tree.get(section)
        if isinstance(table, dict):
            yield table, key, kind, f"{prefix}{section}.{key}"


def tables_in(tree: Tree, key: str) -> Iterator[tuple[str, Tree]]:
    """('key[0]', table) of every table in the list under `key`."""
    items = tree.get(key)
    for place, item in enumerate(items if isinstance(items, list) else []):
        if isinstance(item, dict):
            yield f"{key}[{place}]", item


def type_file(kind: Kind, path: Path, origin: str) -> TypeFile:
    """The file at `path`, read; `InputError` where it cannot be, or has no name for a type."""
    text = read_text(path)
    try:
        return TypeFile(kind, path.name.removesuffix(SUFFIX), text, str(path), origin)
    except TypeFileError as error:
        raise InputError(*(excerpt(sentence, 400) for sentence in error.sentences)) from None


def is_path(reference: object) -> bool:
    """A type is named by path where the reference ends as its files do."""
    return isinstance(reference, str) and reference.endswith(SUFFIX)


def top_level_string(text: str, key: str) -> str | None:
    """The string under a key of a TOML text; None where there is none, or no TOML: told when the type is loaded."""
    try:
        value = parse_toml(text).get(key)
    except PlantError:
        return None
    return value if isinstance(value, str) else None
