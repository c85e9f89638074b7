"""A tune of two cut classes on a coarse grid, done once, and the command line as a function."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import pytest

from synth.cli import main
from synth.cli.qualification.tuned import ESTIMATED, problem
from tests.corpus import Corpus, Recipe

CLASS = f"[output]\ncsv = true\n{problem(ESTIMATED)}"
"""A park retarder, one light class and one target: solved in two seconds."""


def changed(text: str, *swaps: tuple[str, str]) -> str:
    """`text` with each (old, new) swapped; it must hold every `old`, or a case would lose its fault unseen."""
    for old, new in swaps:
        assert old in text, f"{old!r} is not in the configuration any more"
        text = text.replace(old, new)
    return text


MEASURED = "[regulator]\nestimator = false\n"
"""Tables for the measured speed."""

SECOND_CLASS = '[[cut]]\ncar = "gondola-4"\nmass_t = 30\nallowed_stage = 2\n'
EPOCH = "1700000000"


@dataclass(frozen=True)
class Ran:
    """What a command came to."""

    code: int
    out: str
    err: str

    @property
    def sentence(self) -> str:
        """The only line on stderr."""
        assert self.err.startswith("retarder-synth: ")
        assert self.err.count("\n") == 1
        assert self.err.endswith("\n")
        return self.err.removeprefix("retarder-synth: ").rstrip()


Command = Callable[..., Ran]


@pytest.fixture
def command(capfd: pytest.CaptureFixture[str]) -> Command:
    """Run the command line in this process."""

    def run(*arguments: object) -> Ran:
        capfd.readouterr()
        code = main([str(argument) for argument in arguments])
        return Ran(code, *capfd.readouterr())

    return run


@pytest.fixture(scope="session")
def one_class(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Configuration of one class."""
    path = tmp_path_factory.mktemp("config") / "one.toml"
    path.write_text(CLASS)
    return path


@pytest.fixture(scope="session")
def two_classes(one_class: Path) -> Path:
    """Configuration of two classes."""
    path = one_class.with_name("two.toml")
    path.write_text(CLASS + SECOND_CLASS)
    return path


@pytest.fixture(scope="session")
def measured_classes(one_class: Path) -> Path:
    """Configuration of the same two classes, for the measured speed."""
    path = one_class.with_name("measured.toml")
    path.write_text(CLASS + MEASURED + SECOND_CLASS)
    return path


def tuned_from(config: Path, corpus: Corpus) -> tuple[Path, int]:
    """(directory, exit code) of a tune by two workers."""
    command = ("tune", config.name, "-o", "out", "--workers", "2")
    recipe = Recipe(config.read_text(encoding="utf-8"), (command,), config.name, (("SOURCE_DATE_EPOCH", EPOCH),))
    made = corpus.made(recipe)
    return made.folder / "out", made.codes[0]


@pytest.fixture(scope="session")
def tuned_once(two_classes: Path, corpus: Corpus) -> tuple[Path, int]:
    """(directory, exit code) of a tune of two classes by two workers; not to be changed."""
    return tuned_from(two_classes, corpus)


@pytest.fixture(scope="session")
def measured_once(measured_classes: Path, corpus: Corpus) -> Path:
    """Directory of a tune of the same classes for the measured speed; not to be changed."""
    directory, code = tuned_from(measured_classes, corpus)
    assert code == 0
    return directory


@pytest.fixture
def tuned(tuned_once: tuple[Path, int], tmp_path: Path) -> Path:
    """A copy of the tuned directory, to be changed at will."""
    return Path(shutil.copytree(tuned_once[0], tmp_path / "tuned"))
