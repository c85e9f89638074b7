"""The guide to the command line: it leaves no command out, its examples can be typed, and its help is not cut off."""

from __future__ import annotations

import re
import shlex
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import typer.main

from synth.cli.commands import app
from synth.cli.guide import GUIDES
from synth.frame.command_guide import PAGES, CommandGuide

ROOT = Path(__file__).parents[2]


def group_of(guide: CommandGuide) -> Any:
    """The commands of a guide."""
    top: Any = typer.main.get_command(app)
    return top.commands[guide.words] if guide.words else top


@pytest.mark.parametrize("guide", GUIDES.values(), ids=lambda guide: guide.words or "top")
def test_every_command_has_its_section_and_its_example(guide: CommandGuide) -> None:
    listed = [name for names in guide.sections.values() for name in names]
    assert sorted(listed) == sorted(group_of(guide).commands)
    assert set(listed) - set(guide.shown) == (set(GUIDES) - {""} if guide.words == "" else set())
    for name, shown in guide.shown.items():
        assert shown.example.startswith(f"{guide.words} {name}".lstrip())
        assert (ROOT / PAGES / shown.page).is_file()


@pytest.mark.parametrize("example", [shown.example for guide in GUIDES.values() for shown in guide.shown.values()])
def test_an_example_can_be_typed(example: str) -> None:
    """Every word of it is a command, an option, or a value that an option takes; nothing is run."""
    command: Any = typer.main.get_command(app)
    words = shlex.split(example.partition(">")[0])
    while hasattr(command, "commands"):
        context = command.make_context("retarder-synth", words, resilient_parsing=True)
        _, command, words = command.resolve_command(context, words)
    context = command.make_context(example, words)
    assert not context.args


TOLD = re.compile(r"retarder-synth ((?:hump |sweep )?[a-z]+)(?= [A-Z-]|['`])")
"""A command that a sentence has somebody type: an argument, an option or a quotation mark is behind it."""


def test_every_command_that_sentences_tell_is_there() -> None:
    files = [*(ROOT / "synth").rglob("*.py"), *(ROOT / "docs").rglob("*.md"), ROOT / "README.md"]
    told = {words for file in files for words in TOLD.findall(file.read_text(encoding="utf-8"))}
    there = {" ".join(words) for words in leaves(typer.main.get_command(app))}
    assert told <= there | {"study", "hump", "sweep"}
    assert len(told) > 20


@pytest.mark.parametrize("width", [60, 80, 100, 140])
def test_help_is_not_cut_off(width: int) -> None:
    for guide in GUIDES.values():
        group = group_of(guide)
        context = group.make_context("retarder-synth", ["--help"], resilient_parsing=True, terminal_width=width)
        told = group.get_help(context)
        assert "..." not in told.replace("[ARGS]...", "")
        assert max(map(len, told.splitlines())) <= width


def leaves(command: Any, words: tuple[str, ...] = ()) -> Iterator[tuple[str, ...]]:
    """Every command that can be typed, by its words."""
    inner = getattr(command, "commands", None)
    if inner is None:
        yield words
    for name, below in (inner or {}).items():
        yield from leaves(below, (*words, name))


@pytest.mark.parametrize("width", [60, 80, 100, 140])
def test_help_of_no_command_is_cut_off(width: int) -> None:
    top: Any = typer.main.get_command(app)
    for words in leaves(top):
        command, typed = top, list(words)
        while hasattr(command, "commands"):
            context = command.make_context("retarder-synth", list(typed), resilient_parsing=True)
            _, command, typed = command.resolve_command(context, typed)
        name = " ".join(("retarder-synth", *words))
        told = command.make_context(name, [], resilient_parsing=True, terminal_width=width).get_help()
        assert "..." not in re.sub(r"(?<=[]},R])\.\.\.", "", told), words  # several words may follow
        assert "…" not in told, words
        assert max(map(len, told.splitlines())) <= width, (words, max(told.splitlines(), key=len))
