"""A command that does not come to its end: what it leaves, what it says, and what a next run may read."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import NoReturn

import pytest

from synth.frame.asked_file import asked_of
from synth.frame.command import Command, Unfinished, Work
from synth.frame.exhibits import Chapter, File
from synth.frame.input_error import InputError
from synth.frame.interval import Interval
from synth.frame.page.told_page import shown
from synth.frame.perform import perform
from synth.frame.results_directory import results_directory
from synth.frame.terminal.manner import Manner
from tests.frame.results import results_in
from tests.frame.small_command import COMMAND, CoinFile, CoinOptions, Game

Coins = Command[CoinFile, CoinOptions, Game, dict[str, Interval]]


def done(command: Coins, out: Path, config: Path | None = None) -> int:
    """Exit code of a run."""
    return perform(command, asked_of(command, CoinOptions(config=config), "init --coin"), out, Manner())


def lose_a_coin(game: Game, work: Work) -> NoReturn:
    """Stores half of the work."""
    work.directory.store("throws/1.txt", b"heads")
    raise Unfinished("throw 2: the coin is gone")


def test_what_cannot_be_done_is_one_sentence_and_what_was_done_stays(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    lost = replace(COMMAND, compute=lose_a_coin)
    for _ in range(2):
        assert done(lost, tmp_path) == 1
        said = capsys.readouterr()
        (sentence,) = said.err.splitlines()[-1:]
        assert sentence.startswith("retarder-synth: throw 2: the coin is gone; what was done before is kept in ")
        assert said.out == ""
        assert results_in(tmp_path) == {"throws/1.txt": b"heads"}


def test_it_is_known_whether_a_next_run_goes_on(tmp_path: Path) -> None:
    with results_directory(tmp_path, "throw coins") as directory:
        directory.write("coins.txt", b"heads")
        told = [directory.goes_on]
        directory.store("throws/1.txt", b"heads")
        told.append(directory.goes_on)
    with results_directory(tmp_path, "throw coins") as directory:
        told.append(directory.goes_on)
    assert told == [False, True, True]


def test_a_chapter_is_written_before_the_next_one_is_made(tmp_path: Path) -> None:
    def broken(found: dict[str, Interval]) -> Iterator[Chapter]:
        yield next(iter(COMMAND.show(found)))
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        done(replace(COMMAND, show=broken), tmp_path)
    assert list(results_in(tmp_path)) == ["sheets/shares.csv"]


def test_copies_of_what_is_read_may_be_read_by_a_next_run(tmp_path: Path) -> None:
    def copying(game: Game, work: Work) -> dict[str, Interval]:
        work.directory.write("inputs/coin.toml", b"[coin]\nthrows = 150\n")
        return COMMAND.compute(game, work)

    config = tmp_path / "inputs" / "coin.toml"
    own, other = (replace(COMMAND, compute=copying, inputs=folder) for folder in ("inputs", ""))
    assert done(own, tmp_path) == 0
    assert done(own, tmp_path, config) == 0
    assert config.is_file()
    with pytest.raises(InputError, match="this run reads it and would write or remove it"):
        done(other, tmp_path, config)


def test_a_command_may_read_its_configuration_in_a_way_of_its_own(tmp_path: Path) -> None:
    named = replace(COMMAND, text=lambda path, init: f'title = "{path.name} or {init}"\n')
    assert asked_of(named, CoinOptions(config=Path("gold")), "init --coin").settings.title == "gold or init --coin"


def test_a_page_links_to_a_file_that_has_a_title() -> None:
    assert shown(File("hump.html", b"", "Play <it>"), {}) == '<p><a href="hump.html">Play &lt;it&gt;</a></p>'
    assert shown(File("trains.npz", b""), {}) == ""
