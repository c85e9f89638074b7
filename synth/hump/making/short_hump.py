"""The short file of a hump: the facts of a yard's plan, metres from the crest; the same on the way to every track."""

from __future__ import annotations

from typing import Annotated, Final

from pydantic import Field

from plant_models.hump.ranges import (
    ENTRY_JOINT_M,
    EXIT_STD_M_S,
    FOULING_M,
    LENGTH_M,
    MOST_TRACKS,
    RELAY_S,
    SWITCH_EXIT_JOINT_M,
    THROW_S,
    TURN_DEG,
    Range,
)
from plant_models.library import BUILT_IN, POSITIONS
from plant_models.library.sourced_value import JUDGEMENT
from synth.frame.settings.numbers import Pairs, Title
from synth.frame.settings.section import OutputSettings, Section, choice, many, needed, optional, setting

PLACE_M: Final = Range(1.0, 3000.0)
"""From the crest."""

MOST_SWITCHES: Final = 16
"""On the way to a track."""

Place = Annotated[float, Field(ge=PLACE_M.low, le=PLACE_M.high)]
Bunch = Annotated[int, Field(ge=1, le=MOST_TRACKS)]


class ShortPosition(Section):
    """A retarder position; it stands on every track that there is at its place."""

    type: str = choice(..., f"position of the library: {', '.join(BUILT_IN.names(POSITIONS))}")
    from_m: float = needed("m", PLACE_M.low, PLACE_M.high, "its entrance, from the crest", "")
    to_m: float | None = optional("m", PLACE_M.low, PLACE_M.high, "its end; left out: it is as long as its type", 95.0)
    exit_std_m_s: float = setting(
        0.15, "m/s", EXIT_STD_M_S.low, EXIT_STD_M_S.high, "standard deviation of its exit speeds",
        f"{JUDGEMENT}: [hump-computer-1970s] asks 0.15 to 0.2 m/s",
    )  # fmt: skip
    margin_m: float = setting(
        1.0,
        "m",
        0.0,
        50.0,
        "how far its insulated section reaches beyond it on both sides",
        f"{JUDGEMENT}: 1 to 2 m are usual",
    )


class ShortHump(Section):
    """A hump with one crest; all metres but lengths count from the crest."""

    title: Title = choice("A hump", "title of the hump")
    tracks: int | None = optional("1", 1, MOST_TRACKS, "number of tracks; left out: those of the bunches", 16)
    bunches: tuple[Bunch, ...] | None = many(
        None, 1, MOST_TRACKS, "numbers of tracks",
        "tracks of each bunch, from the left; left out: all tracks part evenly", "1", "", [5, 6, 5],
    )  # fmt: skip
    profile_from_crest: Pairs = choice(
        ..., "profile: [metres from the crest, grade in permille from there on], positive where the track falls"
    )
    switches_m: tuple[Place, ...] = many(
        ..., 0, MOST_SWITCHES, "places",
        "points of the switches on the way to a track: first those that part the bunches, then those within them; at "
        "each place the tracks double", "m", "",
    )  # fmt: skip
    section_ahead_m: float = setting(
        6.0, "m", ENTRY_JOINT_M.low, ENTRY_JOINT_M.high, "insulated section of a switch, ahead of its points",
        f"{JUDGEMENT}: 7 m/s for 0.8 s, machine and relays, is 5.6 m",
    )  # fmt: skip
    section_behind_m: float = setting(
        5.0, "m", SWITCH_EXIT_JOINT_M.low, SWITCH_EXIT_JOINT_M.high, "the same behind its points",
        f"{JUDGEMENT}: sections of 11 to 12 m are usual",
    )  # fmt: skip
    throw_s: float = setting(
        0.6, "s", THROW_S.low, THROW_S.high, "time in which a machine throws the points",
        f"{JUDGEMENT}: 0.5 to 0.6 s are usual of fast hump machines, 0.8 s of older ones",
    )  # fmt: skip
    relay_s: float = setting(
        0.2, "s", RELAY_S.low, RELAY_S.high, "what passes before it starts", f"{JUDGEMENT}: 0.1 to 0.2 s are usual"
    )
    turn_deg: float = setting(
        4.73, "degrees", TURN_DEG.low, TURN_DEG.high, "how far each branch of a switch turns aside",
        f"{JUDGEMENT}: half the angle of a symmetrical turnout 1/6",
    )  # fmt: skip
    fouling_m: float = setting(
        26.0, "m", FOULING_M.low, FOULING_M.high, "fouling point, behind the points",
        f"{JUDGEMENT}: there the tracks are 4.3 m apart",
    )  # fmt: skip
    parallel_tracks: bool = choice(
        True, "a curve behind the last switch of a way turns back what its switches turned; false: there is none"
    )
    tracks_from_m: float = needed("m", PLACE_M.low, PLACE_M.high, "where the tracks begin", "")
    track_length_m: float = needed("m", LENGTH_M.low, LENGTH_M.high, "length of each track from there on", "")
    position: tuple[ShortPosition, ...] = many(
        (), 0, 10, "tables [[position]]", example=(ShortPosition(type="knp-5-bunch", from_m=68.0),)
    )
    output: OutputSettings = OutputSettings()

    @property
    def of_bunches(self) -> tuple[int, ...]:
        """Tracks of each bunch; one bunch where there are none."""
        return self.bunches or (self.tracks or 0,)


EXAMPLE: Final = ShortHump(
    title="Medium hump: 16 tracks, two positions ahead of them and one on each",
    tracks=16,
    profile_from_crest=((0, 45), (40, 22), (66, 12), (98, 10), (138, 8), (178, 1.5), (306, 0.8), (738, 0)),
    switches_m=(42, 112, 184, 214),
    tracks_from_m=306,
    track_length_m=632,
    position=(
        ShortPosition(type="knp-5-bunch", from_m=68.0),
        ShortPosition(type="knp-5-bunch", from_m=150.0),
        ShortPosition(type="rnz-2m-park", from_m=284.0, margin_m=2.0),
    ),
)
"""The hump `medium` of the library."""
