"""The commands as Markdown: sections, what each does, its arguments and options, an example, and its page."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

import typer.main

from scripts.studies.study import table
from synth.cli.commands import app
from synth.cli.guide import GUIDES
from synth.frame.command_line import PROGRAM, CommandGuide, Shown


def commands_text(to_docs: str) -> str:
    """All commands. `to_docs`: the way from the page that shows them to the folder of the documentation."""
    return "\n".join(told_group(GUIDES[""], typer.main.get_command(app), to_docs))


def told_group(guide: CommandGuide, group: Any, to_docs: str) -> Iterator[str]:
    """The sections of a group, one paragraph after another; a group within it stands where its name stands."""
    context = group.make_context(PROGRAM, ["--help"], resilient_parsing=True)
    for section, names in guide.sections.items():
        if not guide.words:
            yield f"## {section}\n"
        for name in names:
            command = group.resolve_command(context, [name])[1]
            if name in guide.shown:
                yield from told_command(guide.shown[name], f"{guide.words} {name}".lstrip(), command, to_docs)
            else:
                yield from told_group(GUIDES[name], command, to_docs)


def told_command(shown: Shown, words: str, command: Any, to_docs: str) -> Iterator[str]:
    """One command."""
    yield f"### {words}\n"
    yield from (f"{' '.join(part.split())}\n" for part in re.split(r"\n\s*\n", (command.help or "").partition("\f")[0]))
    yield f"```sh\n{PROGRAM} {shown.example}\n```\n"
    rows = ((f"`{' '.join(names_of(each))}`", " ".join((each.help or "").split())) for each in command.params)
    yield table(words, ("argument or option", "is"), rows).markdown()
    page = shown.page.partition("#")[0]
    yield f"More: [{page.rpartition('/')[2].removesuffix('.md').replace('-', ' ')}]({to_docs}/{shown.page})\n"


def names_of(parameter: Any) -> tuple[str, ...]:
    """As a parameter is typed, with the word for its value."""
    if parameter.param_type_name == "argument":
        return (parameter.metavar or parameter.name.upper(),)
    takes = "" if parameter.is_flag else parameter.metavar or parameter.type.name.upper()
    return tuple(part for part in (", ".join(parameter.opts), takes) if part)
