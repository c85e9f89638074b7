"""What every command line makes of a word: a value, or one sentence that tells what is allowed."""

from __future__ import annotations

from collections.abc import Callable
from copy import copy
from inspect import Parameter, Signature, signature
from pathlib import Path
from typing import Annotated, Any, get_args

import typer

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
    from synth.frame.completion import completing

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
