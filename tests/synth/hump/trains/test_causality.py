"""A control knows nothing of what lies in its future, and a plan nothing of trains beside it."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np
import pytest
from numpy.typing import NDArray

from synth.hump.planning.interval_control import Feedback, FeedbackSpeeds
from synth.hump.planning.rollability import Rollability
from synth.hump.rolling.hump_position import Arrivals, HumpPosition, Passed
from synth.hump.rolling.humping import Hump, humped
from synth.hump.rolling.route_rolling import rolling_on
from synth.hump.rolling.train_memory import Asked, ExitSpeeds, TrainMemory
from synth.hump.trial.tracks_between import free_before_m, with_room
from synth.hump.trial.trial import Control, HumpTrial, Sensing
from tests.effort import every
from tests.synth.hump.trains.made_trials import Day

Floats = NDArray[np.float64]

TRAINS, CUTS = 25, 14
FEW_TRACKS = dict.fromkeys((1, 2, 17), 1.0)


@dataclass
class Fate:
    """Changes what happens later than `after_s`: wrong exits of all passes that begin then, and wrong beliefs of the
    resistance. `asked_s` is when the cuts came that pass next; `told` has all questions and answers."""

    after_s: float
    asked_s: Floats = field(default_factory=lambda: np.empty(0))
    told: list[tuple[Asked, Floats]] = field(default_factory=list)


@dataclass(frozen=True)
class Heard:
    """A control whose questions and answers are kept."""

    control: ExitSpeeds
    fate: Fate

    def command(self, asked: Asked) -> Floats:
        """What it answers."""
        answer = self.control.command(asked)
        self.fate.told.append((asked, answer))
        self.fate.asked_s = asked.start.time_s
        return answer


@dataclass(frozen=True)
class Misjudged:
    """What is believed of cuts, wrong later than the fate tells."""

    rollability: Rollability
    fate: Fate

    def __call__(self, asked: Asked) -> Floats:
        """Much more, where it is late enough."""
        late = asked.start.time_s > self.fate.after_s
        return self.rollability(asked) + np.where(late, 4.0, 0.0)


@dataclass(frozen=True)
class Fated:
    """A position that goes wrong later than the fate tells."""

    position: HumpPosition
    fate: Fate

    def passed(self, arrivals: Arrivals) -> Passed:
        """Much slower than commanded, where it is late enough."""
        late = self.fate.asked_s > self.fate.after_s
        command = np.where(late, 0.4 * arrivals.commanded_m_s, arrivals.commanded_m_s)
        return self.position.passed(replace(arrivals, commanded_m_s=command))


def run(trial: HumpTrial, after_s: float) -> tuple[Fate, TrainMemory]:
    """As `HumpTrial.humped`, but with a fate."""
    trains = trial.source.trains(0, TRAINS)
    free_m = with_room(trial.routes, trains, free_before_m(trial.tracks, trial.routes, trains.seed, 0, TRAINS))
    known = trial.known(trains, free_m)
    plan = trial.planner.plan(known)
    fate = Fate(after_s)
    rolls = rolling_on(trial.ways, trains.population, trains.drawn, 1)
    control = trial.control_of(trains, known, plan, trial.aim_of(trains, known, rolls))
    assert isinstance(control, Feedback)
    control.rollability = Misjudged(control.rollability, fate)
    positions = tuple(Fated(position, fate) for position in trial.positions)
    hump = Hump(trial.routes, positions, rolls)
    return fate, humped(hump, trains, free_m, FeedbackSpeeds(control, 0.3), Heard(control, fate))


def answers(fate: Fate) -> dict[tuple[int, int, int], tuple[float, float]]:
    """By cut, position and lane: when the control was asked, and what it answered."""
    return {
        (asked.cut, asked.position, lane): (time, command)
        for asked, answer in fate.told
        for lane, time, command in zip(asked.lanes.tolist(), asked.start.time_s.tolist(), answer.tolist(), strict=True)
    }


@pytest.mark.parametrize(("tracks", "after_s"), [(None, 60.0), (FEW_TRACKS, 140.0)], ids=["all tracks", "few tracks"])
@pytest.mark.parametrize("sensing", every(2, [Sensing(), None]), ids=["measured", "by category"])
def test_commands_do_not_depend_on_what_happens_later(
    tracks: dict[int, float] | None, after_s: float, sensing: Sensing | None
) -> None:
    """All passes that begin after a while go wrong: the commands until then are the same to the bit, and so are
    the hump speeds that are chosen until then; later ones are not."""
    trial = Day(cuts=CUTS, tracks=tracks, aim_m_s=1.0, aim_far_m_s=3.0, control=Control(sensing=sensing)).on()
    (right, memory), (wrong, poisoned) = run(trial, np.inf), run(trial, after_s)
    one, other = answers(right), answers(wrong)
    before = after = 0
    for key in one.keys() & other.keys():
        if min(one[key][0], other[key][0]) <= after_s:
            assert one[key] == other[key], key
            before += 1
        else:
            after += int(one[key][1] != other[key][1])
    assert (
        min((both[0] for key, both in (one | other).items() if (key in one) != (key in other)), default=np.inf)
        > after_s
    )
    assert before > 100
    assert after > 30
    chosen = np.concatenate((np.zeros((TRAINS, 1)), memory.crest_s[:, :-1]), axis=1) <= after_s
    np.testing.assert_array_equal(memory.hump_speed_m_s[chosen], poisoned.hump_speed_m_s[chosen])


def test_the_plan_of_the_first_cuts_does_not_depend_on_later_trains_nor_trains_on_each_other() -> None:
    trial = Day(cuts=8).on()

    def planned(first: int, count: int) -> tuple[Floats, ...]:
        trains = trial.source.trains(first, count)
        free_m = free_before_m(trial.tracks, trial.routes, 5, first, count)
        plan = trial.planner.plan(trial.known(trains, free_m))
        return plan.hump_speed_m_s, plan.crest_s, plan.exit_m_s, plan.margins_s, plan.first_in_s, plan.last_out_s

    for whole, part in zip(planned(0, 9), planned(0, 4), strict=True):
        np.testing.assert_array_equal(whole[:4], part)
    for whole, part in zip(planned(0, 9), planned(7, 1), strict=True):
        np.testing.assert_array_equal(whole[7:8], part)
