"""How much a command tells: -q, -v and --json are the same for all, and declared once."""

from __future__ import annotations

import ast
import json
import re
from pathlib import Path
from typing import Any

import pytest
import typer

from synth.cli.commands import app as program
from synth.frame.command_line import Listed, loaded
from synth.frame.input_error import InputError
from synth.frame.terminal.manner import Loudness, Manner, manner_of

COINS = Listed(
    "throw coins",
    "tests.frame.small_command:COMMAND",
    "tests.frame.small_command:CoinOptions",
    "init --coin",
    "Throw coins.",
)
EVERYWHERE = {"--json", "-q", "--quiet", "-v", "--verbose"}
PRINTS = {
    "synth/cli/init.py": "the text of a file, which is no page",
    "synth/frame/terminal/manner.py": "JSON, and lines of progress",
    "synth/frame/terminal/telling.py": "sentences on stderr",
}
"""Modules that call `print`; all else goes through `print_page`, whose pages are found whole at every width by each
test that prints one in its process (tests/conftest.py)."""


def run(capsys: pytest.CaptureFixture[str], *words: object) -> tuple[str, str]:
    capsys.readouterr()
    assert loaded(COINS).main([str(word) for word in words], standalone_mode=False) == 0
    told = capsys.readouterr()
    return told.out, told.err


def commands_in(command: Any, words: str) -> dict[str, Any]:
    inner = getattr(command, "commands", None)
    if inner is None:
        return {words: command}
    return {deep: leaf for name, each in inner.items() for deep, leaf in commands_in(each, f"{words} {name}").items()}


def flags_of(command: Any) -> set[str]:
    return {flag for parameter in command.params for flag in parameter.opts}


def test_every_command_takes_them() -> None:
    group: Any = typer.main.get_command(program)
    found = commands_in(group, "")
    assert len(found) > 25
    for words in found:
        typed, command = words.split(), group
        while hasattr(command, "commands"):  # as it is called: a listed command has its options then only
            context = command.make_context("retarder-synth", list(typed), resilient_parsing=True)
            _, command, typed = command.resolve_command(context, typed)
        assert flags_of(command) >= EVERYWHERE, words


def test_quiet_leaves_the_verdict(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    usual, progress = run(capsys, "-o", tmp_path / "a")
    assert progress
    quiet, nothing = run(capsys, "-o", tmp_path / "b", "-q")
    assert nothing == ""
    assert set(quiet.splitlines()) < set(usual.splitlines())
    assert all(re.match(r"(accepted|not accepted|not decidable): ", line) for line in quiet.splitlines())
    for_programs, nothing = run(capsys, "-o", tmp_path / "c", "-q", "--json")
    assert nothing == ""
    assert json.loads(for_programs)["command"]


def test_verbose_tells_each_step_with_its_time(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    usual = run(capsys, "-o", tmp_path / "a")
    told, steps = run(capsys, "-o", tmp_path / "b", "-v")
    assert told.replace(str(tmp_path / "b"), str(tmp_path / "a")) == usual[0]
    lines = steps.splitlines()
    assert len(lines) > len(usual[1].splitlines())
    times = [float(line[1:9]) for line in lines if re.match(r"\[ *\d+\.\d\d s\] \S", line)]
    assert len(times) == len(lines)
    assert times == sorted(times)
    assert any("computed" in line for line in lines)


def test_both_at_once_are_refused() -> None:
    with pytest.raises(InputError, match="-q tells less and -v more; give one of the two"):
        manner_of(as_json=False, quiet=True, verbose=True)
    assert manner_of(as_json=True, quiet=False, verbose=True).loudness is Loudness.VERBOSE
    assert Manner().loudness is Loudness.USUAL


def test_nothing_else_prints() -> None:
    root = Path(__file__).parents[2]
    found = set()
    for file in (root / "synth").rglob("*.py"):
        tree = ast.parse(file.read_text(encoding="utf-8"))
        calls = (node.func for node in ast.walk(tree) if isinstance(node, ast.Call))
        if any(isinstance(call, ast.Name) and call.id == "print" for call in calls):
            found.add(file.relative_to(root).as_posix())
    assert found == set(PRINTS)
