"""What takes long, made once for all tests of a run, whichever process asks first: directories and values."""

from __future__ import annotations

import fcntl
import hashlib
import json
import os
import pickle
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from pathlib import Path
from shutil import rmtree
from typing import TypeVar

import pytest

from synth.cli import main

PLACE, CODES = "made", "codes.json"

Value = TypeVar("Value")


@dataclass(frozen=True)
class Recipe:
    """A configuration and the commands that are given beside it, in its folder, one after the other.

    The commands name everything from that folder, so that what they leave does not depend on where it lies.
    """

    config: str
    commands: tuple[tuple[str, ...], ...]
    config_name: str = "config.toml"
    environment: tuple[tuple[str, str], ...] = ()

    @property
    def key(self) -> str:
        """Of the recipe; the product does not change in a run of the tests."""
        return hashlib.sha256(json.dumps(asdict(self), sort_keys=True).encode()).hexdigest()

    def followed(self, folder: Path) -> list[int]:
        """The exit codes of the commands, given in this process in `folder`, which exists."""
        (folder / self.config_name).write_text(self.config, encoding="utf-8")
        with pytest.MonkeyPatch.context() as patch:
            patch.chdir(folder)
            for name, value in self.environment:
                patch.setenv(name, value)
            return [main(list(command)) for command in self.commands]


@dataclass(frozen=True)
class Made:
    """The folder in which a recipe was followed, not to be changed, and the exit codes of its commands."""

    folder: Path
    codes: tuple[int, ...]


class Corpus:
    """What was made in a run of the tests, in `base`, which all its processes share."""

    def __init__(self, base: Path) -> None:
        self._base = base
        self._handed_out: dict[str, Made] = {}
        base.mkdir(parents=True, exist_ok=True)

    def made(self, recipe: Recipe) -> Made:
        """What the recipe leaves: made where no process has made it yet, else found, and found unchanged."""
        key = recipe.key
        if key not in self._handed_out:
            place = self._base / key
            with locked(self._base / f"{key}.lock"):
                if not place.exists():
                    self._make(recipe, place)
            kept = json.loads((place / CODES).read_bytes())
            found = contents_sha256(place / PLACE)
            assert found == kept["sha256"], f"a test has changed {place / PLACE}, which it shares with others"
            self._handed_out[key] = Made(place / PLACE, tuple(kept["codes"]))
        return self._handed_out[key]

    def value(self, name: str, make: Callable[[], Value]) -> Value:
        """What `make` gives, worked out by the process that asks first; `name` tells it from all others of a run."""
        place = self._base / f"{name}.pickle"
        with locked(self._base / f"{name}.lock"):
            if not place.exists():
                aside = place.with_suffix(".making")
                aside.write_bytes(pickle.dumps(make()))
                aside.rename(place)
        found: Value = pickle.loads(place.read_bytes())  # written by this run of the tests
        return found

    def _make(self, recipe: Recipe, place: Path) -> None:
        """Make it aside, so that a process that is killed leaves nothing that is taken for made."""
        aside = place.with_suffix(".making")
        rmtree(aside, ignore_errors=True)
        (aside / PLACE).mkdir(parents=True)
        codes = recipe.followed(aside / PLACE)
        kept = {"codes": codes, "sha256": contents_sha256(aside / PLACE)}
        (aside / CODES).write_text(json.dumps(kept), encoding="utf-8")
        aside.rename(place)


@contextmanager
def locked(path: Path) -> Iterator[None]:
    """Alone among the processes that ask for `path`; a process that ends lets go of it, however it ends."""
    with path.open("w") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        yield


def contents_sha256(folder: Path) -> str:
    """Of the names and contents of all files below `folder`, but what Python has compiled."""
    digest = hashlib.sha256()
    for path in sorted(folder.rglob("*")):
        if path.is_file() and "__pycache__" not in path.parts:
            content = path.read_bytes()
            digest.update(f"{path.relative_to(folder).as_posix()} {len(content)}\n".encode())
            digest.update(content)
    return digest.hexdigest()


def shared_base(factory: pytest.TempPathFactory) -> Path:
    """A directory of this run of the tests alone, the same for all of its processes."""
    own = factory.getbasetemp()
    return (own.parent if "PYTEST_XDIST_WORKER" in os.environ else own) / "corpus"
