"""Hump trials of the same trains, what became of them, how soon a cut stood in a position, and what an unnoticed
failure does to cuts.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields

import numpy as np

from plant_models.errors import require
from plant_models.frozen_arrays import Floats, Ints, frozen_arrays
from scripts.studies.humping.runs import Group, Kept, measured_each
from scripts.studies.study import Tell
from synth.hump.rolling.outcomes import TrainOutcomes, joined, outcomes
from synth.hump.rolling.train_cuts import TrainCuts
from synth.hump.rolling.train_memory import TrainMemory
from synth.hump.trains.train_figures import FEWEST_TRAINS, ratio, share
from synth.hump.trial.trial import HumpTrial

Interval = tuple[float, float, float]
"""Value, and the ends of its 95 % interval."""

FEW_TRAINS = 20
"""Where fewer trains than these differ between the runs, Student's interval of the difference is not to be trusted."""


@dataclass(frozen=True)
class ExtraFigure:
    """Something that happens to cuts, each as (value, low95, high95): on the sound hump, on the one with the failure,
    and the difference, paired by train. `unit` for each humped cut; `trains` and `cuts` in each run."""

    name: str
    unit: str
    sound: Interval
    failed: Interval
    extra: Interval
    trains: int
    cuts: int


EVENTS: dict[str, Callable[[TrainOutcomes], Ints]] = {
    "overspeed": lambda found: found.overspeed.sum(axis=1),
    "overspeed_above_2": lambda found: found.overspeed[:, 2],
    "catch_ups": lambda found: found.caught,
    "misrouted": lambda found: found.misrouted.sum(axis=1),
    "contacts_in_last_position": lambda found: found.caught_in_last,
    "caught_on_track": lambda found: found.caught_on_track,
    "stopped_on_the_way": lambda found: found.stopped,
}
"""Counts of cuts by train, under the names of `train_figures`. Over-speed is told of cuts that reached a track by
themselves; here it is counted for each humped cut, as all other events are."""


def failure_figures(sound: TrainOutcomes, failed: TrainOutcomes) -> tuple[ExtraFigure, ...]:
    """What the failure adds for each humped cut; `PlantError` unless both are of the same trains."""
    require_same(sound, failed)
    figures = []
    for name, events in EVENTS.items():
        without, with_it = (events(found).astype(float) for found in (sound, failed))
        cuts = sound.cuts.astype(float)
        told = (share(without, cuts)[:3], share(with_it, cuts)[:3])
        extra = difference_of_counts(without, with_it, cuts)
        figures.append(ExtraFigure(name, "1", *told, extra, len(cuts), int(cuts.sum())))
    cuts = sound.cuts.astype(float)
    gaps = (ratio(sound.gap_m, cuts), ratio(failed.gap_m, cuts))
    extra = paired_difference(sound.gap_m, failed.gap_m, cuts)
    return (*figures, ExtraFigure("gap_per_cut", "m", *gaps, extra, len(cuts), int(cuts.sum())))


def require_same(sound: TrainOutcomes, failed: TrainOutcomes) -> None:
    """`PlantError` unless both are of the same trains with the same cuts."""
    require(
        len(sound) == len(failed) >= FEWEST_TRAINS
        and bool((sound.train == failed.train).all() and (sound.cuts == failed.cuts).all()),
        f"failure costs: {len(sound)} and {len(failed)} trains; both runs must have the same trains, {FEWEST_TRAINS} "
        "at least",
    )


def paired_difference(without: Floats, with_it: Floats, cuts: Floats) -> Interval:
    """Σ(with − without)/Σcuts over trains, with Student's interval: trains are independent, the two runs are not."""
    value, low, high = ratio(with_it - without, cuts)
    return float(value), float(low), float(high)


def difference_of_counts(without: Floats, with_it: Floats, cuts: Floats) -> Interval:
    """The same of counted events, also where few trains differ or none does.

    Then trains with more events and trains with fewer are told apart: each is a share of rare events with its exact
    interval (`share`), and the difference of two shares has the interval of Newcombe, Statistics in Medicine 17 (1998),
    method 10.
    """
    difference = with_it - without
    if np.count_nonzero(difference) >= FEW_TRAINS:
        return paired_difference(without, with_it, cuts)
    more, low_more, high_more, _ = share(np.maximum(difference, 0.0), cuts)
    fewer, low_fewer, high_fewer, _ = share(np.maximum(-difference, 0.0), cuts)
    value = more - fewer
    below, above = np.hypot(more - low_more, high_fewer - fewer), np.hypot(high_more - more, fewer - low_fewer)
    return value, value - float(below), value + float(above)


def cuts_before_stop(memory: TrainMemory) -> Ints:
    """How many cuts (trains,) were let go before one that stopped in a position; all of the train where none did.

    A failure that holds cuts does not stay unnoticed: what is told of the cuts behind the first such one is told of
    cuts that nobody would have humped any more.
    """
    stopped = np.any(memory.exit_m_s <= 0.0, axis=2)
    return np.asarray(np.where(stopped.any(axis=1), stopped.argmax(axis=1), stopped.shape[1]))


def other_track_with_frozen_points(trains: TrainCuts) -> Interval:
    """Share of cuts that have another track than the first cut of their train: P2 of a computer that stops while that
    one rolls, so that all points stay as they are. Failures of positions alone leave the points to the control."""
    routes = trains.route.reshape(trains.trains, trains.cuts)
    others = (routes[:, 1:] != routes[:, :1]).sum(axis=1).astype(float)
    p, low, high, _ = share(others, np.full(trains.trains, float(trains.cuts - 1)))
    return p, low, high


BATCH = 50
"""Trains of an order; few, so that all workers end at nearly the same time."""


@frozen_arrays
class Humped:
    """What trains came to, and how many cuts of each were let go before one stood in a position, (trains,)."""

    outcomes: TrainOutcomes
    before_stop: Ints


def humped_of(trial: HumpTrial, trains: TrainCuts, memory: TrainMemory) -> Humped:
    """Of one batch."""
    return Humped(outcomes(trial.routes, trains, memory), cuts_before_stop(memory))


def joined_humped(parts: list[Humped]) -> Humped:
    """Of all batches of a trial."""
    return Humped(joined([each.outcomes for each in parts]), np.concatenate([each.before_stop for each in parts]))


HUMPED = Kept(humped_of, joined_humped)


def measured(groups: Sequence[tuple[Group, int]], workers: int, tell: Tell) -> dict[str, Humped]:
    """Every trial by its name, each on the trains 0 … n − 1, where n stands beside its group."""
    return measured_each(groups, HUMPED, workers, tell, BATCH)


def first_trains(found: TrainOutcomes, count: int) -> TrainOutcomes:
    """The outcomes of the first `count` trains."""
    return TrainOutcomes(*(getattr(found, field.name)[:count] for field in fields(TrainOutcomes)))
