"""What a hump trial configuration may contain: one frozen model a section, units in the key names."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

from pydantic import Field, model_validator

from plant_models.errors import PlantError, require
from plant_models.library.hump_entry import hump_names
from plant_models.library.sourced_value import JUDGEMENT
from synth.aim.configuration.settings import ResistanceSettings, WeatherSettings
from synth.aim.configuration.shared_settings import MixSettings
from synth.frame.settings.section import OutputSettings, Section, choice, many, optional, setting
from synth.hump.configuration.sections import CouplingLimits, DesignSettings, HumpPositionSettings
from synth.hump.options import CountedTrains
from synth.retarder.configuration.own_types import TopKeys

DEFAULT_HUMP = "large"

CATEGORY_SHARES = {"L": 0.3, "LS": 0.1, "S": 0.2, "ST": 0.1, "T": 0.3}
"""Of the library's weight categories, where a file gives none: assumed, most cars are empty or full."""

Share = Annotated[float, Field(ge=0.0, le=1e6)]
"""Shares count by their ratio."""

KNOWN = Literal["category", "measured"]


class TrainSettings(CountedTrains):
    """Trains of a population, or one sorting list again and again."""

    one_wind_a_train: bool = choice(False, "one draw of the wind a train; false: one a cut")
    list: str | None = choice(
        None,
        "in place of cuts, cars and shares one sorting list again and again (docs/how-to/hump-trials.md)",
        "train.csv",
    )
    cuts: int = setting(40, "1", 2, 999, "cuts of a train", f"{JUDGEMENT}: a train of 70 cars or so")
    cars_mean: float = setting(
        1.8,
        "1",
        1.0,
        10.0,
        "mean number of cars of a cut, geometric",
        f"{JUDGEMENT}: no law was found; 1.3 to 3 are usual",
    )
    most_cars: int = setting(
        8,
        "1",
        1,
        60,
        "most cars of a cut",
        f"{JUDGEMENT}: longer ones are rare, and half of them would be in the first position",
    )
    category_shares: dict[str, Share] | None = many(
        None, 1, 31, "shares, {L = 0.3, T = 0.7}", "shares by weight category, which count by their ratio", "1",
        f"{JUDGEMENT}: most cars are empty or full", CATEGORY_SHARES,
    )  # fmt: skip
    closed_tracks: tuple[int, ...] | None = many(
        None, 1, 199, "numbers of tracks", "tracks to which no cut goes", example=[1, 2]
    )
    track_shares: dict[str, Share] | None = many(
        None, 1, 199, "shares, {1 = 2.0, 2 = 1.0}", "shares by track; left out: all alike", "1",
        example={"1": 2.0, "2": 1.0},
    )  # fmt: skip


class TracksSettings(Section):
    """Where cars stand before each train, and what holds cuts ahead of them.

    In a shift, a track without room for the next train is pushed up, so that its gaps close, and pulled if that is not
    enough.
    """

    standing: Literal["drawn", "file"] = choice(
        "drawn", "drawn anew for each train, or as the hump file tells (standing_m)"
    )
    free_low: float = setting(
        0.2, "1", 0.0, 1.0, "least free share of a track, of its length behind the last position",
        f"{JUDGEMENT}: nothing was found on how full tracks are",
    )  # fmt: skip
    free_high: float = setting(
        0.9, "1", 0.0, 1.0, "largest free share; all between are equally frequent",
        f"{JUDGEMENT}: nothing was found on how full tracks are",
    )  # fmt: skip
    shift_trains: int = setting(
        1, "1", 1, 500, "trains of a shift, which come to the same tracks one after the other; 1: no track fills up",
        f"{JUDGEMENT}: each train finds tracks of its own",
    )  # fmt: skip
    pulled_from_share: float = setting(
        0.8, "1", 0.05, 1.0, "in a shift, a track whose cars take this share of its length is pulled before a train",
        f"{JUDGEMENT}: as full as the fullest tracks before a train; nothing was found on when tracks are pulled",
    )  # fmt: skip
    skates_share: float = setting(
        0.0, "1", 0.0, 0.99,
        "of the energy of a cut, what skates take ahead of the standing cars of a track on which no position aims",
        f"{JUDGEMENT}: no skates",
    )  # fmt: skip

    @model_validator(mode="after")
    def _low_before_high(self) -> TracksSettings:
        require(
            self.free_low <= self.free_high,
            f"free_low is {self.free_low:g}; it must not be above free_high, {self.free_high:g}",
        )
        return self


class HumpSpeedSettings(Section):
    """A program of speeds from simulated pairs of cuts, or one speed for all."""

    constant_m_s: float | None = optional("m/s", 0.3, 4.0, "one speed for all cuts, in place of a program", 1.7)
    lowest_m_s: float = setting(
        1.0, "m/s", 0.3, 4.0, "lowest step of the hump signal", f"{JUDGEMENT}: slower humping is not worth it"
    )
    highest_m_s: float = setting(
        3.4, "m/s", 0.3, 4.0, "highest step of the hump signal", f"{JUDGEMENT}: what the first switch allows"
    )
    step_m_s: float = setting(
        0.1, "m/s", 0.02, 1.0, "from step to step", f"{JUDGEMENT}: remote control of the locomotive; signals have fewer"
    )
    uncoupling_m_s: float = setting(
        3.4, "m/s", 0.3, 4.0, "fastest at which cuts are uncoupled; faster steps are left out",
        f"{JUDGEMENT}: no limit; by hand 2.5 or so",
    )  # fmt: skip
    acceleration_m_s2: float = setting(
        0.05, "m/s2", 0.005, 1.0, "of the locomotive with its train, either way", f"{JUDGEMENT}: 0.02 to 0.1 are usual"
    )
    method: Literal["whole-train", "pair-by-pair"] = choice(
        "whole-train", "soonest over the crest with all its cuts, or cut by cut"
    )
    least_s: float = setting(
        0.5, "s", -5.0, 20.0, "interval that the cut behind keeps at the worst element", f"{JUDGEMENT}: found by trial"
    )
    early_s: float = setting(
        0.2, "s", -5.0, 20.0, "of it, what a cut keeps where those behind wait for it", f"{JUDGEMENT}: found by trial"
    )
    worst_pair: bool = choice(False, "intervals of a bad runner ahead of a good one; false: of two mean ones")
    slow_down_s: float | None = optional(
        "s", -5.0, 20.0,
        "with feedback, the train is slowed down for a cut that would come closer than this; left out: never", 0.0,
    )  # fmt: skip

    @model_validator(mode="after")
    def _low_before_high(self) -> HumpSpeedSettings:
        require(
            self.lowest_m_s <= min(self.highest_m_s, self.uncoupling_m_s),
            f"lowest_m_s is {self.lowest_m_s:g}; it must not be above highest_m_s, {self.highest_m_s:g}, nor "
            f"uncoupling_m_s, {self.uncoupling_m_s:g}",
        )
        return self


class ExitSpeedSettings(Section):
    """How the exit speeds of positions that keep cuts apart are chosen."""

    feedback: bool = choice(True, "chosen when a cut comes; false: planned before the train")
    knowledge: KNOWN = choice(
        "category", "resistance that cuts are expected to have: of their weight category, or as measured on the way"
    )
    choices: int = setting(7, "1", 2, 30, "exit speeds that are compared in each position")
    usable_share: float = setting(
        0.85, "1", 0.1, 1.0, "of the full brake of each position, what the control counts upon",
        f"{JUDGEMENT}: friction one standard deviation of 0.15 below its mean",
    )  # fmt: skip


class TrialAimSettings(Section):
    """Exit speeds of positions that aim at the standing cars: chosen for the trial, or from exported tables.

    Tables given here count before those of the hump file.
    """

    MEANT: ClassVar = {"coupling_speed_m_s": "couplings.allowed_m_s"}

    knowledge: KNOWN = choice(
        "category", "what they are chosen by beside the free distance: weight category, or resistance as it is measured"
    )
    tables: str | None = choice(
        None,
        "in place of the numbers, aim tables (retarder-synth aim) for all tracks: a file or a directory",
        "out/aim",
    )
    tables_of: dict[str, str] | None = choice(
        None, "or those behind single retarders, by number", {"421": "out/aim-1", "422": "out/aim-2"}
    )
    p_overspeed: float = setting(
        0.1, "1", 0.005, 0.9, "required probability of a coupling above couplings.allowed_m_s",
        "[kozachenko-aimed]: the share that its figures are drawn for",
    )  # fmt: skip
    lowest_m_s: float = setting(
        0.5, "m/s", 0.1, 7.0, "lowest exit speed", f"{JUDGEMENT}: slower cuts would block the position"
    )
    highest_m_s: float = setting(7.0, "m/s", 0.5, 10.0, "highest exit speed", f"{JUDGEMENT}: no limit")
    design_cuts: int = setting(2000, "1", 200, 200_000, "drawn cuts that exit speeds are chosen on")

    @model_validator(mode="after")
    def _low_before_high(self) -> TrialAimSettings:
        require(
            self.lowest_m_s <= self.highest_m_s,
            f"lowest_m_s is {self.lowest_m_s:g}; it must not be above highest_m_s, {self.highest_m_s:g}",
        )
        return self


class SensorSettings(Section):
    """What is measured of cuts; where nothing is, it counts nothing."""

    speed_std_m_s: float = setting(
        0.1, "m/s", 1e-4, 2.0, "error of each speed at the entrance and the exit of a position",
        f"{JUDGEMENT}: 0.02 to 0.1 are usual",
    )  # fmt: skip


OVERSPEEDS_PER_ASKED = 1.5
"""Over-speeds that a trial may have unless told, for each that its aim is asked to keep to."""


class TrialAcceptanceSettings(Section):
    """Shares of cuts that must not be passed, interval included; exit code 1 if one is. A limit of 1 judges nothing."""

    catch_ups: float = setting(
        0.005, "1", 0.0, 1.0, "of all cuts: those that catch up",
        f"{JUDGEMENT}: with more than one cut in 200 on a wrong track, or run into, a plan has failed",
    )  # fmt: skip
    overspeed: float | None = optional(
        "1", 0.0, 1.0,
        "of the cuts on their track: couplings faster than allowed; left out: 1.5 times aim.p_overspeed", 0.15,
        f"{JUDGEMENT}: half as many again as the aim is asked for, since a cut may meet cars that still roll",
    )  # fmt: skip
    overspeed_harmful: float | None = optional("1", 0.0, 1.0, "of these: harmful couplings", 0.002)


class HumpTrialSettings(TopKeys):
    """A whole hump trial configuration; an empty one is the built-in default."""

    MEANT: ClassVar = dict.fromkeys(("exit_speed_m_s", "exit_m_s", "exit_speed"), "position.exit_m_s")

    hump: str = choice(
        DEFAULT_HUMP,
        f"the hump; one of {', '.join(hump_names())}, or the path of your own file (docs/reference/hump-file.md)",
    )
    lead: int | None = choice(
        None, "signal at the crest that trains come over; left out: the first of the hump file", 201
    )
    trains: TrainSettings = TrainSettings()
    cars: MixSettings = MixSettings()
    weather: WeatherSettings = WeatherSettings()
    resistance: ResistanceSettings = ResistanceSettings()
    tracks: TracksSettings = TracksSettings()
    hump_speed: HumpSpeedSettings = HumpSpeedSettings()
    exit_speeds: ExitSpeedSettings = ExitSpeedSettings()
    aim: TrialAimSettings = TrialAimSettings()
    couplings: CouplingLimits = CouplingLimits()
    sensors: SensorSettings = SensorSettings()
    position: tuple[HumpPositionSettings, ...] = many(
        (),
        0,
        10,
        "tables [[position]]",
        example=(HumpPositionSettings(number=2, exit_m_s={"all": 4.8}, supply_share=0.8),),
    )
    acceptance: TrialAcceptanceSettings = TrialAcceptanceSettings()
    design: DesignSettings = DesignSettings()
    output: OutputSettings = OutputSettings()

    @model_validator(mode="after")
    def _slowed_down_with_feedback(self) -> HumpTrialSettings:
        slow = self.hump_speed.slow_down_s
        if slow is not None and not self.exit_speeds.feedback:
            raise PlantError(
                f"hump_speed.slow_down_s is {slow:g}, but exit_speeds.feedback is false, and without feedback nobody "
                "sees that a cut comes too close: take one of the two out"
            )
        return self
