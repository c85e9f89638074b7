"""Hump files with anything in them: read, or refused in one sentence; never another exception."""

from __future__ import annotations

import random
import tomllib
from collections.abc import Iterator
from typing import Any

from plant_models.library.toml_lines import places_of
from tests.effort import sized
from tests.plant_models.hump.random_humps import SMALL
from tests.plant_models.hump.test_hump_file import LINES

PIECES = (
    *("[", "]", "{", "}", "=", ",", ".", "#", '"', "'", '"""', "\n", "\\", "\x00", "é", "-", "1e999", "nan", "9" * 30),
    *(
        "true",
        "[hump]\n",
        "[[hump.switch]]\n",
        "[type.turnout]\n",
        "type = 'track'",
        "next = {}",
        "number = 601",
        "to = 1",
    ),
)


def changed(text: str, rng: random.Random) -> str:
    """`text` with one to four characters, lines or pieces taken away, added or exchanged."""
    for _ in range(rng.randint(1, 4)):
        at, to = sorted((rng.randrange(len(text) + 1), rng.randrange(len(text) + 1)))
        match rng.randrange(5):
            case 0:
                text = text[:at] + text[at + rng.randint(1, 3) :]
            case 1:
                text = text[:at] + rng.choice(PIECES) + text[at:]
            case 2:
                text = text[:at] + rng.choice(PIECES) + text[at + 1 :]
            case 3 if to - at < 80:
                text = text[:at] + text[to:]
            case _:
                digits = [place for place, sign in enumerate(text) if sign.isdigit()]
                if digits:
                    place = rng.choice(digits)
                    text = text[:place] + str(rng.randrange(1000)) + text[place + 1 :]
    return text


def places_in(tree: Any) -> Iterator[tuple[str | int, ...]]:
    """Every place of a tree that tomllib made."""
    items = tree.items() if isinstance(tree, dict) else enumerate(tree) if isinstance(tree, list) else ()
    for key, value in items:
        yield (key,)
        yield from ((key, *below) for below in places_in(value))


def test_lines_are_found_of_all_that_tomllib_finds() -> None:
    rng, valid = random.Random(8), 0
    while valid < sized(250, 1000):
        text = changed(LINES if valid % 2 else SMALL, rng)
        try:
            tree = tomllib.loads(text)
        except (tomllib.TOMLDecodeError, RecursionError, ValueError):
            continue
        valid += 1
        found = places_of(text)
        assert set(found) == set(places_in(tree))
        for place, line in found.items():
            named = place[-1] if isinstance(place[-1], str) else None
            if named is not None and named.isidentifier():
                assert named in text.splitlines()[line - 1]
