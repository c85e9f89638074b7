"""A small command of the frame, which throws coins, and what lies in a directory of results."""

from __future__ import annotations

import random
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import pytest
from matplotlib.figure import Figure
from pydantic import Field
from scipy.stats import binomtest

from plant_models.errors import PlantError
from synth.frame.command import Asked, Command, Head, Limit, Steps, Work
from synth.frame.exhibits import Chapter, Chart, Column, File, Sentence, Table
from synth.frame.faults import InputError
from synth.frame.interval import Interval
from synth.frame.own_files import MARKER
from synth.frame.printed_numbers import decimals
from synth.frame.results_directory import results_directory
from synth.frame.settings.numbers import numbers_of
from synth.frame.settings.options import Options, configured
from synth.frame.settings.section import OutputSettings, Section, choice, optional, setting
from synth.frame.settings.settings_file import parse_settings
from tuning_tables.json_text import canonical_json


class CoinSettings(Section):
    """The coin."""

    heads: float = setting(0.5, "1", 0.0, 1.0, "probability of heads", "everybody")
    throws: int = setting(200, "1", 10, 10_000, "throws of each player")
    side: str = choice("heads", "what wins")


class CoinFile(Section):
    """A file about coins."""

    title: str | None = choice(None, "of the page", "Coins")
    players: tuple[str, ...] = Field(("Anna", "Bohdan"), strict=False, description="who throws")
    coin: CoinSettings = CoinSettings()
    least_share: float | None = optional("1", 0.0, 1.0, "every player must win so often", 0.4)
    output: OutputSettings = OutputSettings()


class CoinOptions(Options):
    """Options of the command line."""

    throws: int | None = configured("--throws", "N", CoinSettings, "throws", "Throws of each player")


@dataclass(frozen=True)
class Game:
    """What is asked."""

    settings: CoinFile
    throws: int
    head: Head


def read(text: str, place: str) -> CoinFile:
    """The file."""
    return parse_settings(CoinFile, text, place)


def resolve(asked: Asked[CoinFile, CoinOptions]) -> Game:
    """A coin that has sides."""
    settings, throws = asked.settings, asked.options.throws or asked.settings.coin.throws
    if settings.coin.side not in ("heads", "tails"):
        raise PlantError(f"{asked.place}: coin.side is {settings.coin.side!r}; a coin has heads and tails")
    head = Head(
        title=settings.title or "Coins",
        canonical_json=canonical_json({"coin": settings.coin.model_dump(), "throws": throws}).decode(),
        parameters=tuple(numbers_of(settings)),
        output=settings.output,
        warnings=("few throws",) if throws < 100 else (),
    )
    return Game(settings, throws, head)


def compute(game: Game, work: Work) -> dict[str, Interval]:
    """Shares by player."""
    found = {}
    for number, player in enumerate(game.settings.players):
        dice = random.Random(number)
        wins = sum(dice.random() < game.settings.coin.heads for _ in range(game.throws))
        told = binomtest(wins, game.throws).proportion_ci()
        found[player] = Interval(wins / game.throws, told.low, told.high, game.throws)
        work.progress.done(player)
    return found


def limits(found: dict[str, Interval]) -> Iterator[Limit]:
    """Nobody wins more than three times out of four."""
    most = max(found.values(), key=lambda each: each.value)
    kept = True if most.high95 <= 0.75 else False if most.low95 > 0.75 else None
    yield Limit(f"the luckiest wins {most.value:.2f}, at most 0.75 asked", kept)


def show(found: dict[str, Interval]) -> Iterator[Chapter]:
    """Shares."""
    columns = (
        Column("player", "player", words=True),
        Column("share", "share won", form=decimals(2)),
        Column("throws", "throws", spare=1),
        Column("told_by", "told by", detail=True, words=True),
    )
    rows = [
        {"player": player, "share": share, "throws": share.n, "told_by": "=dice"} for player, share in found.items()
    ]
    last = {"player": "nobody"}
    yield Chapter(
        "Who wins",
        (
            Sentence("Players throw one after another.", {"players": len(found)}, brief=True),
            Table("shares", "Shares won", columns, [*rows, last], brief=True, bad=lambda row: "share" not in row),
        ),
    )
    yield Chapter("Pictures & more", (Chart("coins", "Coins", "Shares.", drawn), File("coins.txt", b"heads\n")))


def drawn() -> Figure:
    """A picture."""
    return Figure()


COMMAND = Command(
    name="throw coins",
    read=read,
    options=CoinOptions,
    resolve=resolve,
    head=lambda game: game.head,
    steps=lambda game: Steps(len(game.settings.players), "throwing", "players"),
    compute=compute,
    show=show,
    limits=limits,
    limits_of_use=("Coins are not dice.",),
)


SUMMARY = b"{}"


def results_in(directory: Path) -> dict[str, bytes]:
    """The content of every file below `directory` by name, without the marker that lists them."""
    files = {path.relative_to(directory).as_posix(): path for path in directory.rglob("*") if path.is_file()}
    return {name: path.read_bytes() for name, path in files.items() if path.name != MARKER}


def run(
    path: Path, contents: dict[str, bytes], command: str = "tune", reads: tuple[Path, ...] = (), inputs: str = ""
) -> None:
    """A whole run that writes `contents`."""
    with results_directory(path, command, reads, inputs) as results:
        results.write_all(contents)
        results.finish(SUMMARY)


def files(path: Path) -> dict[str, bytes]:
    """All files but the marker."""
    found = {file.relative_to(path).as_posix(): file for file in path.rglob("*") if file.is_file()}
    return {name: file.read_bytes() for name, file in found.items() if name != MARKER}


@contextmanager
def refused(*words: str) -> Iterator[None]:
    """Within, a refusal in one sentence that holds all of `words`."""
    with pytest.raises(InputError) as caught:
        yield
    assert len(caught.value.sentences) == 1
    for word in words:
        assert word in str(caught.value)
