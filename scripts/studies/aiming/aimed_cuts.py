"""Cuts on their way to standing cars: what would be right for each, and what a command makes of it."""

from __future__ import annotations

import numpy as np

from plant_models.frozen_arrays import Floats, frozen_arrays
from scripts.studies.aiming.places import Places
from synth.aim.outcome import Couplings, couplings
from synth.aim.position_models import ExitSpeeds, PositionModel
from synth.aim.scene import SceneCuts


@frozen_arrays
class RolledCuts:
    """Cuts with the places where they meet standing cars, `arrivals_m` (n, k), and the highest exit speeds that do not
    couple too fast there, `critical_m_s` (n, k). No position counts yet. Build it with `rolled_cuts`."""

    cuts: SceneCuts
    arrivals_m: Floats
    critical_m_s: Floats

    def at(self, position: PositionModel) -> AimedCuts:
        """The same cuts at `position`."""
        exits = position.exits(self.cuts)
        thresholds = [exits.threshold(column) for column in self.critical_m_s.T]
        return AimedCuts(self, exits, np.stack(thresholds, axis=1))


@frozen_arrays
class AimedCuts:
    """Cuts at a position: `thresholds_m_s` (n, k) are the commands above which they couple too fast."""

    rolled: RolledCuts
    exits: ExitSpeeds
    thresholds_m_s: Floats

    @property
    def cuts(self) -> SceneCuts:
        """The cuts themselves."""
        return self.rolled.cuts

    def couplings(self, commanded_m_s: Floats, place: int) -> Couplings:
        """How they couple at one place that are commanded `commanded_m_s` (n,)."""
        return couplings(self.cuts, self.exits, commanded_m_s, self.rolled.arrivals_m[:, place])


def rolled_cuts(cuts: SceneCuts, places: Places) -> RolledCuts:
    """`cuts` that are rolled back from `places`."""
    arrivals = places.arrivals_m(cuts)
    critical = [cuts.critical_speeds_m_s(column) for column in arrivals.T]
    return RolledCuts(cuts, arrivals, np.stack(critical, axis=1))
