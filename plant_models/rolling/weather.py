"""Weather on the hump: air temperature, head wind and snow, as a roll meets them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from plant_models.errors import require_between
from plant_models.frozen_arrays import Floats

AIR_NORM = 17.8
"""kgf/t · (273 + t) · t / (m² · (m/s)²): [hump-norm]; half the density of air, 353/(273 + t), over g gives 17.99."""


@dataclass(frozen=True)
class Weather:
    """`head_wind_mean_m_s` and `head_wind_std_m_s`: normal law of the wind along the track, positive against the cut;
    one draw a cut ([kozachenko-aimed] has the law and no figures). `snow_n_per_kn`: added resistance of snow and frost
    behind the park position."""

    temperature_c: float = 10.0
    head_wind_mean_m_s: float = 0.0
    head_wind_std_m_s: float = 3.0
    snow_n_per_kn: float = 0.0

    def __post_init__(self) -> None:
        require_between("weather: temperature_c", self.temperature_c, -60.0, 60.0)
        require_between("weather: head_wind_mean_m_s", self.head_wind_mean_m_s, -30.0, 30.0)
        require_between("weather: head_wind_std_m_s", self.head_wind_std_m_s, 0.0, 15.0)
        require_between("weather: snow_n_per_kn", self.snow_n_per_kn, 0.0, 10.0)

    def air_n_per_kn(self, drag_area_m2: float) -> float:
        """Resistance of the air to C_x·S = `drag_area_m2` at 1 m/s against it, times the mass in tonnes, N/kN · t."""
        return AIR_NORM * drag_area_m2 / (273.0 + self.temperature_c)

    def head_winds_m_s(self, z: Floats) -> Floats:
        """Winds against cuts for standard normal `z`."""
        return np.asarray(self.head_wind_mean_m_s + self.head_wind_std_m_s * z)
