"""The command `qualify`: whether the program does on this machine what it did where it was tested."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from synth.cli.qualification.options import QualifyOptions
from synth.frame.command import Asked, Command, Head, Limit, Steps, Work
from synth.frame.exhibits import Chapter
from synth.frame.settings.section import OutputSettings
from synth.retarder.exit_figures import NOT_CERTIFIED

if TYPE_CHECKING:
    from synth.cli.qualification.qualified import Qualified

LIMITS_OF_USE: Final = (
    "It holds for this machine, these versions and these settings alone. Qualify again after any of them changed.",
    "The checks are of small books. They find a damaged or differing installation, not a fault of the method; whether "
    "the model is true of your retarder, only the track says.",
    "The independent program shares no code with the rest, but its authors.",
    "No compiler, processor or runtime of the controller itself took part: run the self-test there.",
    NOT_CERTIFIED,
)


@dataclass(frozen=True)
class Nothing:
    """What is asked: nothing can be set."""


def read(text: str, place: str) -> Nothing:
    """There is no configuration."""
    return Nothing()


def resolve(asked: Asked[Nothing, QualifyOptions]) -> Nothing:
    """Nothing is refused."""
    return asked.settings


def head(asked: Nothing) -> Head:
    """What is said: the problem is the same for all."""
    from synth.cli.qualification.tuned import KINDS, problem
    from tuning_tables.json_text import canonical_json

    told = canonical_json({kind: problem(kind) for kind in KINDS}).decode()
    return Head("Qualification of this installation", told, (), OutputSettings())


def steps(asked: Nothing) -> Steps:
    """The groups of checks."""
    from synth.cli.qualification.qualified import STEPS

    return Steps(STEPS, "checking", "groups of checks")


def compute(asked: Nothing, work: Work) -> Qualified:
    """All checks."""
    from synth.cli.qualification.qualified import qualified

    return qualified(work.progress.done)


def limits(found: Qualified) -> Iterable[Limit]:
    """Whether a check failed."""
    from synth.cli.qualification import qualified

    return qualified.limits(found)


def show(found: Qualified) -> Iterator[Chapter]:
    """What is shown of it."""
    from synth.cli.qualification.qualified import chapters

    return chapters(found)


COMMAND = Command(
    name="qualify",
    read=read,
    options=QualifyOptions,
    resolve=resolve,
    head=head,
    steps=steps,
    compute=compute,
    show=show,
    limits=limits,
    limits_of_use=LIMITS_OF_USE,
)
