"""What an aim configuration may contain: one frozen model a section, units in the key names.

Values that stand in the library (track, position, stretch, mix of cars) are replaced only by keys that a file sets;
elements and bends of the track stand in place of those of the library.
"""

from __future__ import annotations

from itertools import pairwise
from typing import Annotated, Literal

from pydantic import Field, model_validator

from plant_models.errors import require
from plant_models.library import POSITIONS, TRACKS
from plant_models.library.sourced_value import JUDGEMENT
from synth.aim.configuration.shared_settings import MixSettings
from synth.aim.configuration.simulation_settings import SimulationSettings
from synth.frame.settings.section import (
    TOOL_DEFAULT,
    OutputSettings,
    Section,
    choice,
    many,
    needed,
    of_library,
    setting,
)
from synth.retarder.configuration.own_types import TopKeys, named_type

DEFAULT_TRACK = "large-hump"
MOST_PIECES = 200
"""Elements, or bends, of a track."""

LONGEST_M = 1e5
"""Of a track."""


class ElementSettings(Section):
    """A piece of the track with one grade."""

    from_m: float = needed("m", 0.0, LONGEST_M, "where it begins, from the crest")
    to_m: float = needed("m", 0.0, LONGEST_M, "where it ends")
    grade_permille: float = needed("permille", -60.0, 60.0, "downhill positive")


class BendSettings(Section):
    """Switches and degrees of turn within a piece of the track."""

    from_m: float = needed("m", 0.0, LONGEST_M, "where it begins, from the crest")
    to_m: float = needed("m", 0.0, LONGEST_M, "where it ends")
    switches: int = setting(0, "1", 0, 20, "switches in it")
    turn_deg: float = setting(0.0, "degrees", 0.0, 360.0, "turn of its curves")


class AimTrackSettings(Section):
    """The track from the crest on; elements and bends, where given, stand in place of its own."""

    name: str = named_type(DEFAULT_TRACK, TRACKS, "the track")
    elements: tuple[ElementSettings, ...] | None = many(
        None,
        1,
        MOST_PIECES,
        "tables {from_m = …, to_m = …, grade_permille = …}",
        "pieces of one grade each, metres from the crest, downhill positive",
    )
    bends: tuple[BendSettings, ...] | None = many(
        None,
        0,
        MOST_PIECES,
        "tables {from_m = …, to_m = …, switches = …, turn_deg = …}",
        "pieces with switches or curves; [] for none",
    )

    @model_validator(mode="after")
    def _pieces_in_order(self) -> AimTrackSettings:
        require_elements(self.elements or ())
        require_bends(self.bends or ())
        return self


def require_elements(elements: tuple[ElementSettings, ...]) -> None:
    """`PlantError` where there is a gap, an overlap or no length."""
    for place, element in enumerate(elements):
        require(
            place > 0 or element.from_m == 0.0,
            f"elements[0].from_m is {element.from_m:g}; the track begins at the crest: set it to 0",
        )
        require(
            element.to_m > element.from_m,
            f"elements[{place}].to_m is {element.to_m:g}; it must be more than its from_m, {element.from_m:g}",
        )
    for place, (ahead, behind) in enumerate(pairwise(elements), start=1):
        require(
            behind.from_m == ahead.to_m,
            f"elements[{place}].from_m is {behind.from_m:g}, but the element before ends at {ahead.to_m:g} m; "
            f"elements must follow one another without gap and overlap: set it to {ahead.to_m:g}",
        )


def require_bends(bends: tuple[BendSettings, ...]) -> None:
    """`PlantError` where one has no length or two overlap."""
    for place, bend in enumerate(bends):
        require(
            bend.from_m < bend.to_m,
            f"bends[{place}] is from {bend.from_m:g} to {bend.to_m:g} m; it must have a length",
        )
    for place, (ahead, behind) in enumerate(pairwise(bends), start=1):
        require(
            behind.from_m >= ahead.to_m,
            f"bends[{place}].from_m is {behind.from_m:g}, but the bend before ends at {ahead.to_m:g} m; list them in "
            "order, without overlap",
        )


Count = Annotated[int, Field(ge=1, le=60)]
"""A number of cars."""

MOST_TABLES = 64
"""Numbers of cars of an aim table."""


class AimPositionSettings(Section):
    """The park position of the track."""

    name: str | None = named_type(None, POSITIONS, "the park position")
    entrance_m: float | None = of_library("its entrance, from the crest")
    exit_m: float | None = of_library("its exit; cuts are let go when their last axle is there")


class StretchSettings(Section):
    """Where cuts roll freely between the bunch position and the park position, and are measured."""

    from_m: float | None = of_library("where it begins, from the crest")
    to_m: float | None = of_library("where it ends")
    speed_mean_m_s: float | None = of_library("mean speed of cuts where it begins")
    speed_std_m_s: float | None = of_library("its standard deviation: the error of the bunch position")


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

    law: Literal["hump-norm", "tb-10062"] = choice(
        "hump-norm",
        "gamma law by weight category, or, from the Chinese norm, normal law by mass and temperature",
    )
    erlang_order: int = setting(
        3, "1", 1, 50, "order of the Erlang law of switches and curves; of hump-norm alone",
        f"{JUDGEMENT}: [kozachenko-aimed] has the law; its order was found nowhere",
    )  # fmt: skip


class CutsSettings(MixSettings):
    """Which cuts tables are made for."""

    categories: tuple[str, ...] | None = many(None, 1, 31, "weight categories", "weight categories that get tables")
    cars: tuple[Count, ...] = many(
        (1, 2, 3, 5, 8, 15), 1, MOST_TABLES, "numbers of cars", "numbers of cars in a cut, rising", "1", TOOL_DEFAULT
    )

    @model_validator(mode="after")
    def _cars_rise(self) -> CutsSettings:
        for place, (before, count) in enumerate(pairwise(self.cars), start=1):
            require(
                count > before, f"cars[{place}] is {count} after {before}; give the numbers of cars in increasing order"
            )
        return self


class AimedSettings(Section):
    """What is required, and what the control knows."""

    p_overspeed: float = setting(
        0.1, "1", 0.005, 0.9, "required probability of a coupling above coupling_speed_m_s",
        "[kozachenko-aimed]: the share that its figures are drawn for",
    )  # fmt: skip
    coupling_speed_m_s: float = setting(
        1.39, "m/s", 0.1, 5.0, "highest speed at which cars may couple", "[braking-position]: 5 km/h"
    )
    free_distances_m: tuple[float, ...] = many(
        (20.0, 50.0, 100.0, 150.0, 200.0, 250.0, 300.0, 400.0), 1, 100, "distances",
        "what the head of a cut has still to roll when its last axle leaves the position, rising", "m", TOOL_DEFAULT,
    )  # fmt: skip
    knowledge: tuple[Literal["category", "measured"], ...] = many(
        ("category", "measured"), 1, 2, "of 'category' and 'measured'",
        "what is known of a cut beside its cars: its weight category, or besides its resistance",
    )  # fmt: skip
    speed_std_m_s: float = setting(
        0.03, "m/s", 1e-4, 1.0, "error of each speed that is measured at the ends of the stretch",
        f"{JUDGEMENT}: point sensors; 0.02 to 0.1 are usual",
    )  # fmt: skip
    exit_std_m_s: float = setting(
        0.1, "m/s", 0.0, 2.0, "standard deviation of the exit speed about the commanded one",
        f"{JUDGEMENT}: [hump-computer-1970s] asks for 0.15, tables of this tool have less",
    )  # fmt: skip
    tables: str | None = choice(
        None, "in its place, controller tables of the position (a file, a book or a folder): closed loops say how "
        "exact they are",
        "out",
    )  # fmt: skip
    tables_config: str | None = choice(
        None, "the configuration that it was tuned with; left out: the built-in one", "my.toml"
    )

    @model_validator(mode="after")
    def _one_word_on_the_position(self) -> AimedSettings:
        require(
            self.tables is None or "exit_std_m_s" not in self.model_fields_set,
            f"exit_std_m_s is {self.exit_std_m_s} and aim.tables is {self.tables!r}; both say how exactly the position "
            "works: leave out one of the two",
        )
        require(
            self.tables is not None or self.tables_config is None,
            f"tables_config is {self.tables_config!r}, but aim.tables names no book; add it",
        )
        return self

    @model_validator(mode="after")
    def _distances_rise(self) -> AimedSettings:
        for place, distance in enumerate(self.free_distances_m):
            require(
                distance > 0.0,
                f"free_distances_m[{place}] is {distance:g}; it must be more than 0, for it is what the head of the "
                "cut has still to roll when its last axle leaves the position",
            )
        for place, (before, distance) in enumerate(pairwise(self.free_distances_m), start=1):
            require(
                distance > before,
                f"free_distances_m[{place}] is {distance:g} after {before:g}; give them in increasing order",
            )
        return self


class AimAcceptanceSettings(Section):
    """The limit that the tables must keep; exit code 1 if one does not."""

    p_excess: float = setting(
        0.01, "1", 0.0, 1.0, "a cell misses where its probability is above p_overspeed + this, interval included"
    )


class AimFileSettings(TopKeys):
    """A whole aim configuration; an empty one is the built-in default."""

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
