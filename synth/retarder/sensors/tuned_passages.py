"""The one way from an aim to a table for point sensors: solve, polish, round, predict."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from plant_models import Plant, PointSensors
from plant_models.frozen_arrays import Floats, frozen_arrays
from synth.problem.aim import Aim
from synth.problem.resolution import Resolution, finer_for_check
from synth.solver.backward_induction import solve
from synth.solver.chain.chain import Chain, check_chain, persistent_chain
from synth.solver.chain.sensor_passages import SensorPassages
from synth.solver.descent import Descent
from synth.solver.exit_density import ExitDensity
from synth.solver.passage_polish import polish_passages
from synth.solver.passage_speeds import PassageSpeeds, ordered
from synth.solver.resolved_density import resolved_density

LEAST_FRICTIONS = 7
"""Of fewer, sensors that measure well tell one from the other: lines polished on five frictions and 64 evaluations cost
0.009 m/s there, and 0.031 on a fine grid (12 equal sections, every axle, 22 t to 2 m/s)."""

RESISTANCES = 1
"""Of the running resistance a design takes the mean: more was not tried with sensors."""


@frozen_arrays
class TunedPassages:
    """Switching speeds as a table holds them, and the exit density predicted of them.

    `polish`: how they were found; they are float32 numbers of the stages that the cut may use.
    """

    plant: Plant
    sensors: PointSensors
    aim: Aim
    polish: Descent[PassageSpeeds]
    predicted: ExitDensity

    @property
    def speeds(self) -> PassageSpeeds:
        """The switching speeds."""
        return self.polish.best

    @property
    def rms_m_s(self) -> float:
        """Predicted rms error at the exit."""
        return self.predicted.rms_m_s(self.aim.target_speed_m_s)


@dataclass(frozen=True)
class PassageChains:
    """The chains of one plant with point sensors: to design switching speeds on, and to predict finished ones."""

    sensors: PointSensors
    design: Chain
    check: Chain


def passage_chains(plant: Plant, sensors: PointSensors, resolution: Resolution) -> PassageChains:
    """Both chains; `plant` begins at the first sensor (`with_point_sensors`).

    The design counts with `missed_share`; the prediction hears every passage.
    """
    frictions = max(resolution.friction_nodes, LEAST_FRICTIONS)
    tuned_on = replace(resolution, friction_nodes=frictions, resistance_nodes=RESISTANCES)
    design = persistent_chain(plant, tuned_on, SensorPassages(sensors))
    every = replace(sensors, missed_share=0.0)
    check = check_chain(plant, finer_for_check(resolution), SensorPassages(every))
    return PassageChains(sensors, design, check)


def tuned_passages(chains: PassageChains, aim: Aim) -> TunedPassages:
    """Switching speeds for one aim: those of the solution, polished, rounded to float32, and predicted."""
    solution = solve(chains.design, aim)
    found = polish_passages(solution)
    speeds = rounded(found.best)
    predicted = resolved_density(chains.check, speeds, aim.target_speed_m_s)
    return TunedPassages(chains.design.plant, chains.sensors, aim, found.ending(speeds, found.cost_after), predicted)


def rounded(speeds: PassageSpeeds) -> PassageSpeeds:
    """The float32 numbers next to the switching speeds, in order; none is negative."""
    apart = ordered(np.where(np.isfinite(speeds.switching_m_s), np.maximum(speeds.switching_m_s, 0.0), np.inf))
    kept: Floats = np.where(np.isfinite(speeds.switching_m_s), apart, speeds.switching_m_s)
    return PassageSpeeds(kept.astype(np.float32).astype(np.float64) + 0.0)
