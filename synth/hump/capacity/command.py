"""The command `hump capacity`: cars an hour against catch-ups, for a trial and for changes to it; what is shown: cars
an hour at the allowed share, the curves, and every point.
"""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Final

from synth.frame.command import Command, Head, Steps, Work
from synth.frame.exhibits import Chapter, Chart, Column, Exhibit, Row, Sentence, Table, Tile, Tiles
from synth.frame.printed_numbers import decimals, per_cent, whole
from synth.hump.capacity.asked_capacity import AskedCapacity, FoundCapacity, asked_capacity
from synth.hump.capacity.curves import Curve, curves
from synth.hump.configuration.trial_file import parse_trial_file, trial_text
from synth.hump.options import CapacityOptions
from synth.hump.trains.batch import batches
from synth.hump.trains.train_run import engine_for, run_of, run_trials
from synth.hump.trial.asked_trial import MODEL_ONLY, NO_SAFETY, AskedTrial
from synth.hump.trial.made_trial import made_trial, planner_of
from synth.hump.trial.resolved_trial import ResolvedTrial
from synth.hump.trial.trial import HumpTrial
from synth.kernels.cache import guarded
from tuning_tables.json_text import canonical_json

if TYPE_CHECKING:
    from matplotlib.figure import Figure

HOW_TO_READ: Final = (
    "Between its points a curve is a straight line, which is bent in the picture, as its axis is logarithmic. Where it "
    "meets the allowed share of catch-ups, cars an hour are read. Brackets: 95 % intervals. Those of a point take a "
    "train as what is drawn; those at the limit come from 2000 samples of whole trains. Where curves hump the same "
    "trains, a difference is known better than its two ends: the column 'more than the first' tells it. A catch-up is "
    "a cut that was misrouted behind the one ahead or ran into it."
)

NAME: Final = Column("curve", "curve", words=True)


def at_limit(found: FoundCapacity) -> Iterator[Exhibit]:
    """A sentence and a row a curve."""
    allowed = per_cent(found.asked.options.catch_ups)
    yield Tiles([tile_of(curve, allowed) for curve in found.curves])
    for curve in found.curves:
        yield Sentence(sentence_of(curve, allowed), brief=True)
    columns = (
        NAME,
        *variant_columns(found),
        Column("cars_per_hour", f"cars an hour at {allowed} catch-ups", form=whole),
        Column("hump_speed_m_s", "mean hump speed there", "m/s", decimals(2), spare=1),
        Column("more_cars_per_hour", "more than the first", "cars/h", decimals(0)),
        Column("why", "no figure because", words=True, spare=2),
    )
    yield Table("capacity", "Cars an hour at the allowed share of catch-ups", columns, list(limit_rows(found)))
    yield Chart(
        "capacity",
        "Catch-ups over cars an hour",
        f"Every point is {found.asked.number} trains, the same for each curve unless a changed key makes others; "
        "bars are 95 % intervals. A triangle that points down: no cut caught up, and the share is below it. "
        f"Dashed: the {allowed} that are allowed.",
        lambda: picture(found),
    )
    yield Sentence(HOW_TO_READ)


def points(found: FoundCapacity) -> Iterator[Exhibit]:
    """A row a point."""
    axis = found.asked.axis
    columns = (
        Column("curve", "curve", words=True, once=True),
        *variant_columns(found),
        Column("value", axis.name, axis.unit),
        Column("hump_speed_m_s", "mean hump speed", "m/s", decimals(2)),
        Column("cars_per_hour", "cars an hour", form=whole),
        Column("catch_ups", "catch-ups", form=per_cent),
        Column("cuts", "cuts", spare=1),
    )
    rows = [
        {
            **names_of(curve),
            "value": point.value,
            "hump_speed_m_s": point.hump_speed_m_s.told,
            "cars_per_hour": point.cars_per_hour.told,
            "catch_ups": point.catch_ups.told,
            "cuts": point.catch_ups.n,
        }
        for curve in found.curves
        for point in curve.points
    ]
    yield Table("points", "Points of the curves", columns, rows, brief=True)


def name_of(curve: Curve) -> str:
    """What people call a curve."""
    return curve.variant.name or "the trial as it is"


def names_of(curve: Curve) -> Row:
    """The curve, and what it changes by key, so that rows of several runs can be put together."""
    return {"curve": name_of(curve), **curve.variant.told}


def variant_columns(found: FoundCapacity) -> tuple[Column, ...]:
    """A column a key that curves differ in, for programs."""
    return tuple(Column(key, key, detail=True, words=True) for key in found.curves[0].variant.told)


def limit_rows(found: FoundCapacity) -> Iterator[Row]:
    """Where each curve meets the limit."""
    for curve in found.curves:
        yield {
            **names_of(curve),
            "cars_per_hour": curve.at_limit.cars_per_hour,
            "hump_speed_m_s": curve.at_limit.hump_speed_m_s,
            "more_cars_per_hour": curve.more_cars_per_hour,
            "why": curve.at_limit.why or None,
        }


def sentence_of(curve: Curve, allowed: str) -> str:
    """'exit_std_m_s 0.2: with at most 0.2 % of the cuts caught up 610 [601, 619] cars an hour'."""
    start = f"{name_of(curve)}: with at most {allowed} of the cuts caught up"
    cars = curve.at_limit.cars_per_hour
    if cars is None:
        return f"{start} not decidable with these trains: {curve.at_limit.why}"
    said = f"{start} {cars.value:.0f} [{cars.low95:.0f}, {cars.high95:.0f}] cars an hour"
    more = curve.more_cars_per_hour
    return f"{said}, {more.value:.0f} [{more.low95:.0f}, {more.high95:.0f}] more than the first" if more else said


def tile_of(curve: Curve, allowed: str) -> Tile:
    """The same at a glance."""
    cars = curve.at_limit.cars_per_hour
    told = "not decided" if cars is None else f"{cars.value:.0f}"
    return Tile(told, f"cars an hour at {allowed} catch-ups, {name_of(curve)}")


def picture(found: FoundCapacity) -> Figure:
    """The curves, drawn."""
    from synth.hump.capacity.frontier import frontier

    return frontier([(name_of(curve), curve) for curve in found.curves], found.asked.options.catch_ups)


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
