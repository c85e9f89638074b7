"""The corpus makes a thing once, never takes what is half made, made of other sources, or changed."""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import pytest

from tests.corpus import Corpus, Recipe

FOLLOWED: list[str] = []
"""The configurations of the recipes that were followed, in their order."""


@dataclass(frozen=True)
class Noted(Recipe):
    """A recipe that leaves its configuration twice."""

    def followed(self, folder: Path) -> list[int]:
        FOLLOWED.append(self.config)
        (folder / "left").write_text(self.config, encoding="utf-8")
        if self.config == "fails":
            raise ValueError(self.config)
        return [0, 3]


@pytest.fixture(autouse=True)
def none_followed() -> Iterator[None]:
    """Each test counts from nothing."""
    FOLLOWED.clear()
    yield
    FOLLOWED.clear()


def test_what_is_made_is_found_by_all_who_ask_at_once(tmp_path: Path) -> None:
    with ThreadPoolExecutor(8) as threads:
        found = list(threads.map(lambda each: each.made(Noted("one", ())), [Corpus(tmp_path) for _ in range(8)]))
    assert FOLLOWED == ["one"]
    assert {each.codes for each in found} == {(0, 3)}
    (folder,) = {each.folder for each in found}
    assert (folder / "left").read_text(encoding="utf-8") == "one"


def test_what_is_half_made_is_not_taken(tmp_path: Path) -> None:
    for _ in range(2):
        with pytest.raises(ValueError, match="fails"):
            Corpus(tmp_path).made(Noted("fails", ()))
    assert FOLLOWED == ["fails", "fails"]


def test_a_changed_thing_is_not_handed_out(tmp_path: Path) -> None:
    made = Corpus(tmp_path).made(Noted("one", ()))
    (made.folder / "left").write_text("other", encoding="utf-8")
    with pytest.raises(AssertionError, match="a test has changed"):
        Corpus(tmp_path).made(Noted("one", ()))


def test_commands_are_given_in_the_folder_of_their_configuration(tmp_path: Path) -> None:
    recipe = Recipe("no configuration", (("tune", "own.toml", "-o", "out"), ("--version",)), "own.toml")
    made = Corpus(tmp_path).made(recipe)
    assert made.codes == (2, 0)
    assert [path.name for path in made.folder.iterdir()] == ["own.toml"]
    assert Path.cwd() != made.folder


def test_a_value_is_worked_out_once_and_not_kept_where_that_fails(tmp_path: Path) -> None:
    made: list[int] = []

    def fails() -> int:
        raise ValueError("half made")

    def seven() -> int:
        made.append(7)
        return 7

    with pytest.raises(ValueError, match="half made"):
        Corpus(tmp_path).value("number", fails)
    with ThreadPoolExecutor(8) as threads:
        asked = [Corpus(tmp_path) for _ in range(8)]
        found = list(threads.map(lambda each: each.value("number", seven), asked))
    assert found == [7] * 8
    assert made == [7]
