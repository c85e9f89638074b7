"""What a shell is told when a user completes a word of the command line; nothing heavy is imported for it.

Where nothing is told, shells complete files by themselves.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from importlib.util import find_spec
from pathlib import Path

HUMP = "HUMP"
"""Part of a metavar: a hump of the library may stand here by its name."""


def completing(metavar: str, is_path: bool) -> Callable[[str], list[str]] | None:
    """What completes the word that `metavar` stands for: words in small letters are its choices; a path may be a name
    of the library. None where the shell has to know nothing."""
    words = metavar.split("|")
    if HUMP in words:
        return lambda incomplete: [*beginning(library_names("humps"), incomplete), *files_beginning(incomplete)]
    if is_path:
        return lambda incomplete: []
    if len(words) > 1 and metavar.islower():
        return lambda incomplete: beginning(words, incomplete)
    return None


def beginning(words: list[str], incomplete: str) -> list[str]:
    """Those of `words` that begin so."""
    return [word for word in words if word.startswith(incomplete)]


def files_beginning(incomplete: str) -> Iterator[str]:
    """The files and folders, these with a slash, whose paths begin so; hidden ones only where a dot is typed."""
    folder, _, name = incomplete.rpartition("/")
    place = Path(f"{folder}/" if incomplete.startswith("/") else folder or ".")
    try:
        found = sorted(place.iterdir())
    except OSError:
        return
    for each in found:
        if each.name.startswith(name) and (name or not each.name.startswith(".")):
            yield incomplete.removesuffix(name) + each.name + "/" * each.is_dir()


def library_names(folder: str) -> list[str]:
    """The names of the library in `folder`, found without its package, which has numpy."""
    package = find_spec("plant_models")
    places = list(package.submodule_search_locations or ()) if package else []
    return sorted(file.stem for place in places for file in Path(place, "library", folder).glob("*.toml"))
