"""What a hump trial configuration may contain: one frozen model a section, units in the key names."""

from __future__ import annotations

from typing import Literal

from plant_models.library import YARD_CATEGORIES
from plant_models.library.sourced_value import JUDGEMENT
from synth.aim.configuration.settings import DEFAULT_MIX, ResistanceSettings, WeatherSettings
from synth.frame.settings.output import OutputSettings
from synth.frame.settings.section import Section, many, setting
from synth.frame.settings.value_forms import Title
from synth.hump.configuration.counted_trains import CountedTrains

DEFAULT_HUMP = "large"

CATEGORY_SHARES = {"L": 0.3, "LS": 0.1, "S": 0.2, "ST": 0.1, "T": 0.3}
"""Of the library's weight categories, where a file gives none: assumed, most cars are empty or full."""

EXIT_RANGE_M_S = (4.0, 7.0)
"""Exit speeds of a position for intervals, where a file gives none: assumed."""

KNOWN = Literal["category", "measured"]


class TrainSettings(CountedTrains):
    """Trains of a population, or one sorting list again and again (`list`). Shares count by their ratio."""

    one_wind_a_train: bool = False
    list: str | None = None
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
    category_shares: dict[str, float] | None = many(None, 1, 31, "shares, {L = 0.3, T = 0.7}", strict=True)
    track_shares: dict[str, float] | None = many(None, 1, 199, "shares, {1 = 2.0, 2 = 1.0}", strict=True)


class CarsSettings(Section):
    """The mix of cars; a number of it is replaced where it is set."""

    mix: str = DEFAULT_MIX
    following_share: float | None = None
    underload_mean_t: float | None = None


class TracksSettings(Section):
    """Where cars stand before each train: drawn, or as the hump file tells (`standing_m`)."""

    standing: Literal["drawn", "file"] = "drawn"
    free_low: float = setting(
        0.2, "1", 0.0, 1.0, "least free share of a track, of its length behind the last position",
        f"{JUDGEMENT}: nothing was found on how full tracks are",
    )  # fmt: skip
    free_high: float = setting(
        0.9, "1", 0.0, 1.0, "largest free share; all between are equally frequent",
        f"{JUDGEMENT}: nothing was found on how full tracks are",
    )  # fmt: skip


class HumpSpeedSettings(Section):
    """A program of speeds from simulated pairs of cuts, or one speed for all (`constant_m_s`).

    `slow_down_s`: with feedback, the train is slowed down for a cut that would come closer than this; None: never.
    """

    constant_m_s: float | None = None
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
    method: Literal["whole-train", "pair-by-pair"] = "whole-train"
    least_s: float = setting(
        0.5, "s", -5.0, 20.0, "interval that the cut behind keeps at the worst element", f"{JUDGEMENT}: found by trial"
    )
    early_s: float = setting(
        0.2, "s", -5.0, 20.0, "of it, what a cut keeps where those behind wait for it", f"{JUDGEMENT}: found by trial"
    )
    worst_pair: bool = False
    slow_down_s: float | None = None


class ExitSpeedSettings(Section):
    """Exit speeds of all positions but the last: chosen when a cut comes (`feedback`), or planned before the train.

    A list has a number for each of these positions, from the crest on; None: `EXIT_RANGE_M_S`, and no limit of entry.
    """

    feedback: bool = True
    knowledge: KNOWN = "category"
    lowest_m_s: tuple[float, ...] | None = many(None, 0, 10, "speeds")
    highest_m_s: tuple[float, ...] | None = many(None, 0, 10, "speeds")
    most_entry_m_s: tuple[float, ...] | None = many(None, 0, 10, "speeds")
    choices: int = setting(7, "1", 2, 30, "exit speeds that are compared in each position")
    usable_share: float = setting(
        0.85, "1", 0.1, 1.0, "of the full brake of each position, what the control counts upon",
        f"{JUDGEMENT}: friction one standard deviation of 0.15 below its mean",
    )  # fmt: skip


class TrialAimSettings(Section):
    """Exit speeds of the last position, which aim at the standing cars: chosen for the trial, or from exported tables.

    `tables`: a file or directory of aim tables for all routes; `tables_of`: for retarders, by number. Both count before
    those of the hump file.
    """

    knowledge: KNOWN = "category"
    tables: str | None = None
    tables_of: dict[str, str] | None = None
    p_overspeed: float = setting(
        0.1, "1", 0.005, 0.9, "required probability of a coupling above 1.39 m/s (5 km/h)",
        "[kozachenko-aimed]: the share that its figures are drawn for",
    )  # fmt: skip
    lowest_m_s: float = setting(
        0.5, "m/s", 0.1, 7.0, "lowest exit speed", f"{JUDGEMENT}: slower cuts would block the position"
    )
    highest_m_s: float = setting(7.0, "m/s", 0.5, 10.0, "highest exit speed", f"{JUDGEMENT}: no limit")
    design_cuts: int = setting(2000, "1", 200, 200_000, "drawn cuts that exit speeds are chosen on")


class SensorSettings(Section):
    """What is measured of cuts, where something is `measured`."""

    speed_std_m_s: float = setting(
        0.1, "m/s", 1e-4, 2.0, "error of each speed at the entrance and the exit of a position",
        f"{JUDGEMENT}: 0.02 to 0.1 are usual",
    )  # fmt: skip


class HumpPositionSettings(Section):
    """What is otherwise than the hump file tells, of the position `number`, 1 being the first behind the crest.

    `tables`: a book of controller tables, tuned with `tables_config`. `supply_share`: of the full brake power.
    """

    number: int
    exit_std_m_s: float | None = None
    tables: str | None = None
    tables_config: str | None = None
    out_of_service: bool = False
    supply_share: float | None = None


class TrialAcceptanceSettings(Section):
    """Shares of cuts that must not be passed, interval included; exit code 1 if one is. None: no limit."""

    catch_ups: float | None = None
    overspeed: float | None = None
    overspeed_above_2: float | None = None


class HumpTrialSettings(Section):
    """A whole hump trial configuration; an empty one is the built-in default."""

    title: Title | None = None
    library: tuple[str, ...] = many((), 0, 20, "folders")
    weight_categories: str = YARD_CATEGORIES
    hump: str = DEFAULT_HUMP
    lead: int | None = None
    trains: TrainSettings = TrainSettings()
    cars: CarsSettings = CarsSettings()
    weather: WeatherSettings = WeatherSettings()
    resistance: ResistanceSettings = ResistanceSettings()
    tracks: TracksSettings = TracksSettings()
    hump_speed: HumpSpeedSettings = HumpSpeedSettings()
    exit_speeds: ExitSpeedSettings = ExitSpeedSettings()
    aim: TrialAimSettings = TrialAimSettings()
    sensors: SensorSettings = SensorSettings()
    position: tuple[HumpPositionSettings, ...] = many((), 0, 10, "tables [[position]]")
    acceptance: TrialAcceptanceSettings = TrialAcceptanceSettings()
    output: OutputSettings = OutputSettings()
