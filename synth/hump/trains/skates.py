"""Track skates: what holds cuts ahead of the standing cars where no position aims at them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from plant_models.frozen_arrays import Floats, Ints


@dataclass(frozen=True)
class Skates:
    """Skates on the tracks of the routes `rows`: just ahead of the standing cars they take `energy_share` of the energy
    of each cut that comes there. A cut that stops before, or that meets one which still rolls, is not held by them.
    """

    energy_share: float
    rows: tuple[int, ...]

    def left_m_s(self, routes: Ints, speed_m_s: Floats) -> Floats:
        """With what speed cuts (n,) on `routes` (n,) couple that come with `speed_m_s` (n,)."""
        held = np.isin(routes, self.rows)
        return np.where(held, np.sqrt(1.0 - self.energy_share) * speed_m_s, speed_m_s)


NO_SKATES: Final = Skates(0.0, ())
