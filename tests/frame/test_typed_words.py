"""What is typed and written: words, options, -q, -v, --json, and texts that are no TOML."""

from __future__ import annotations

import ast
import json
import re
import tomllib
from pathlib import Path
from typing import Any

import pytest
import typer

from synth.cli.commands import app as program
from synth.cli.listed import COMMANDS, HUMP, SWEEP
from synth.frame.command_line import Listed, loaded
from synth.frame.faults import InputError
from synth.frame.settings.options import (
    BY_PLACE,
    NEEDED,
    Options,
    number_option,
    read_options,
    word_option,
    words_option,
)
from synth.frame.settings.toml_file import read_text, read_toml, toml_tree
from synth.frame.settings.toml_syntax import MOST_FAULTS
from synth.frame.terminal.manner import Loudness, Manner, manner_of


class TapeOptions(Options):
    """Of a command that begins with other files than a configuration."""

    tapes: tuple[Path, ...] = words_option(BY_PLACE, "TAPES", NEEDED, "What was recorded.")
    config: Path | None = word_option("--config", "C", None, "The recorder.")
    head: Path = word_option("--head", "FILE", NEEDED, "The head.")
    hushed: tuple[Path, ...] = words_option("--hushed", "TAPE", (), "Recorded in silence.")
    speed: float = number_option("--speed", "CM_S", 4.75, 1.0, 100.0, "Of the tape.")


TAPES = Listed(
    "play tapes", "tests.frame.small_command:COMMAND", "tests.frame.test_typed_words:TapeOptions", "init", "Play tapes."
)


def test_words_become_the_values_that_are_declared() -> None:
    typed = read_options(
        TapeOptions, {"tapes": [Path("a"), Path("b")], "head": "h", "config": None, "hushed": [], "speed": "9.5"}
    )
    assert typed == TapeOptions(tapes=(Path("a"), Path("b")), head=Path("h"), speed=9.5)
    assert typed.reads == (Path("a"), Path("b"), Path("h"))
    several = read_options(TapeOptions, {"tapes": ["a"], "head": "h", "hushed": ["x", "y"], "config": "c.toml"})
    assert set(several.reads) == {Path("a"), Path("h"), Path("x"), Path("y"), Path("c.toml")}


def test_a_configuration_is_typed_by_its_place_unless_other_files_come_first(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert read_options(Options, {"config": Path("c.toml")}).reads == (Path("c.toml"),)
    assert read_options(Options, {}).reads == ()
    loaded(TAPES).main(["--help"], standalone_mode=False)
    usage = " ".join(capsys.readouterr().out.split())
    assert "TAPES" in usage.partition("Options:")[0]
    assert "--config C The recorder." in usage
    assert "--speed CM_S Of the tape. [default: 4.75]" in usage
    assert "Recorded in silence. " in usage
    assert "CONFIG.toml" not in usage


@pytest.mark.parametrize(("words", "told"), [(["--head", "h"], "TAPES"), (["a"], "--head")])
def test_what_must_be_typed_is_asked_for(words: list[str], told: str) -> None:
    with pytest.raises(typer.TyperException) as caught:
        loaded(TAPES).main(words, standalone_mode=False)
    assert caught.value.format_message().startswith("Missing")
    assert told in caught.value.format_message()


def test_an_option_at_fault_is_called_by_its_flag() -> None:
    with pytest.raises(InputError, match=r"^--speed is '0'; it must be a number from 1 to 100$"):
        read_options(TapeOptions, {"tapes": ["a"], "head": "h", "speed": "0"})


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


@pytest.mark.parametrize("listed", [*COMMANDS, *HUMP, *SWEEP], ids=lambda listed: listed.words)
def test_an_entry_names_its_command_and_the_options_of_it(listed: Listed) -> None:
    command = listed.load()
    assert command.name == listed.words
    assert command.options is listed.options()


MISTAKES = [
    ("a = 0,6", "a = 0.6", "0,6 is no number of TOML; write 0.6, with a decimal point"),
    ("a = { b = 0,6, c = 2 }", "a = { b = 0.6, c = 2 }", "0,6 is no number"),
    ("a = { b = -1,25 }", "a = { b = -1.25 }", "-1,25 is no number of TOML; write -1.25"),
    ("a = { b = 1 c = 2 }", "a = { b = 1, c = 2 }", "a comma is missing before 'c = 2 }'"),
    ("a = [[0, 1] [2, 3]]", "a = [[0, 1], [2, 3]]", "a comma is missing before '[2, 3]]'"),
    ("a = [[0, 1], [2, 3]\nb = 3", "a = [[0, 1], [2, 3]]\nb = 3", "the list before 'b = 3' is not closed; add ]"),
    ("a = { b = 1,\nc = 2 }", "a = { b = 1, c = 2 }", "a table in { } must end on its line"),
    ("a = { b = 1, }", "a = { b = 1 }", "take the comma before } out"),
    ("a = knp-5-bunch", 'a = "knp-5-bunch"', 'words need quotes: write "knp-5-bunch"'),
    ("a = “knp-5”", 'a = "knp-5"', 'write "knp-5", with straight quotes'),
    ("a = True", "a = true", "True must be written true"),
    ("a = .5", "a = 0.5", ".5 must be written 0.5"),
    ("a = 5.", "a = 5.0", "nothing stands behind the decimal point; write .0"),
    ("a = −5", "a = -5", "the sign before this number is a dash; write -"),
    ("a = 5 m", "a = 5", "m stands behind a number; the key tells the unit"),
    ("a = 4‰", "a = 4", "‰ stands behind a number"),
    ("a == 3", "a = 3", "write one = behind a key"),
    ("a : 3", "a = 3", "write = behind a key, not a colon"),
]
"""A mistake, what is meant, and what is told."""

UNKNOWN = [
    ("a = 1\na = 2", "line 2: this key is there before; keep one of the two"),
    ("[a]\n[b]\n[a]", "line 3: this table is there before; put the two together"),
    ('a = "b\n', "line 1: a quote is missing at the end of this line"),
    ("a =\n", "this is not valid TOML: Invalid value (at line 1"),
    ("a = [1,2", "this is not valid TOML: Unclosed array"),
]
"""What nobody can mend."""


@pytest.mark.parametrize(("wrong", "meant", "words"), MISTAKES)
def test_a_mistake_is_told_with_its_remedy(wrong: str, meant: str, words: str) -> None:
    read = read_toml(f"first = 1\n{wrong}\nlast = 2\n", "my.toml")
    (sentence,) = read.faults
    line = 3 if "not closed" in words else 2
    assert sentence.startswith(f"my.toml, line {line}: {words}")
    assert read.tree == tomllib.loads(read.text) == tomllib.loads(f"first = 1\n{meant}\nlast = 2\n")
    with pytest.raises(InputError):
        toml_tree(f"{wrong}\n", "my.toml")


@pytest.mark.parametrize(("wrong", "words"), UNKNOWN)
def test_what_was_meant_is_not_guessed(wrong: str, words: str) -> None:
    read = read_toml(wrong, "my.toml")
    assert (read.tree, len(read.faults)) == (None, 1)
    assert words in read.faults[0]


def test_all_mistakes_of_a_text_are_told_at_once() -> None:
    wrong = [text.replace("a", f"a{number}", 1) for number, (text, _, _) in enumerate(MISTAKES)]
    read = read_toml("\n".join(wrong), "my.toml")
    assert len(read.faults) == len(MISTAKES)
    assert len(read_toml("a = 0,6\n" * 200, "my.toml").faults) <= MOST_FAULTS


def test_a_mark_of_an_editor_at_the_beginning_is_read_over(tmp_path: Path) -> None:
    file = tmp_path / "my.toml"
    file.write_bytes(b"\xef\xbb\xbfa = 1\n")
    assert toml_tree(read_text(file), "my.toml") == {"a": 1}
