"""A speed sensor is one whose readings are numbers."""

import pytest

from plant_models import DopplerSensor, PlantError


@pytest.mark.parametrize("resolution_m_s", [0.0, 1e-6, 0.01, 1.0])
def test_a_resolution_that_gives_numbers(resolution_m_s: float) -> None:
    sensor = DopplerSensor(0.05, resolution_m_s, 0.1, 0.02)
    if resolution_m_s:
        assert round(9.0 / sensor.resolution_m_s) * sensor.resolution_m_s == pytest.approx(9.0, abs=resolution_m_s)


@pytest.mark.parametrize("resolution_m_s", [5e-324, 1e-300, 9e-7, -1e-6, 1.1, float("nan")])
def test_no_other_resolution(resolution_m_s: float) -> None:
    with pytest.raises(PlantError, match="sensor: resolution_m_s is"):
        DopplerSensor(0.05, resolution_m_s, 0.1, 0.02)
