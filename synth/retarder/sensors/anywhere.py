"""What a regulator would command that could decide anywhere: the map under which a plan of sensors is drawn."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from plant_models import PointSensors
from synth.problem.resolution import Resolution
from synth.retarder.case_result import PolicyMap
from synth.retarder.policy_map import policy_map
from synth.retarder.sensors.candidate_places import LayoutCase, candidate_places
from synth.solver.backward_induction import solve_all

MAP = Resolution(path_step_m=0.5, speed_step_m_s=0.03, friction_nodes=7, resistance_nodes=1)
"""Its grid: finer in speed than the search's, for it is looked at."""

TOLERANCE_M2_S2 = 1e-5
"""Commands that cost no more than this from the best are indifferent."""


def policy_anywhere(case: LayoutCase, sensors: PointSensors, ahead_m: float) -> PolicyMap:
    """The best command for the first aim of `case` at every place from `ahead_m` before the entrance on.

    As if a sensor of this kind stood at every half metre. Of the commands up, and of those down, by however many
    stages, the best counts.
    """
    places = candidate_places(case, sensors, ahead_m, MAP)
    (solution,) = solve_all(places.chain, case.aims[:1], nodes_kept=1, value_type=np.float64)
    gain = np.where(np.any(solution.gain != 0.0, axis=3, keepdims=True), solution.gain, -np.inf)
    either = np.stack([gain[0::2].max(axis=0), gain[1::2].max(axis=0)])
    return policy_map(replace(solution, gain=either), TOLERANCE_M2_S2)
