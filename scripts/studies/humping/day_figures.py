"""Figures of a trial, and how they differ between two trials on the same trains."""

from __future__ import annotations

from dataclasses import dataclass, replace

from scripts.studies.aiming.trial import Value
from scripts.studies.humping.base_trial import FEEDBACK, OPEN
from scripts.studies.humping.runs import Group
from scripts.studies.study import ABSENT, plus_minus, span
from synth.hump.rolling.outcomes import TrainOutcomes
from synth.hump.trains.train_figures import TrainFigure, of_cuts, train_figures
from synth.hump.trial.trial import HumpTrial, Sensing

PERCENT = 100.0


@dataclass(frozen=True)
class DayFigures:
    """Of a trial: `cuts` humped; shares of them that caught up on the slope, in the last position, on the track, or
    stopped on the way; of those that reached their track, couplings above the limit, and by class; free metres that a
    cut left. `enough_cuts`: N for the share of catch-ups within `NEAR` (None where none was seen)."""

    cuts: int
    hump_speed_m_s: Value
    cars_per_hour: Value
    catch_ups: Value
    in_last: Value
    on_track: Value
    stopped: Value
    overspeed: Value
    classes: tuple[Value, Value, Value]
    gap_m: Value
    enough_cuts: float | None


NEAR = 0.001
"""Shares of catch-ups are wanted so near."""

CLASSES = ("overspeed_slight", "overspeed_rough", "overspeed_harmful")


def day_figures(found: TrainOutcomes) -> DayFigures:
    """Those of these trains."""
    told = {figure.name: figure for figure in train_figures(found, NEAR)}
    low, middle, high = (value_of(told[name]) for name in CLASSES)
    return DayFigures(
        cuts=int(found.cuts.sum()),
        hump_speed_m_s=value_of(told["hump_speed"]),
        cars_per_hour=value_of(told["cars_per_hour"]),
        catch_ups=value_of(told["catch_ups"]),
        in_last=value_of(told["contacts_in_last_position"]),
        on_track=value_of(told["caught_on_track"]),
        stopped=value_of(told["stopped_on_the_way"]),
        overspeed=value_of(told["overspeed"]),
        classes=(low, middle, high),
        gap_m=value_of(told["gap_per_cut"]),
        enough_cuts=told["catch_ups"].enough_n or None,
    )


def value_of(figure: TrainFigure) -> Value:
    """The same as studies hold it."""
    return Value(figure.value, (figure.low95, figure.high95))


@dataclass(frozen=True)
class Pair:
    """A trial run with feedback and open loop, by one program; `name` tells it from others; `sensing` of both."""

    name: str
    trial: HumpTrial
    sensing: Sensing | None = None

    @property
    def group(self) -> Group:
        """Both trials."""
        open_loop, feedback = (replace(control, sensing=self.sensing) for control in (OPEN, FEEDBACK))
        trial = self.trial
        return Group({self.open: replace(trial, control=open_loop), self.feedback: replace(trial, control=feedback)})

    @property
    def open(self) -> str:
        """Name of the trial in open loop."""
        return f"{self.name}: open loop"

    @property
    def feedback(self) -> str:
        """Name of the trial with feedback."""
        return f"{self.name}: feedback"

    def found(self, outcomes: dict[str, TrainOutcomes]) -> PairFigures:
        """What both came to."""
        open_loop, feedback = outcomes[self.open], outcomes[self.feedback]
        return PairFigures(
            self.name, day_figures(open_loop), day_figures(feedback), fewer_catch_ups(open_loop, feedback)
        )


@dataclass(frozen=True)
class PairFigures:
    """Both, and by how much the share of catch-ups is less with feedback, paired by train; negative: it is worse."""

    name: str
    open_loop: DayFigures
    feedback: DayFigures
    fewer: Value


CAUGHT = of_cuts("caught", lambda found: found.caught + found.caught_in_last)


def fewer_catch_ups(one: TrainOutcomes, other: TrainOutcomes) -> Value:
    """By how much the share of catch-ups, those in the last position included, is less in `other`."""
    value, *ends = CAUGHT.difference(one, other)
    return Value(value, (ends[0], ends[1]))


def share(value: Value) -> str:
    """'1.23 [0.98, 1.52]', in percent."""
    digits = 2 if value.value < 0.1 else 1
    return f"{PERCENT * value.value:.{digits}f} {span(value.ci95, digits, PERCENT)}"


def points(value: Value) -> str:
    """'0.42 ± 0.10', percentage points."""
    return plus_minus(value.value, value.ci95, 2, PERCENT)


def speed(value: Value) -> str:
    """'2.61 ± 0.02'."""
    return plus_minus(value.value, value.ci95, 2)


def whole(value: Value) -> str:
    """'703 ± 11'."""
    return plus_minus(value.value, value.ci95, 0)


def metres(value: Value) -> str:
    """'71.6 ± 4.3'."""
    return plus_minus(value.value, value.ci95, 1)


def enough(found: DayFigures) -> str:
    """N for the share of catch-ups, to two digits."""
    return ABSENT if found.enough_cuts is None else f"{float(f'{found.enough_cuts:.2g}'):.0f}"
