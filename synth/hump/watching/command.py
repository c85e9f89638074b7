"""The command `hump watch`: a night's passes of all positions of a yard, and what to repair first."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

from synth.frame.command import Command, Limit, Steps, Work
from synth.frame.exhibits import Chapter
from synth.frame.settings.settings_file import parse_settings
from synth.hump.limits_of_use import MODEL_ONLY
from synth.hump.watching.asked_yard import AskedYard, asked_yard
from synth.hump.watching.options import YardWatchOptions
from synth.hump.watching.settings import YardWatchSettings
from synth.hump.watching.shown import drifted, evidence, positions, repairs, silent
from synth.hump.watching.watched_yard import WatchedYard, watched_yard
from synth.kernels.cache import guarded
from synth.logs.drift.command import LIMITS_OF_USE as OF_A_WATCH

LIMITS_OF_USE = (
    MODEL_ONLY,
    *OF_A_WATCH,
    "After an alarm passes are taken until its cause is sought no longer, 250 at most; then the position waits for its "
    "repair: --repaired, or another configuration.",
    "A cost takes exit errors to be alike for all cuts of the retarder, whatever their category and command.",
    "Switches and wheel detectors are not watched.",
)


def compute(asked: AskedYard, work: Work) -> WatchedYard:
    """All positions, then what the drifts cost."""
    return guarded(watched_yard, asked, work.directory, work.progress)


def limits(found: WatchedYard) -> Iterator[Limit]:
    """Whether any position has drifted, and whether all were watched."""
    yield Limit(drifted(found), not found.repairs)
    if found.silent:
        yield Limit(silent(found), None)


def show(found: WatchedYard) -> Iterator[Chapter]:
    """The list first, then why, then every position."""
    yield Chapter("What to repair first", tuple(repairs(found)))
    if found.repairs:
        yield Chapter("Evidence", tuple(evidence(found)))
    yield Chapter("All positions", tuple(positions(found)))


COMMAND = Command(
    name="hump watch",
    read=partial(parse_settings, YardWatchSettings),
    options=YardWatchOptions,
    resolve=asked_yard,
    head=lambda asked: asked.head,
    steps=lambda asked: Steps(len(asked.positions), "watching", "positions"),
    compute=compute,
    show=show,
    limits=limits,
    limits_of_use=LIMITS_OF_USE,
)
