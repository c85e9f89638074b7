"""The command `hump capacity`: cars an hour against catch-ups, for a trial and for changes to it."""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import partial

from synth.frame.command import Command, Head, Steps, Work
from synth.frame.exhibits import Chapter
from synth.hump.capacity.asked_capacity import AskedCapacity, FoundCapacity, asked_capacity
from synth.hump.capacity.curve import curves
from synth.hump.capacity.options import CapacityOptions
from synth.hump.capacity.shown import at_limit, points
from synth.hump.configuration.trial_file import parse_trial_file, trial_text
from synth.hump.limits_of_use import MODEL_ONLY, NO_SAFETY
from synth.hump.trains.asked_trial import AskedTrial
from synth.hump.trains.batch import batches
from synth.hump.trains.made_trial import made_trial, planner_of
from synth.hump.trains.resolved_trial import ResolvedTrial
from synth.hump.trains.train_engine import engine_for
from synth.hump.trains.train_run import run_of, run_trials
from synth.hump.trains.trial import HumpTrial
from synth.kernels.cache import guarded
from tuning_tables.canonical import canonical_json

LIMITS_OF_USE = (
    MODEL_ONLY,
    "Between two points of a curve a straight line is taken. Intervals cover the chance of these trains, neither that "
    "line nor the parameters nor the model.",
    "Cars an hour are those over the crest while a train is humped. What the yard can bring and take away is not told.",
    NO_SAFETY,
)


def head(asked: AskedCapacity) -> Head:
    """What is said of it: the parameters are those of the trial as it is."""
    points = [each.config.canonical_json for each in asked.every_point]
    depends = canonical_json({"format": "hump-capacity", "points": points, "catch_ups": asked.options.catch_ups})
    config = asked.base.config
    told = asked.base.head(f"Capacity. {config.settings.title or config.hump.title}", depends.decode("utf-8"))
    warnings = dict.fromkeys(warning for each in asked.every_point for warning in each.config.warnings)
    return replace(told, warnings=tuple(warnings))


def steps(asked: AskedCapacity) -> Steps:
    """A step for each batch of each point."""
    of_points = (batches(asked.number, each.config.settings.tracks.shift_trains) for each in asked.every_point)
    return Steps(sum(of_points), "humping", "batches")


def compute(asked: AskedCapacity, work: Work) -> FoundCapacity:
    """Hump the trains of all points, those of earlier runs left out."""
    started, runs = time.monotonic(), []
    for variant, trials in zip(asked.variants, asked.points, strict=True):
        for value, config, trial in zip(asked.axis.values, *guarded(trials_of, trials), strict=True):
            name = ", ".join(filter(None, (variant.name, f"{asked.axis.name} {value:g} {asked.axis.unit}")))
            runs.append(run_of(config, trial, asked.number, work.directory, name))
    outcomes = run_trials(runs, partial(engine_for, asked.options, work.progress.note), work.progress)
    work.progress.note(f"{len(runs)} points of {asked.number} trains humped after {time.monotonic() - started:.1f} s")
    count, seed = len(asked.axis.values), asked.base.config.settings.trains.seed
    by_curve = [outcomes[place : place + count] for place in range(0, len(outcomes), count)]
    found = curves(asked.variants, asked.axis, by_curve, asked.options.catch_ups, seed)
    return FoundCapacity(asked, tuple(found))


def trials_of(points: Sequence[AskedTrial]) -> tuple[list[ResolvedTrial], list[HumpTrial]]:
    """The trials of the points of a curve, which differ in how trains are pushed, so that aims are chosen once."""
    configs = [each.config for each in points]
    first = made_trial(configs[0])
    return configs, [replace(first, planner=planner_of(each)) for each in configs]


def show(found: FoundCapacity) -> Iterator[Chapter]:
    """Cars an hour at the limit, then all points."""
    yield Chapter("Cars an hour", tuple(at_limit(found)))
    yield Chapter("Points of the curves", tuple(points(found)))


COMMAND = Command(
    name="hump capacity",
    read=parse_trial_file,
    options=CapacityOptions,
    resolve=asked_capacity,
    head=head,
    steps=steps,
    compute=compute,
    show=show,
    limits_of_use=LIMITS_OF_USE,
    text=trial_text,
)
