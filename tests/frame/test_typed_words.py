"""What is typed behind a command: files by their place, options once or more often, what must be there."""

from __future__ import annotations

from pathlib import Path

import pytest
import typer

from synth.frame.command_line import Listed, loaded
from synth.frame.input_error import InputError
from synth.frame.settings.options import (
    BY_PLACE,
    NEEDED,
    Options,
    number_option,
    read_options,
    word_option,
    words_option,
)


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
