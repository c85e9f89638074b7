"""What every command line makes of a word: a value, or one sentence that tells what is allowed; and what a shell is
told when a user completes one, for which nothing heavy is imported. Where nothing is told, shells complete files.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from copy import copy
from importlib.util import find_spec
from inspect import Parameter, Signature, signature
from pathlib import Path
from typing import Annotated, Any, get_args

import typer

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


MANNER = "manner"
"""Parameter of a command that becomes the options below."""

MANNER_OPTIONS = {
    "as_json": Annotated[bool, typer.Option("--json", help="Machine-readable results on stdout.")],
    "quiet": Annotated[bool, typer.Option("-q", "--quiet", help="Tell nothing but errors and the verdict.")],
    "verbose": Annotated[bool, typer.Option("-v", "--verbose", help="Tell each step with its time.")],
}
"""What every command takes; progress, warnings and steps go to stderr."""


def in_its_manner(command: Callable[..., int]) -> Callable[..., int]:
    """`command` as Typer reads it: its parameter `manner` is made of the options that every command has."""

    def run(as_json: bool, quiet: bool, verbose: bool, **others: Any) -> int:
        from synth.frame.terminal.manner import manner_of

        return command(**{MANNER: manner_of(as_json, quiet, verbose)}, **others)

    own = [each for name, each in signature(command).parameters.items() if name != MANNER]
    common = [
        Parameter(name, Parameter.KEYWORD_ONLY, default=False, annotation=annotation)
        for name, annotation in MANNER_OPTIONS.items()
    ]
    return with_parameters(run, [*own, *common], command)


def completed(parameter: Parameter) -> Parameter:
    """`parameter` with what completes its words, where its declaration does not say so itself."""

    parts = get_args(parameter.annotation)
    if len(parts) != 2 or getattr(parts[1], "autocompletion", None) or not getattr(parts[1], "metavar", None):
        return parameter
    declared = copy(parts[1])
    declared.autocompletion = completing(declared.metavar, Path in {parts[0], *get_args(parts[0])})
    return parameter.replace(annotation=Annotated[parts[0], declared])


def with_parameters(
    run: Callable[..., int], parameters: list[Parameter], named: Callable[..., int]
) -> Callable[..., int]:
    """`run` with the signature that Typer reads, all keywords, and with the name and the words of `named`."""
    keywords = [completed(each).replace(kind=Parameter.KEYWORD_ONLY) for each in parameters]
    # mypy knows no such attribute, though every callable may have it
    run.__signature__ = Signature(keywords)  # type: ignore[attr-defined]
    run.__annotations__ = {each.name: each.annotation for each in keywords}
    run.__name__, run.__doc__ = named.__name__, named.__doc__
    return run


def directory(word: str) -> Path:
    """The directory called `word`; no word at all, as from an unset variable of a shell, is none."""
    if not str(word):
        raise typer.BadParameter("it is empty; give a directory, '.' for the current one")
    return Path(word)


def whole_number(low: int, high: int) -> Callable[[str], int]:
    """The function that reads a whole number from `low` to `high`."""

    def number(word: str) -> int:
        try:
            value = int(word)
        except ValueError:
            value = low - 1
        if not low <= value <= high:
            raise typer.BadParameter(f"it is {str(word)[:40]!r}; give a whole number from {low} to {high}")
        return value

    return number
