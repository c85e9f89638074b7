"""A commented hump trial configuration to start from: every default written out with its unit, range and origin."""

from __future__ import annotations

from collections.abc import Iterator

from plant_models.library import BUILT_IN, CAR_MIXES, WEIGHT_CATEGORIES, YARD_CATEGORIES
from plant_models.library.car_mix_entry import load_car_mix
from plant_models.library.hump_entry import hump_names, load_hump
from plant_models.library.sourced_value import JUDGEMENT
from plant_models.library.type_file import Kind
from synth.aim.configuration.settings import ResistanceSettings, WeatherSettings
from synth.aim.configuration.template import setting_lines, value_lines
from synth.frame.settings.output import OutputSettings
from synth.hump.configuration.settings import (
    CATEGORY_SHARES,
    DEFAULT_HUMP,
    EXIT_RANGE_M_S,
    ExitSpeedSettings,
    HumpSpeedSettings,
    SensorSettings,
    TracksSettings,
    TrainSettings,
    TrialAimSettings,
)
from synth.retarder.configuration.config_template import quoted, source_lines, switch_lines

HEAD = """\
# Hump trial of retarder-synth (retarder-synth hump simulate). Every line shows its default and may be left out.
# A comment says: unit; sensible range (limits, for settings of the tool); origin. Sources stand at the end.
# ASSUMED: no citable source stands behind the number; replace it by that of your yard."""


def default_trial_toml() -> str:
    """The defaults as TOML; it reads back to the same hump trial."""
    text = tuple(lines())
    return "\n".join((*text, *source_lines(text))) + "\n"


def lines() -> Iterator[str]:
    """The lines of the file."""
    yield HEAD
    yield from (f"# Note: {note}" for note in load_hump(DEFAULT_HUMP).notes)
    yield '# title = "…"'
    yield '# Your own types (docs/own-types.md) are found in folders: library = ["my-types/"]'
    yield f"# one of the library: {names(WEIGHT_CATEGORIES)}; or the path of your own file"
    yield f"weight_categories = {quoted(YARD_CATEGORIES)}"
    yield f"# one of the library: {', '.join(hump_names())}; or the path of your own hump file (docs/hump-file.md)"
    yield f"hump = {quoted(DEFAULT_HUMP)}"
    yield "# signal at the crest that trains come over; by default the first of the hump file: lead = 201"
    yield from train_lines()
    yield from ("", "[cars]", f"# one of the library: {names(CAR_MIXES)}; or the path of your own file")
    mix = load_car_mix(BUILT_IN.names(CAR_MIXES)[0])
    yield f"mix = {quoted(mix.name)}"
    values = {value.key: value for value in mix.provenance}
    for key in ("following_share", "underload_mean_t"):
        yield from value_lines(values[key])
    yield from ("", "[weather]", *setting_lines("weather", WeatherSettings()))
    yield from (
        "",
        "[resistance]",
        '# "hump-norm": gamma law by weight category, or "tb-10062": normal law by mass and',
    )
    yield from ("# temperature, from the Chinese norm", 'law = "hump-norm"')
    yield from setting_lines("resistance", ResistanceSettings())
    yield from ("", "[tracks]", '# "drawn" anew for each train, or as the hump "file" tells (standing_m)')
    yield from ('standing = "drawn"', *setting_lines("tracks", TracksSettings()))
    yield from hump_speed_lines()
    yield from exit_speed_lines()
    yield from ("", "[aim]", "# exit speeds of the last position, chosen for the free distance of each cut by its")
    yield from ('# weight "category", or by its resistance as it is "measured" besides', 'knowledge = "category"')
    yield from setting_lines("aim", TrialAimSettings())
    yield "# or, in place of these numbers, aim tables (retarder-synth aim), a file or a directory: for all tracks, or"
    yield "# those behind single retarders (docs/hump-trials.md):"
    yield '# tables = "out/aim"'
    yield '# tables_of = { 421 = "out/aim-1", 422 = "out/aim-2" }'
    yield from ("", "[sensors]", "# of what is measured; where nothing is, it counts nothing")
    yield from setting_lines("sensors", SensorSettings())
    yield from position_lines()
    yield from ("", "[output]", *switch_lines(OutputSettings))


def names(kind: Kind) -> str:
    """Names of the library's types of a kind."""
    return ", ".join(BUILT_IN.names(kind))


def train_lines() -> Iterator[str]:
    """[trains]."""
    yield from ("", "[trains]", *setting_lines("trains", TrainSettings()))
    yield "# one draw of the wind a train, or one a cut"
    yield "one_wind_a_train = false"
    yield "# shares by weight category, which count by their ratio"
    yield f"# 1; ASSUMED, {JUDGEMENT}: most cars are empty or full"
    shares = ", ".join(f"{name} = {share!r}" for name, share in CATEGORY_SHARES.items())
    yield f"category_shares = {{ {shares} }}"
    yield "# shares by track; by default all alike: track_shares = { 1 = 2.0, 2 = 1.0 }"
    yield "# or, in place of cuts, cars and shares, one sorting list again and again (docs/hump-trials.md):"
    yield '# list = "train.csv"'


def hump_speed_lines() -> Iterator[str]:
    """[hump_speed]."""
    yield from ("", "[hump_speed]", "# one speed for all cuts, in place of a program: constant_m_s = 1.7")
    yield '# "whole-train": soonest over the crest, or "pair-by-pair"'
    yield 'method = "whole-train"'
    yield "# intervals of a bad runner ahead of a good one, not of two mean ones"
    yield "worst_pair = false"
    yield from setting_lines("hump_speed", HumpSpeedSettings())
    yield "# s; with feedback, the train is slowed down for a cut that would come closer than this; left out: never"
    yield "# slow_down_s = 0.0"


def exit_speed_lines() -> Iterator[str]:
    """[exit_speeds]."""
    low, high = EXIT_RANGE_M_S
    positions = 2
    yield from (
        "",
        "[exit_speeds]",
        "# of all positions but the last: chosen when a cut comes, or planned before the train",
    )
    yield "feedback = true"
    yield '# resistance that cuts are expected to have: of their "category", or as "measured" on the way'
    yield 'knowledge = "category"'
    origin = f"# m/s; ASSUMED, {JUDGEMENT}: {low:g} to {high:g} m/s are usual of bunch positions"
    yield "# lists with a number for each position but the last"
    yield from (origin, f"lowest_m_s = {[low] * positions}")
    yield from (origin, f"highest_m_s = {[high] * positions}")
    yield "# m/s; fastest that cuts may come to these positions; by default there is no limit"
    yield "# most_entry_m_s = [7.5, 7.5]"
    yield from setting_lines("exit_speeds", ExitSpeedSettings())


def position_lines() -> Iterator[str]:
    """[[position]] and [acceptance], which have no default."""
    yield from ("", "# What is otherwise than the hump file tells; 1 is the first position behind the crest.")
    yield "# [[position]]"
    yield "# number = 2"
    yield "# exit_std_m_s = 0.35     # m/s; standard deviation of the exit speed about the commanded one; 0 to 1"
    yield '# tables = "out/book.h5"  # or, in its place, a book of controller tables, which runs in its closed loop'
    yield '# tables_config = "my.toml"  # the configuration that it was tuned with; left out: the built-in one'
    yield "# out_of_service = true    # brakes nothing"
    yield "# supply_share = 0.8       # of the full brake power, where the supply pressure is low"
    yield from ("", "# Shares of cuts that must not be passed, interval included; exit code 1 if one is.")
    yield from ("# [acceptance]", "# catch_ups = 0.001", "# overspeed = 0.1", "# overspeed_above_2 = 0.002")
