"""A command as a value: from declared settings to what is shown; `perform` runs it.

A new command is one `Command`: its settings (file and command line), what it asks (`resolve`), what it finds
(`compute`), by which limits that is judged, and what is shown of it. The directory, the lock, progress, Ctrl-C, pages,
tables, pictures, hashes and exit codes are the frame's.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Generic, TypeVar

from plant_models.library import SourcedValue
from synth.frame.exhibits import Chapter, Chart
from synth.frame.settings.options import Options
from synth.frame.settings.section import OutputSettings
from synth.frame.settings.toml_file import read_text

if TYPE_CHECKING:
    from synth.frame.results_directory import ResultsDirectory
    from synth.frame.terminal.progress import Progress


S = TypeVar("S")
O = TypeVar("O", bound=Options)  # noqa: E741  # the options of a command
P = TypeVar("P")
R = TypeVar("R")


@dataclass(frozen=True)
class Asked(Generic[S, O]):
    """What a user asks for: the settings of the configuration, and the options of the command line.

    `place`: what messages call the configuration. Paths in it begin at `folder`. `text`: all of its file as the user
    wrote it; "" without one.
    """

    settings: S
    options: O
    place: str
    folder: Path
    text: str


@dataclass(frozen=True)
class Head:
    """What every page and summary says of a problem.

    `canonical_json`: all that figures depend on, the same text for the same figures. `parameters`: every number with
    unit, range and origin. `output`: what is written. `reads`: the files that are read besides those that are typed.
    """

    title: str
    canonical_json: str
    parameters: tuple[SourcedValue, ...]
    output: OutputSettings
    warnings: tuple[str, ...] = ()
    reads: tuple[Path, ...] = ()

    @property
    def sha256(self) -> str:
        """SHA-256 of `canonical_json` in UTF-8, hexadecimal."""
        return hashlib.sha256(self.canonical_json.encode()).hexdigest()


@dataclass(frozen=True)
class Limit:
    """A sentence that tells figure and limit; `kept` None where the figures do not decide it."""

    sentence: str
    kept: bool | None


@dataclass(frozen=True)
class Steps:
    """What progress counts: `word` is what is done, `noun` what the steps are called."""

    count: int
    word: str
    noun: str


@dataclass(frozen=True)
class Work:
    """What a command is given while it computes.

    `progress` is told each finished step; in `directory` it stores what its next run may go on from; `begin` starts to
    draw a chart that `show` will hold, where there are processes for it.
    """

    progress: Progress
    directory: ResultsDirectory
    begin: Callable[[Chart], None]


class Unfinished(Exception):
    """`compute` could not do a part of its work, though nothing is wrong with what was asked; says which and why.

    What was stored before stays, and the next run goes on from it.
    """


def no_limits(result: object) -> Iterator[Limit]:
    """The limits of a command that judges nothing."""
    return iter(())


def in_this_process(problem: object) -> int:
    """How many processes draw the few charts of most commands."""
    return 1


@dataclass(frozen=True)
class Command(Generic[S, O, P, R]):
    """`read` makes settings of the text of a file and of what messages call it; `resolve` refuses all else that can be
    refused (`InputError`, `PlantError`); `compute` tells each finished step.

    `name`: as it is typed. `options`: a declared model of what is typed behind it. `limits_of_use`: what figures do not
    say. `text`: the text of the configuration at a path, where that may be something else than a TOML file, so that the
    frame keeps no copy of it; its other argument is the command that prints such a file. `inputs`: a folder of the
    results into which `compute` copies what is read, before anything else; a later run may read it there. `drawing`:
    how many processes draw its charts, which are pickled where there is more than one. `variant`: the command of the
    same name that does what is asked, where the settings decide between two.
    """

    name: str
    read: Callable[[str, str], S]
    options: type[O]
    resolve: Callable[[Asked[S, O]], P]
    head: Callable[[P], Head]
    steps: Callable[[P], Steps]
    compute: Callable[[P, Work], R]
    show: Callable[[R], Iterator[Chapter]]
    limits: Callable[[R], Iterable[Limit]] = no_limits
    limits_of_use: Sequence[str] = ()
    drawing: Callable[[P], int] = in_this_process
    variant: Callable[[Asked[S, O]], Command[S, O, Any, Any]] | None = None
    text: Callable[[Path, str], str] = read_text
    inputs: str = ""


@dataclass(frozen=True)
class Verdict:
    """All limits of a command; none: nothing is judged, and it is accepted."""

    limits: tuple[Limit, ...]

    @property
    def accepted(self) -> bool:
        """Every limit is kept for sure."""
        return self.kept is True

    @property
    def kept(self) -> bool | None:
        """Whether all limits are kept; None where none is missed for sure, but the figures do not decide some."""
        if any(limit.kept is False for limit in self.limits):
            return False
        return None if any(limit.kept is None for limit in self.limits) else True

    @property
    def worst_first(self) -> tuple[Limit, ...]:
        """The limits that are missed, then those that are not decided, then those that are kept."""
        return tuple(sorted(self.limits, key=lambda limit: (False, None, True).index(limit.kept)))

    @property
    def sentence(self) -> str:
        """The limits that are not kept, or that all are."""
        missed = [limit.sentence for limit in self.worst_first if not limit.kept]
        return "; ".join(missed or [limit.sentence for limit in self.limits])
