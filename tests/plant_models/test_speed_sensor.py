"""A speed sensor is one whose readings are numbers."""

import math
from collections.abc import Callable, Mapping
from typing import Final

import pytest

from plant_models import Approach, DopplerSensor, PlantError
from plant_models.approach import SHORTEST_APPROACH_M
from plant_models.speed_sensor import FINEST_RESOLUTION_M_S


@pytest.mark.parametrize("resolution_m_s", [0.0, 1e-6, 0.01, 1.0])
def test_a_resolution_that_gives_numbers(resolution_m_s: float) -> None:
    sensor = DopplerSensor(0.05, resolution_m_s, 0.1, 0.02)
    if resolution_m_s:
        assert round(9.0 / sensor.resolution_m_s) * sensor.resolution_m_s == pytest.approx(9.0, abs=resolution_m_s)


@pytest.mark.parametrize("resolution_m_s", [5e-324, 1e-300, 9e-7, -1e-6, 1.1, float("nan")])
def test_no_other_resolution(resolution_m_s: float) -> None:
    with pytest.raises(PlantError, match="sensor: resolution_m_s is"):
        DopplerSensor(0.05, resolution_m_s, 0.1, 0.02)


NOTHING_OR_FROM: Final[Mapping[str, tuple[float, Callable[[float], object]]]] = {
    "sensor: resolution_m_s": (FINEST_RESOLUTION_M_S, lambda number: DopplerSensor(0.05, number, 0.1, 0.02)),
    "sensor: missed_burst_s": (0.1, lambda number: DopplerSensor(0.05, 0.0, 0.1, 0.02, 0.1 * (number > 0.0), number)),
    "regulator: approach_m": (SHORTEST_APPROACH_M, Approach),
}


@pytest.mark.parametrize("key", NOTHING_OR_FROM)
def test_nothing_is_allowed_or_a_least_number_and_more(key: str) -> None:
    least, make = NOTHING_OR_FROM[key]
    for allowed in (0.0, least, 2.0 * least):
        make(allowed)
    with pytest.raises(PlantError, match=f"{key} is"):
        make(math.nextafter(least, 0.0))
