"""A command keeps the user's configuration as it was, among its results, and takes nobody's place with it."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest

from synth.frame.asked_file import asked_of
from synth.frame.command import Command
from synth.frame.input_error import InputError
from synth.frame.perform import perform
from synth.frame.results_directory import CONFIGURATION
from synth.frame.settings.toml_file import read_text
from synth.frame.terminal.manner import Manner
from tests.frame.small_command import COMMAND, CoinOptions

TEXT = b"# \xd1\x82\xd0\xb0\xd0\xba\r\n[coin]\r\nthrows =   150\n\n[output]\nplots = false\nreport = false\n"


def done(config: Path | None, output: Path, command: Command = COMMAND) -> list[str]:  # type: ignore[type-arg]
    """The files that the summary lists after a run."""
    perform(command, asked_of(command, CoinOptions(config=config), "init --coin"), output, Manner())
    return sorted(json.loads((output / "summary.json").read_bytes())["files"])


@pytest.fixture
def config(tmp_path: Path) -> Path:
    """A file of the user."""
    (tmp_path / "coin.toml").write_bytes(TEXT)
    return tmp_path / "coin.toml"


def test_it_is_kept_byte_for_byte_until_a_run_has_none(config: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    assert CONFIGURATION in done(config, out)
    assert (out / CONFIGURATION).read_bytes() == TEXT
    assert CONFIGURATION not in done(None, out)
    assert not (out / CONFIGURATION).exists()


def test_a_run_may_begin_from_the_copy(config: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    files = done(config, out)
    written = (out / CONFIGURATION).stat().st_mtime_ns
    assert done(out / CONFIGURATION, out) == files
    assert (out / CONFIGURATION).stat().st_mtime_ns == written


def test_a_file_of_the_user_in_its_place_stays(config: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    done(None, out)
    own = out / CONFIGURATION
    own.write_bytes(TEXT + b"# mine\n")
    assert CONFIGURATION not in done(own, out)
    with pytest.raises(InputError, match=f"{CONFIGURATION}: retarder-synth did not write it"):
        done(config, out)
    assert own.read_bytes() == TEXT + b"# mine\n"


def test_what_is_read_in_a_way_of_its_own_is_not_kept(config: Path, tmp_path: Path) -> None:
    command = replace(COMMAND, text=lambda path, init: read_text(path, init))
    assert CONFIGURATION not in done(config, tmp_path / "out", command)
