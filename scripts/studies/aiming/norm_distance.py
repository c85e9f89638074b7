"""How far from the crest a norm of the gap is met: the "400 m" of Kozachenko."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from plant_models.frozen_arrays import Floats
from scripts.studies.aiming.aimed_cuts import rolled_cuts
from scripts.studies.aiming.places import FromCrest
from scripts.studies.aiming.trial import Cuts, Draws, judged
from synth.aim.knowledge import Knowledge
from synth.aim.position_models import PositionModel
from synth.aim.scene import SceneCuts

NORM_GAP_M = 3.0
"""Mean gap a car that is allowed at a probability of over-speed of 0.1 ([kozachenko-aimed], its reference 1)."""

BEYOND = 0.3
"""Metres; the root is found so nearly."""


def norm_distance(
    cuts: Cuts, position: PositionModel, knowledge: Knowledge, p_overspeed: float, draws: Draws, last_m: float
) -> Floats:
    """Metres from the crest at which the mean gap a car reaches NORM_GAP_M, in each replicate, (replicates,); infinite
    where it is met at `last_m` still."""
    nearest = cuts.scene.exit_m + 1.0
    rows = []
    for drawn in cuts.unrolled(draws):

        def beyond(metres: float, both: tuple[SceneCuts, SceneCuts] = drawn) -> float:
            places = FromCrest((metres,))
            chosen_on, judged_on = (rolled_cuts(each, places).at(position) for each in both)
            gap = float(judged(chosen_on, judged_on, knowledge, p_overspeed)[0, 0])
            return 1e3 if np.isnan(gap) else gap - NORM_GAP_M

        rows.append(root(beyond, nearest, last_m))
    return np.array(rows)


def root(rising: Callable[[float], float], low: float, high: float) -> float:
    """Where a function that rises passes 0; infinite if it is below at `high`, `low` if above at `low`."""
    below, above = rising(low), rising(high)
    if below >= 0.0 or above <= 0.0:
        return low if below >= 0.0 else float("inf")
    while high - low > BEYOND:
        part = np.clip(-below / (above - below), 0.1, 0.9) if above < 100.0 else 0.5
        middle = low + part * (high - low)
        value = rising(middle)
        if value < 0.0:
            low, below = middle, value
        else:
            high, above = middle, value
    return 0.5 * (low + high)
