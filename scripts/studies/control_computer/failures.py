"""What an unnoticed failure of the control does on the hump: the same trains with it and without it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from scripts.studies.control_computer.failed_hump import (
    ByHand,
    FailedPosition,
    Failure,
    StuckAtStage,
    StuckReleased,
    WeakSupply,
    failed_trial,
)
from scripts.studies.control_computer.hump_runs import (
    ExtraFigure,
    Humped,
    failure_figures,
    other_track_with_frozen_points,
)
from scripts.studies.humping.runs import Group
from scripts.studies.study import ABSENT, MarkdownTable, table
from synth.hump.configuration.trial_file import parse_trial_file
from synth.hump.rolling.outcomes import TrainOutcomes
from synth.hump.trains.train_figures import ratio
from synth.hump.trial.made_trial import brake_of, made_trial
from synth.hump.trial.resolved_trial import resolve_trial
from synth.hump.trial.trial import HumpTrial

Interval = tuple[float, float, float]

SOUND = "sound"
WEAK_SHARE, WEAK_STD_M_S = 0.5, 0.15
STAGES = (1, 2, 4)
ALONE: dict[str, Failure] = {
    "released": StuckReleased(),
    "by hand": ByHand(),
    "half the brake": WeakSupply(WEAK_SHARE, WEAK_STD_M_S),
    **{f"stuck at stage {stage}": StuckAtStage(stage) for stage in STAGES},
}
EVERYWHERE = ("released", "by hand")
ALL = "all"
LAST = 3
PUBLISHED_RISKS = (0.12, 1.0)
"""P1 and P2 of [hump-computer-1970s]: cuts with over-speed, on another track; how it failed is not told."""


@dataclass(frozen=True)
class FailureRow:
    """One failure at one position (or all): its figures beside the sound hump; `before_stop`: mean cuts that are let
    go before one stands in a position, with its interval; `never_stops`: share of trains where none does."""

    failure: str
    position: str
    figures: tuple[ExtraFigure, ...]
    before_stop: Interval
    never_stops: float

    def figure(self, name: str) -> ExtraFigure:
        """By its name."""
        (found,) = [each for each in self.figures if each.name == name]
        return found


@dataclass(frozen=True)
class Failures:
    """All of them. `frozen_points`: share of cuts that have another track than the first one of their train."""

    trains: int
    cuts: int
    rows: tuple[FailureRow, ...]
    frozen_points: Interval
    published_risks: tuple[float, float]

    def tables(self) -> dict[str, MarkdownTable]:
        """`failures`, `risks`."""
        return {
            "failures": table(
                f"what an unnoticed failure does: {self.trains} trains, {self.cuts} cuts, each humped with it and "
                "without; shares of all cuts in %, differences paired by train",
                ("failure", "position", "over-speeds more, points", "above 2 m/s more, points",
                 "caught up or misrouted more, points", "in the last position more, points", "gap a cut more, m",
                 "cuts before one stands"),
                map(failure_cells, self.rows),
            ),
            "risks": table(
                "P1 and P2: shares of cuts that couple with over-speed and that go to another track or catch up, %",
                ("failure", "position", "P1, %", "P2, %"),
                (
                    ("published", ABSENT, *(f"{100 * each:g}" for each in self.published_risks)),
                    ("none (sound hump)", ABSENT, *(percent(self.rows[0].figure(name).sound) for name in RISKS)),
                    *((row.failure, row.position, *(percent(row.figure(name).failed) for name in RISKS))
                      for row in self.rows if not stands(row)),
                    ("all points stay as they are", ABSENT, ABSENT, percent(self.frozen_points)),
                ),
            ),
        }  # fmt: skip

    def faults(self) -> tuple[str, ...]:
        """A last position that brakes nothing must show."""
        (last,) = [row for row in self.rows if (row.failure, row.position) == ("released", str(LAST))]
        if last.figure("overspeed").extra[1] > 0.0:
            return ()
        return ("failures: a last position that is stuck released adds no over-speeds beyond the interval",)


RISKS = ("overspeed", "catch_ups")


def stands(row: FailureRow) -> bool:
    """Whether trains come to a stand within half of their cuts, so that the failure does not stay unnoticed."""
    return row.never_stops < 0.5


def failure_cells(row: FailureRow) -> tuple[str, ...]:
    """A row; what is behind a cut that stands is told of no one."""
    value, low, high = row.before_stop
    stop = ABSENT if row.never_stops > NEVER else f"{value:.1f} [{max(low, 0.0):.1f}, {high:.1f}]"
    if stands(row):
        return (row.failure, row.position, *(ABSENT,) * 5, stop)
    shares = (row.figure(name).extra for name in ("overspeed", "overspeed_above_2", "catch_ups", IN_LAST))
    gap, low, high = row.figure("gap_per_cut").extra
    return row.failure, row.position, *map(percent, shares), f"{gap:.1f} [{low:.1f}, {high:.1f}]", stop


IN_LAST = "contacts_in_last_position"
NEVER = 0.99
"""Where so many trains have no cut that stands, the few have it without the failure, too."""


def percent(found: Interval) -> str:
    """With its interval."""
    value, low, high = found
    return f"{100 * value:.2f} [{100 * low:.2f}, {100 * high:.2f}]"


@dataclass(frozen=True)
class FailureTrials:
    """The sound hump of the default trial, and the same with failures, by name and position."""

    trials: Mapping[tuple[str, str], HumpTrial]

    @property
    def group(self) -> Group:
        """All of them, with one plan."""
        return Group({" at ".join(key): trial for key, trial in self.trials.items()})

    def found(self, humped: Mapping[str, Humped]) -> Failures:
        """What they came to."""
        results = {key: humped[" at ".join(key)] for key in self.trials}
        sound = results[SOUND, ALL].outcomes
        trains = len(sound)
        source = self.trials[SOUND, ALL].source.trains(0, trains)
        return Failures(
            trains=trains,
            cuts=int(sound.cuts.sum()),
            rows=tuple(failure_row(key, sound, each) for key, each in results.items() if key[0] != SOUND),
            frozen_points=other_track_with_frozen_points(source),
            published_risks=PUBLISHED_RISKS,
        )


def failure_row(key: tuple[str, str], sound: TrainOutcomes, found: Humped) -> FailureRow:
    """One failure beside the sound hump."""
    before = found.before_stop.astype(float)
    mean = plain_interval(ratio(before, np.ones(len(before))))
    never = float((found.before_stop == found.outcomes.cuts).mean())
    figures = tuple(plain_figure(each) for each in failure_figures(sound, found.outcomes))
    return FailureRow(*key, figures, mean, never)


def plain_figure(found: ExtraFigure) -> ExtraFigure:
    """The same of plain numbers."""
    sound, failed, extra = map(plain_interval, (found.sound, found.failed, found.extra))
    return replace(found, sound=sound, failed=failed, extra=extra)


def plain_interval(found: Interval) -> Interval:
    """The same of plain numbers."""
    value, low, high = found
    return float(value), float(low), float(high)


def failure_trials(cuts: int) -> FailureTrials:
    """All failures on the default hump trial, with trains of so many `cuts`."""
    config = resolve_trial(parse_trial_file(f"[trains]\ncuts = {cuts}\n", "the default trial"))
    trial, brakes = made_trial(config, 1), [brake_of(each, config) for each in config.positions]
    numbers = range(1, len(brakes) + 1)
    cases: dict[tuple[str, str], list[FailedPosition]] = {(SOUND, ALL): []}
    for name, failure in ALONE.items():
        for number in numbers:
            cases[name, str(number)] = [FailedPosition(number, failure)]
        if name in EVERYWHERE:
            cases[name, ALL] = [FailedPosition(number, failure) for number in numbers]
    return FailureTrials({key: failed_trial(trial, brakes, failed) for key, failed in cases.items()})
