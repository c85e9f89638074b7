"""What an aim configuration may contain: one frozen model a section, units in the key names.

Values that stand in the library (track, position, stretch, mix of cars) are replaced only by keys that a file sets.
"""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from plant_models.library import YARD_CATEGORIES
from plant_models.library.sourced_value import JUDGEMENT
from synth.aim.configuration.simulation_settings import SimulationSettings
from synth.frame.settings.output import OutputSettings
from synth.frame.settings.section import Section, many, setting
from synth.frame.settings.value_forms import Title

DEFAULT_TRACK = "large-hump"
DEFAULT_MIX = "usual"
MOST_PIECES = 200
"""Elements, or bends, of a track."""

MOST_TABLES = 64
"""Numbers of cars of an aim table."""


class ElementSettings(Section):
    """A piece of the track with one grade, downhill positive; metres from the crest."""

    from_m: float
    to_m: float
    grade_permille: float = Field(ge=-60.0, le=60.0)


class BendSettings(Section):
    """Switches and degrees of turn within a piece of the track; metres from the crest."""

    from_m: float
    to_m: float
    switches: int = Field(0, ge=0, le=20)
    turn_deg: float = Field(0.0, ge=0.0, le=360.0)


class AimTrackSettings(Section):
    """A track of the library; `elements` and `bends`, where given, stand in place of its own."""

    name: str = DEFAULT_TRACK
    elements: tuple[ElementSettings, ...] | None = many(
        None, 1, MOST_PIECES, "tables {from_m = …, to_m = …, grade_permille = …}"
    )
    bends: tuple[BendSettings, ...] | None = many(
        None, 0, MOST_PIECES, "tables {from_m = …, to_m = …, switches = …, turn_deg = …}"
    )


class AimPositionSettings(Section):
    """Replaces values of the track's park position."""

    name: str | None = None
    entrance_m: float | None = None
    exit_m: float | None = None


class StretchSettings(Section):
    """Replaces values of the track's measured stretch."""

    from_m: float | None = None
    to_m: float | None = None
    speed_mean_m_s: float | None = None
    speed_std_m_s: float | None = None


class WeatherSettings(Section):
    """Weather on the hump."""

    temperature_c: float = setting(10.0, "degrees C", -60.0, 60.0, "air temperature", f"{JUDGEMENT}: a mild day")
    head_wind_mean_m_s: float = setting(
        0.0,
        "m/s",
        -30.0,
        30.0,
        "mean wind along the track, positive against the cut",
        f"{JUDGEMENT}: no wind rose is known",
    )
    head_wind_std_m_s: float = setting(
        3.0, "m/s", 0.0, 15.0, "its standard deviation, one draw a cut",
        f"{JUDGEMENT}: [kozachenko-aimed] has the normal law and no figures",
    )  # fmt: skip
    snow_n_per_kn: float = setting(
        0.0, "N/kN", 0.0, 10.0, "more resistance by snow and frost behind the position",
        f"{JUDGEMENT}: none; 0.2 to 0.6 in frost",
    )  # fmt: skip


class ResistanceSettings(Section):
    """The norm that basic resistance and bends follow."""

    law: Literal["hump-norm", "tb-10062"] = "hump-norm"
    erlang_order: int = setting(
        3, "1", 1, 50, "order of the Erlang law of switches and curves; of hump-norm alone",
        f"{JUDGEMENT}: [kozachenko-aimed] has the law; its order was found nowhere",
    )  # fmt: skip


class CutsSettings(Section):
    """Which cuts tables are made for; a number of the mix is replaced where it is set. No categories: all of them."""

    mix: str = DEFAULT_MIX
    following_share: float | None = None
    underload_mean_t: float | None = None
    categories: tuple[str, ...] | None = many(None, 1, 31, "weight categories")
    cars: tuple[int, ...] = many((1, 2, 3, 5, 8, 15), 1, MOST_TABLES, "numbers of cars")


class AimedSettings(Section):
    """What is required, and what the control knows.

    In place of `exit_std_m_s`: `tables`, a book of the position's controller tables, and `tables_config`, the
    configuration that it was tuned with.
    """

    p_overspeed: float = setting(
        0.1, "1", 0.005, 0.9, "required probability of a coupling above coupling_speed_m_s",
        "[kozachenko-aimed]: the share that its figures are drawn for",
    )  # fmt: skip
    coupling_speed_m_s: float = setting(
        1.39, "m/s", 0.1, 5.0, "highest speed at which cars may couple", "[braking-position]: 5 km/h"
    )
    free_distances_m: tuple[float, ...] = many(
        (20.0, 50.0, 100.0, 150.0, 200.0, 250.0, 300.0, 400.0), 1, 100, "distances"
    )
    knowledge: tuple[Literal["category", "measured"], ...] = many(
        ("category", "measured"), 1, 2, "of 'category' and 'measured'"
    )
    speed_std_m_s: float = setting(
        0.03, "m/s", 1e-4, 1.0, "error of each speed that is measured at the ends of the stretch",
        f"{JUDGEMENT}: point sensors; 0.02 to 0.1 are usual",
    )  # fmt: skip
    exit_std_m_s: float | None = None
    tables: str | None = None
    tables_config: str | None = None


class AimAcceptanceSettings(Section):
    """The limit that the tables must keep; exit code 1 if one does not."""

    p_excess: float = setting(
        0.01, "1", 0.0, 1.0, "a cell misses where its probability is above p_overspeed + this, interval included"
    )


class AimFileSettings(Section):
    """A whole aim configuration; an empty one is the built-in default."""

    title: Title | None = None
    library: tuple[str, ...] = many((), 0, 20, "folders")
    weight_categories: str = YARD_CATEGORIES
    track: AimTrackSettings = AimTrackSettings()
    position: AimPositionSettings = AimPositionSettings()
    stretch: StretchSettings = StretchSettings()
    weather: WeatherSettings = WeatherSettings()
    resistance: ResistanceSettings = ResistanceSettings()
    cuts: CutsSettings = CutsSettings()
    aim: AimedSettings = AimedSettings()
    simulation: SimulationSettings = SimulationSettings()
    acceptance: AimAcceptanceSettings = AimAcceptanceSettings()
    output: OutputSettings = OutputSettings()
