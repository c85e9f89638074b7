"""The way of cuts as a control expects it before they roll: with mean bends and mean wind."""

from __future__ import annotations

import numpy as np

from plant_models.frozen_arrays import Floats, Ints, frozen_arrays
from synth.hump.trains.free_stretch import StretchSpeeds
from synth.hump.trains.motion import Rolls


@frozen_arrays
class ExpectedWay:
    """All cuts of some trains: `rolls` with mean bends and wind, their mean w0 `mean_n_per_kn` and g' (rows,)."""

    rolls: Rolls
    mean_n_per_kn: Floats
    gravity_m_s2: Floats

    def comes_m_s(self, rows: Ints, routes: Ints, speeds: StretchSpeeds, taken_n_per_kn: Floats) -> Floats:
        """Speed (n,) at the end of a stretch with `taken_n_per_kn` instead of the cuts' own; 0 where they stop, and
        where the stretch tells nothing."""
        tells = speeds.tells
        comes = np.zeros(len(rows))
        if tells.any():
            rolled = self.rolls.roll_on(
                rows[tells],
                routes[tells],
                speeds.from_m[tells],
                speeds.from_m_s[tells],
                speeds.to_m[tells, None],
                taken_n_per_kn[tells],
            )
            comes[tells] = rolled.speed_m_s[:, 0]
        return comes
