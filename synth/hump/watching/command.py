"""The command `hump watch`: a night's passes of all positions of a yard, and what to repair first."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from synth.frame.command import Asked, Command, Head, Limit, Steps, Work
from synth.frame.exhibits import Chapter
from synth.frame.settings.settings_file import parse_settings
from synth.hump.limits_of_use import MODEL_ONLY
from synth.hump.watching.options import YardWatchOptions
from synth.hump.watching.settings import YardWatchSettings
from synth.logs.drift.command import LIMITS_OF_USE as OF_A_WATCH

if TYPE_CHECKING:
    from synth.hump.watching.asked_yard import AskedYard
    from synth.hump.watching.watched_yard import WatchedYard

LIMITS_OF_USE = (
    MODEL_ONLY,
    *OF_A_WATCH,
    "After an alarm passes are taken until its cause is sought no longer, 250 at most; then the position waits for its "
    "repair: --repaired, or another configuration.",
    "A cost takes exit errors to be alike for all cuts of the retarder, whatever their category and command.",
    "Switches and wheel detectors are not watched.",
)


def read(text: str, place: str) -> YardWatchSettings:
    """The settings."""
    return parse_settings(YardWatchSettings, text, place)


def resolve(asked: Asked[YardWatchSettings, YardWatchOptions]) -> AskedYard:
    """The positions and the trial."""
    from synth.hump.watching.asked_yard import asked_yard

    return asked_yard(asked)


def head(asked: AskedYard) -> Head:
    """What is said of it."""
    return asked.head


def steps(asked: AskedYard) -> Steps:
    """A step for each position."""
    return Steps(len(asked.positions), "watching", "positions")


def compute(asked: AskedYard, work: Work) -> WatchedYard:
    """All positions, then what the drifts cost."""
    from synth.hump.watching.watched_yard import watched_yard
    from synth.kernels.cache import guarded

    return guarded(watched_yard, asked, work.directory, work.progress)


def limits(found: WatchedYard) -> Iterator[Limit]:
    """Whether any position has drifted, and whether all were watched."""
    from synth.hump.watching.shown import drifted, silent

    yield Limit(drifted(found), not found.repairs)
    if found.silent:
        yield Limit(silent(found), None)


def show(found: WatchedYard) -> Iterator[Chapter]:
    """The list first, then why, then every position."""
    from synth.hump.watching.shown import evidence, positions, repairs

    yield Chapter("What to repair first", tuple(repairs(found)))
    if found.repairs:
        yield Chapter("Evidence", tuple(evidence(found)))
    yield Chapter("All positions", tuple(positions(found)))


COMMAND = Command(
    name="hump watch",
    read=read,
    options=YardWatchOptions,
    resolve=resolve,
    head=head,
    steps=steps,
    compute=compute,
    show=show,
    limits=limits,
    limits_of_use=LIMITS_OF_USE,
)
