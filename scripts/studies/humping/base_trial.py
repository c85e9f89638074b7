"""Trials of the studies, from the text that a user would write, and what is changed in them."""

from __future__ import annotations

from dataclasses import dataclass, replace

from plant_models.frozen_arrays import Floats
from synth.hump.configuration.trial_file import parse_trial_file
from synth.hump.planning.forecast import Given
from synth.hump.planning.known_cuts import KnownCuts
from synth.hump.planning.speed_rules import HumpSpeedLimits, SpeedMethod
from synth.hump.rolling.hump_position import LibraryBrake, NormalHumpPosition
from synth.hump.rolling.list_trains import TrainSource
from synth.hump.rolling.route_rolling import rolling_on
from synth.hump.rolling.train_cuts import TrainCuts
from synth.hump.trial.made_trial import made_trial
from synth.hump.trial.resolved_trial import resolve_trial
from synth.hump.trial.trial import Control, HumpTrial, Sensing

NAME = "hump-day"

LOWEST_M_S, STEP_M_S = 1.0, 0.1
"""Lowest hump speed, and from step to step."""

OPEN, FEEDBACK = Control(feedback=False), Control(feedback=True)

SPEED_STD_M_S = 0.03
"""Error of the speeds by which resistance is measured; assumed, as in the study `yard-chain`."""

READING = Sensing(SPEED_STD_M_S, for_intervals=False)
"""The last position aims by the resistance that was measured of a cut."""

MEASURED = Control(feedback=True, sensing=Sensing(SPEED_STD_M_S, for_aim=False))
"""Feedback that knows the resistance of a cut from its free roll."""

SLOW_DOWN_S = 0.2
"""Cuts that would come closer are let go later by a feedback that acts on the hump speed; the plan keeps as much."""

SLOWING = Control(feedback=True, slow_down_s=SLOW_DOWN_S)
"""Feedback that slows the train down, too."""


@dataclass(frozen=True)
class Locomotive:
    """What limits hump speeds: the fastest, by uncoupling or signal, and the acceleration of the train."""

    highest_m_s: float = 4.0
    acceleration_m_s2: float = 0.1

    @property
    def limits(self) -> HumpSpeedLimits:
        """As the planner takes them."""
        count = round((self.highest_m_s - LOWEST_M_S) / STEP_M_S) + 1
        return HumpSpeedLimits(tuple(round(LOWEST_M_S + k * STEP_M_S, 6) for k in range(count)), self.acceleration_m_s2)


LOCOMOTIVE = Locomotive()
"""Wide limits, so that cuts and not the locomotive decide; most can less."""


@dataclass(frozen=True)
class Day:
    """What a trial is made from: trains, their seed, and the exactness of all positions.

    `aim_std_m_s`: that with which the exit speeds of the last position are chosen, None: its own; `measured`: on
    readings of the resistance of each cut. `more`: further text of the configuration, `positions`: of each position.
    """

    seed: int
    cuts: int
    std_m_s: float = 0.15
    aim_std_m_s: float | None = None
    p_overspeed: float = 0.1
    design_cuts: int = 2000
    measured: bool = False
    more: str = ""
    positions: tuple[str, str, str] = ("", "", "")

    @property
    def text(self) -> str:
        """The configuration."""
        std = self.std_m_s if self.aim_std_m_s is None else self.aim_std_m_s
        places = "".join(
            f"[[position]]\nnumber = {number}\nexit_std_m_s = {std}\n{more}\n"
            for number, more in enumerate(self.positions, start=1)
        )
        known = f'knowledge = "measured"\n[sensors]\nspeed_std_m_s = {SPEED_STD_M_S}\n' if self.measured else ""
        return (
            f"[trains]\nseed = {self.seed}\ncuts = {self.cuts}\n"
            f"[aim]\np_overspeed = {self.p_overspeed}\ndesign_cuts = {self.design_cuts}\n{known}{self.more}\n{places}"
        )

    def trial(self) -> HumpTrial:
        """The trial; aims are chosen here, which takes a second or two."""
        made = made_trial(resolve_trial(parse_trial_file(self.text, NAME)), 1)
        planned = replace(made, planner=replace(made.planner, limits=LOCOMOTIVE.limits))
        return with_stds(planned, (self.std_m_s,) * len(made.positions))


def with_stds(trial: HumpTrial, stds_m_s: tuple[float, ...]) -> HumpTrial:
    """Other errors of the positions, which must be normal; the aim is as it was."""
    positions = tuple(replace(normal(p), std_m_s=std) for p, std in zip(trial.positions, stds_m_s, strict=True))
    return replace(trial, positions=positions)


def with_interval_std(trial: HumpTrial, std_m_s: float) -> HumpTrial:
    """Another error of all positions but the last."""
    ahead = len(trial.positions) - 1
    return with_stds(trial, (std_m_s,) * ahead + (normal(trial.positions[-1]).std_m_s,))


def with_planner(
    trial: HumpTrial,
    least_s: float | None = None,
    worst_pair: bool | None = None,
    method: SpeedMethod | None = None,
    locomotive: Locomotive | None = None,
) -> HumpTrial:
    """Another program of hump speeds; None: as it was."""
    now = trial.planner
    planner = replace(
        now,
        least_s=now.least_s if least_s is None else least_s,
        worst_pair=now.worst_pair if worst_pair is None else worst_pair,
        method=now.method if method is None else method,
        limits=now.limits if locomotive is None else locomotive.limits,
    )
    return replace(trial, planner=planner)


def with_free(trial: HumpTrial, free: tuple[float, float]) -> HumpTrial:
    """Tracks free between these shares of their length."""
    tracks = trial.tracks.model_copy(update={"free_low": free[0], "free_high": free[1]})
    return replace(trial, tracks=tracks)


def braked_by(trial: HumpTrial, share: float, place: int | None = None) -> HumpTrial:
    """Full brakes of `share` of their power, at `place` alone or everywhere; the control does not know of it."""
    positions = tuple(
        replace(normal(p), full_brake_head_m=replace(brake_of(p), share=share)) if place in (None, k) else p
        for k, p in enumerate(trial.positions)
    )
    return replace(trial, positions=positions)


def normal(position: object) -> NormalHumpPosition:
    """The position, which has a normal error."""
    assert isinstance(position, NormalHumpPosition)
    return position


def brake_of(position: object) -> LibraryBrake:
    """Its full brake."""
    brake = normal(position).full_brake_head_m
    assert isinstance(brake, LibraryBrake)
    return brake


@dataclass(frozen=True)
class UnknownWind(TrainSource):
    """Trains with a head wind that is `more_m_s` more than any control expects."""

    more_m_s: float = 0.0

    def trains(self, first: int, count: int) -> TrainCuts:
        """See `TrainSource`."""
        cuts = super().trains(first, count)
        return replace(cuts, drawn=replace(cuts.drawn, head_wind_m_s=cuts.drawn.head_wind_m_s + self.more_m_s))


@dataclass(frozen=True)
class KnownResistanceTrial(HumpTrial):
    """A trial whose program knows before the train how each cut will roll: its resistance, wind and bends."""

    def known(self, trains: TrainCuts, free_m: Floats) -> KnownCuts:
        """As it will be."""
        drawn, usual = trains.drawn, super().known(trains, free_m)
        own = drawn.resistance_n_per_kn
        given = Given(usual.aim.speed_m_s, usual.aim.most_entry_m_s)  # nobody rolls worse than expected
        return replace(
            usual,
            rolls=rolling_on(self.ways, trains.population, drawn, self.threads),
            mean_n_per_kn=own,
            good_n_per_kn=own,
            bad_n_per_kn=own,
            aim=given,
        )


def with_known_resistance(trial: HumpTrial) -> HumpTrial:
    """The same trial with that program."""
    return KnownResistanceTrial(**{name: getattr(trial, name) for name in trial.__dataclass_fields__})
