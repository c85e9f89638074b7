"""What limits an aim by measured resistance: bends and wind in the measured stretch, its length, the sensors."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

from plant_models.frozen_arrays import Floats
from scripts.studies.aimed_braking.anemometer import ByReadingAndWind, WindByAnemometer
from scripts.studies.aiming.hump import POINTS, weight_category, with_bends
from scripts.studies.aiming.places import FreeDistance
from scripts.studies.aiming.readings import LightnessByWeigher, ResistanceByRadar
from scripts.studies.aiming.recorded_cuts import NearestRecord
from scripts.studies.aiming.regression import ByRegression
from scripts.studies.aiming.trial import Cuts, Draws, Outcome, outcomes, samples
from scripts.studies.side_by_side import side_by_side
from synth.aim.knowledge import ByCategory, ByReading, Knowledge
from synth.aim.position_models import NormalPosition
from synth.aim.readings import ResistanceByTwoSpeeds
from synth.aim.scene import AimScene

EXIT_STD_M_S = 0.03
"""What the exported tables reach at other positions (docs/reference/results.md)."""

ANEMOMETER_STD_M_S = 0.5
"""What the wind of a cut is uncertain by where an anemometer tells the wind of the hour; assumed."""

LONGER_FROM_M = 178.0
"""Exit of the bunch position: the longest stretch that there is."""

NODES, WIND_NODES = 33, 13
"""Of the resistance and of the wind, at which commands are worked out."""

RADAR_STD_M_S = 0.05
RADAR_M = 50.0


@dataclass(frozen=True)
class Measuring:
    """A way to measure: what is known, and whether the stretch is straight or longer."""

    name: str
    knowledge: Knowledge
    straight: bool = False
    longer: bool = False


@dataclass(frozen=True)
class Measured:
    """Outcomes of one way over the free distance, light single cars."""

    name: str
    outcomes: tuple[Outcome | None, ...]


def two(std_m_s: float) -> ByReading:
    """Two speeds, Bayes' rule."""
    return ByReading(ResistanceByTwoSpeeds(std_m_s), NODES)


def two_and_wind(std_m_s: float) -> ByReadingAndWind:
    """Two speeds and the wind."""
    return ByReadingAndWind(ResistanceByTwoSpeeds(std_m_s), WIND, NODES, WIND_NODES)


WIND = WindByAnemometer(ANEMOMETER_STD_M_S)
RADAR = ByReading(ResistanceByRadar(RADAR_STD_M_S, RADAR_M), NODES)

WAYS = (
    Measuring("category alone", ByCategory()),
    Measuring("category, anemometer", ByReading(WIND, NODES)),
    Measuring("weight, exact", ByRegression(LightnessByWeigher(1e-4))),
    Measuring("three control points, nearest of 300 records", NearestRecord(POINTS, 300)),
    Measuring("two speeds, σ_v 0.1", two(0.1)),
    Measuring("two speeds, σ_v 0.03", two(0.03)),
    Measuring("two speeds, σ_v 0.01", two(0.01)),
    Measuring("two speeds, σ_v 0.03, stretch of 132 m", two(0.03), longer=True),
    Measuring("two speeds, σ_v 0.03, anemometer", two_and_wind(0.03)),
    Measuring("two speeds, σ_v 0.1, straight stretch", two(0.1), straight=True),
    Measuring("two speeds, σ_v 0.03, straight stretch", two(0.03), straight=True),
    Measuring("two speeds, σ_v 0.01, straight stretch", two(0.01), straight=True),
    Measuring("two speeds, σ_v 0.03, straight, anemometer", two_and_wind(0.03), straight=True),
    Measuring("two speeds, σ_v 0.01, straight, anemometer", two_and_wind(0.01), straight=True),
    Measuring("radar 0.05 on the last 50 m", RADAR),
    Measuring("radar 0.05 on the last 50 m, straight", RADAR, straight=True),
    Measuring("regression on two speeds, σ_v 0.03", ByRegression(ResistanceByTwoSpeeds(0.03))),
)


def measured(
    hump: AimScene, metres: tuple[float, ...], p: float, draws: Draws, ways: tuple[Measuring, ...]
) -> Iterator[Measured]:
    """The outcomes of each way."""
    found = side_by_side(lambda way: outcomes(of_way(way, hump, metres, p, draws)), ways)
    yield from (Measured(way.name, of_one) for way, of_one in zip(ways, found, strict=True))


def of_way(way: Measuring, hump: AimScene, metres: tuple[float, ...], p: float, draws: Draws) -> Floats:
    """Figures of every replicate."""
    scene = with_bends(hump, ()) if way.straight else hump
    if way.longer:
        scene = replace(scene, stretch=replace(scene.stretch, from_m=LONGER_FROM_M))
    cuts = Cuts(scene, weight_category(scene, "L"))
    return samples(cuts, FreeDistance(metres), NormalPosition(EXIT_STD_M_S), way.knowledge, p, draws)
