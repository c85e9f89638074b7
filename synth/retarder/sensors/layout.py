"""Where point sensors stand: equal sections, the rule that a change of stage ends inside its section, and what any
layout costs, quickly: a chain that decides at every path node, or at some of them.

Where a change of stage ends depends on no sensor. So the motion is integrated once for all places, and a layout costs a
backward sweep alone: the expected cost of its solution, which is not polished yet.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from plant_models import Plant, PointSensors
from plant_models.frozen_arrays import Ints
from plant_models.stage_regulator import stage_locked_actuator
from synth.kernels.vector.packs import EIGHT
from synth.problem.problem import Aim
from synth.problem.resolution import Resolution
from synth.solver.backward_induction import PolicyMap, Solution, policy_map, solve_all
from synth.solver.chain.chain import Chain, persistent_chain
from synth.solver.chain.decisions import Decisions
from synth.solver.chain.grid import Grid, make_grid
from synth.solver.chain.sampling import PlaceEpochs

LAST_SECTION_M = 0.5
"""No sensor that decides stands nearer to the exit."""

BEHIND_EXIT_M = 1.0
"""The sensor that logs the exit speed stands so far behind the exit."""


def longest_change_s(plant: Plant, sensors: PointSensors) -> float:
    """Time from the second pulse until the longest change of stage has ended."""
    actuator = stage_locked_actuator(plant.position, sensors, plant.top_stage, 1)
    return float(actuator.chain_samples.max()) * sensors.scan_period_s


def fastest_m_s(plant: Plant, target_speed_m_s: float, path_m: float, share: float) -> float:
    """Speed at `path_m` of a cut at the quantile `share` of entry, slowed down evenly to its target at the exit."""
    entry = float(plant.entry.speed_m_s(np.array([share]))[0])
    part = min(max(path_m / plant.exit_m, 0.0), 1.0)
    return math.sqrt(entry**2 + (min(target_speed_m_s, entry) ** 2 - entry**2) * part)


def rule_layout(plant: Plant, sensors: PointSensors, target_speed_m_s: float, share: float = 0.99) -> tuple[float, ...]:
    """Places of the deciding sensors by zhukovitsky-2012: each section as long as the longest change of stage needs.

    The speed at the beginning of a section is that of `fastest_m_s`; so the share of passages that find a change
    unfinished is less than 1 − `share` as far as cuts slow down evenly. The first section ends at the entrance.
    """
    time_s = longest_change_s(plant, sensors)
    place = -fastest_m_s(plant, target_speed_m_s, 0.0, share) * time_s - 0.5 * sensors.base_m
    places = []
    while place < plant.exit_m - LAST_SECTION_M:
        places.append(round(place, 3))
        length = fastest_m_s(plant, target_speed_m_s, place, share) * time_s
        place = max(place + length + 0.5 * sensors.base_m, 0.0 if place < 0.0 else place)
    return tuple(places)


def first_sensor_m(plant: Plant, sensors: PointSensors, target_speed_m_s: float) -> float:
    """Place of the first sensor by the rule: its command is in force when the first axle enters."""
    return rule_layout(plant, sensors, target_speed_m_s)[0]


def equal_layout(first_m: float, exit_m: float, count: int) -> tuple[float, ...]:
    """`count` deciding sensors: one at `first_m`, the others at equal sections from the entrance to the exit."""
    behind = np.arange(count - 1) * (exit_m / max(count - 1, 1))
    return (round(first_m, 3), *(round(float(place), 3) for place in behind))


def with_layout(sensors: PointSensors, deciding_m: tuple[float, ...], exit_m: float) -> PointSensors:
    """Sensors at the deciding places, and the last one behind the exit, which logs."""
    return replace(sensors, path_m=(*deciding_m, round(exit_m + BEHIND_EXIT_M, 3)))


COARSE = Resolution(path_step_m=0.5, speed_step_m_s=0.1, friction_nodes=4, path_levels=1, resistance_nodes=1)
"""What layouts are compared on before tables are made of the best. With two levels of path noise the layouts found are
no better, and each takes twice the time; with three frictions they are worse by a tenth behind a car dumper."""


LEAST_COST_M2_S2 = 1e-6
"""Costs below it are errors of the grid: a search must not descend into them."""


@dataclass(frozen=True)
class EveryNode(PlaceEpochs):
    """Decisions at every path node, as if there were a sensor `clock` at each."""

    def grid(self, plant: Plant, resolution: Resolution) -> Grid:
        """Uniform in path and energy."""
        return make_grid(plant, resolution)

    def decisions(self, plant: Plant, grid: Grid) -> Decisions:
        """At every node, with the command half a base behind."""
        node = np.arange(len(grid.path_m) - 1)
        lead_m = np.full(len(node), 0.5 * self.clock.base_m)
        return Decisions(node, node.astype(np.float64) * grid.path_step_m, lead_m, plant.top_stage, plant.top_stage)


@dataclass(frozen=True)
class LayoutCase:
    """A class of cuts at the position, and the aims that its tables will have; all count alike."""

    plant: Plant
    aims: tuple[Aim, ...]


@dataclass(frozen=True)
class CandidatePlaces:
    """One case made ready for the comparison of layouts. Build it with `candidate_places`."""

    chain: Chain
    aims: tuple[Aim, ...]
    axle_offsets_m: tuple[float, ...]

    @property
    def together(self) -> int:
        """How many layouts one sweep takes at little more than the time of one."""
        return max(1, EIGHT // len(self.aims))

    def mean_costs(self, layouts_m: Sequence[Sequence[float]]) -> list[float]:
        """Mean over the aims of the expected cost of each layout, its sensors taken at the nearest nodes.

        Layouts share the motion, so they are solved side by side, as aims are: each decides at its own passages alone.
        """
        decided = [self.nodes(each) for each in layouts_m]
        node = np.unique(np.concatenate(decided))
        chain = self.at(node)
        heard = [np.isin(node, each) * chain.epochs.heard for each in decided for _ in self.aims]
        solutions = solve_all(chain, self.aims * len(decided), nodes_kept=1, heard=np.stack(heard, axis=1))
        costs = np.array([expected_cost(each) for each in solutions]).reshape(len(decided), -1)
        return [float(max(each, LEAST_COST_M2_S2)) for each in costs.mean(axis=1)]

    def nodes(self, sensors_m: Sequence[float]) -> Ints:
        """Path nodes nearest to the passages over these sensors, rising."""
        c, step = self.chain, self.chain.grid.path_step_m
        place = np.add.outer(np.asarray(sensors_m), np.asarray(self.axle_offsets_m)).ravel() - c.grid.path_m[0]
        node = np.unique(np.rint(place / step).astype(np.int64))
        return node[(node >= 0) & (node < len(c.drive_m_s2))]

    def at(self, node: Ints) -> Chain:
        """The chain that decides at these path nodes alone."""
        c = self.chain
        decisions = replace(c.decisions, node=node, place_m=c.decisions.place_m[node], lead_m=c.decisions.lead_m[node])
        landings = replace(c.landings, ends=np.ascontiguousarray(c.landings.ends[node]))
        return replace(c, decisions=decisions, landings=landings)


def expected_cost(solution: Solution) -> float:
    """Of a pass that enters as the chain's cuts do, m²/s²."""
    c = solution.chain
    start = solution.values[:, 0, c.entry_mode]
    return float(np.einsum("i,q,j,iqj->", c.scenarios.weight, c.path_noise.stationary, c.entry[0], start))


def candidate_places(
    case: LayoutCase, sensors: PointSensors, ahead_m: float, resolution: Resolution = COARSE
) -> CandidatePlaces:
    """`case` with places from `ahead_m` before the entrance on; of `sensors` all but the places is taken."""
    plant = replace(case.plant, approach=replace(case.plant.approach, length_m=ahead_m))
    chain = persistent_chain(plant, resolution, EveryNode(sensors))
    offsets = tuple(plant.cut.axle_offsets_m[axle] for axle in sensors.axles(plant.cut))
    return CandidatePlaces(chain, case.aims, offsets)


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
