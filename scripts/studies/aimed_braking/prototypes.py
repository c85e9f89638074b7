"""What an independent prototype found, beside this program with the prototype's inputs and with those of the hump."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

from plant_models.rolling.car_mix import CarMix
from plant_models.rolling.roll_track import RollTrack
from plant_models.track_profile import TrackProfile
from scripts.studies.aiming.hump import weight_category, with_bends, with_mix, with_weather
from scripts.studies.aiming.places import FreeDistance
from scripts.studies.aiming.trial import Cuts, Draws, Outcome, tried
from synth.aim.knowledge import ByCategory, ByReading, Knowledge
from synth.aim.position_models import NormalPosition
from synth.aim.readings import ResistanceByTwoSpeeds
from synth.aim.scene import AimScene, MeasuredStretch

EXIT_M = 340.0
"""Where the prototype's park position ends; it counts a cut as a point."""

AREA_M2 = 1.4 * 8.5


@dataclass(frozen=True)
class Beside:
    """Mean gap a car at one place: of the prototype (m, as printed), of this program with the prototype's inputs, and
    on the hump of the studies."""

    asked: str
    metres: float
    prototype_m: float
    same_inputs: Outcome | None
    hump: Outcome | None


@dataclass(frozen=True)
class Printed:
    """A row of the prototype's tables: category, cars, std of the exit speed and of the measured speeds in m/s (None:
    by category), and the gap a car in m by the distance from `origin_m`."""

    category: str
    cars: int
    exit_std_m_s: float
    measured_std_m_s: float | None
    gaps_m: dict[float, float]
    origin_m: float = 0.0

    @property
    def asked(self) -> str:
        """'light, 2 cars, σ 0.1' or 'measured, σ_v 0.03, σ 0.1'."""
        if self.origin_m > 0.0:
            name = {"L": "light", "T": "heavy"}[self.category]
            return f"{name}, {self.cars} car{'s' * (self.cars > 1)}, σ {self.exit_std_m_s:g}"
        known = "category" if self.measured_std_m_s is None else f"two speeds, σ_v {self.measured_std_m_s:g}"
        return f"{known}, σ {self.exit_std_m_s:g}"

    @property
    def knowledge(self) -> Knowledge:
        """What is known of a cut."""
        if self.measured_std_m_s is None:
            return ByCategory()
        return ByReading(ResistanceByTwoSpeeds(self.measured_std_m_s))


FROM_CREST = (
    Printed("L", 1, 0.1, None, {400.0: 2.0, 450.0: 18.0, 500.0: 43.0, 600.0: 112.0, 700.0: 183.0}, EXIT_M),
    Printed("L", 1, 0.2, None, {400.0: 4.0, 450.0: 19.0, 500.0: 46.0, 600.0: 111.0, 700.0: 183.0}, EXIT_M),
    Printed("L", 1, 0.4, None, {400.0: 9.0, 450.0: 29.0, 500.0: 57.0, 600.0: 119.0, 700.0: 197.0}, EXIT_M),
    Printed("T", 1, 0.1, None, {400.0: 0.1, 450.0: 3.4, 500.0: 16.0}, EXIT_M),
    *(Printed("L", n, 0.1, None, {600.0: gap}, EXIT_M) for n, gap in ((2, 34.0), (3, 17.0), (5, 6.6), (8, 2.5))),
)
"""Its first table, metres from the crest. It counts a cut as a point, so the free distances are compared."""

BEHIND_POSITION = (
    Printed("L", 1, 0.03, None, {100.0: 13.0, 200.0: 64.0, 300.0: 132.0}),
    Printed("L", 1, 0.1, None, {100.0: 12.0, 200.0: 65.0, 300.0: 136.0}),
    Printed("L", 1, 0.4, None, {100.0: 26.0, 200.0: 78.0, 300.0: 149.0}),
    Printed("L", 1, 0.03, 0.1, {100.0: 1.0, 200.0: 23.0, 300.0: 66.0}),
    Printed("L", 1, 0.1, 0.1, {100.0: 2.0, 200.0: 28.0, 300.0: 74.0}),
    Printed("L", 1, 0.4, 0.1, {100.0: 14.0, 200.0: 50.0, 300.0: 92.0}),
    Printed("L", 1, 0.03, 0.03, {100.0: 0.1, 200.0: 3.6, 300.0: 19.0}),
    Printed("L", 1, 0.1, 0.03, {100.0: 0.1, 200.0: 5.5, 300.0: 23.0}),
    Printed("L", 1, 0.4, 0.03, {100.0: 11.0, 200.0: 33.0, 300.0: 60.0}),
)
"""Its second table, metres behind the park position."""


def prototype_scene(hump: AimScene) -> AimScene:
    """The prototype's inputs: gondolas, wind N(0, 3) m/s, 1.5 then 1.0 permille, no bends, 110 m measured."""
    gondolas = with_mix(hump, CarMix((replace(hump.population.mix.cars[0], drag_area_m2=AREA_M2),)))
    straight = with_bends(with_weather(gondolas, head_wind_std_m_s=3.0), ())
    profile = TrackProfile((0.0, EXIT_M), (1.5, 1.0))
    stretch = MeasuredStretch(205.0, 315.0, 4.5, hump.stretch.speed_std_m_s)
    return replace(straight, track=RollTrack(profile, 1200.0), entrance_m=EXIT_M - 20.0, exit_m=EXIT_M, stretch=stretch)


def beside(hump: AimScene, rows: tuple[Printed, ...], p: float, draws: Draws) -> Iterator[Beside]:
    """Every printed figure of `rows` with ours."""
    scenes = prototype_scene(hump), hump
    for row in rows:
        places = FreeDistance(tuple(metres - row.origin_m for metres in row.gaps_m))
        position = NormalPosition(row.exit_std_m_s, only_brakes=False)
        ours = [
            tried(Cuts(s, weight_category(s, row.category), row.cars), places, position, row.knowledge, p, draws)
            for s in scenes
        ]
        for (metres, gap), same, on_hump in zip(row.gaps_m.items(), *ours, strict=True):
            yield Beside(row.asked, metres, gap, same, on_hump)
