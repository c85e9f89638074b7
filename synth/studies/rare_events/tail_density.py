"""Tails of the exit speed by the forward density: nothing is sampled, every error is measured by a refinement.

P(over | z, w) follows from the Chapman–Kolmogorov equation for one hidden scenario (docs/method.md §5); it is smooth
in z, the standard normal number of ξ_cut, and in w, and is integrated against their laws: adaptively over z, with the
whole mass of cuts below the floor of ξ_cut at the floor, and by Gauss nodes of the gamma law over w.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from plant_models import Plant
from plant_models.frozen_arrays import frozen_arrays
from synth.problem.resolution import Resolution, finer_for_check
from synth.solver.chain.chain import Chain, check_chain
from synth.solver.chain.scenarios import Scenarios, resistance_scenarios
from synth.solver.policy_density import CommandChances, commands_of, forward_one
from synth.solver.switching_lines import SwitchingLines
from synth.solver.tabulate import lines_of
from synth.studies.rare_events.adaptive_simpson import adaptive_simpson
from synth.studies.rare_events.tail_probability import TailProbability
from tuning_tables import ControllerTable

FIRST_SPEED_STEP = 0.75
"""Times that of the design; it is halved to find the error, so that the check grid's half would only cost more."""

FARTHEST_Z = 6.0
"""ξ_cut is integrated so many standard deviations either way; what lies beyond (1e-9) goes into the error."""

PANELS, TOLERANCE, FLOOR = 10, 0.01, 1e-8
"""Of the integration over ξ_cut: panels of about one standard deviation, 1 % of each tail or of 1e-8."""


@dataclass(frozen=True)
class TailGrid:
    """How finely a tail is computed: grid, levels of η and sub-steps by `resolution`; Gauss nodes of w."""

    resolution: Resolution
    resistance_nodes: int


@frozen_arrays
@dataclass(frozen=True, eq=False)
class TailIntegral:
    """`probability` (M,) over each limit; (M,) as well: error of the integration over ξ_cut, negative mass above.

    `lost`: probability that was dropped as negligible or ran off the grid; `scenarios` followed forward.
    """

    probability: NDArray[np.float64]
    quadrature: NDArray[np.float64]
    negative: NDArray[np.float64]
    lost: float
    scenarios: int


@dataclass(frozen=True)
class TailErrors:
    """What one figure of the density may be wrong by, each the size of a refinement that was made.

    `grid`: both steps halved; `levels`: of η, three to five (the error falls like 1/(L − 1)); `resistance`: two to
    three nodes of w; `quadrature`: over ξ_cut; `mass`: negative, dropped, escaped, beyond ±6 std.
    """

    grid: float
    levels: float
    resistance: float
    quadrature: float
    mass: float

    @property
    def bound(self) -> float:
        """The sum."""
        return math.fsum(vars(self).values())


@dataclass(frozen=True)
class PredictedTails:
    """One `TailProbability` and one `TailErrors` for each margin."""

    tails: tuple[TailProbability, ...]
    errors: tuple[TailErrors, ...]


def predicted_tails(
    plant: Plant, table: ControllerTable, margins_m_s: Sequence[float], resolution: Resolution, threads: int = 1
) -> PredictedTails:
    """P(V_exit > target + margin) of `table`, with error bounds.

    `resolution` is that of the design. Start is the check grid with `FIRST_SPEED_STEP`, three levels of η and
    three nodes of w; to it are added what halving both steps and what five levels change, each found at the mean w. The
    bound is a measured one, not a proof: it holds as long as refinements converge at least linearly, and leaves out
    how they act on one another (products of small changes).
    """
    limits = table.target_speed_m_s + np.asarray(margins_m_s, dtype=np.float64)
    check = replace(
        finer_for_check(resolution), speed_step_m_s=FIRST_SPEED_STEP * resolution.speed_step_m_s, path_levels=3
    )
    fine = replace(check, path_step_m=0.5 * check.path_step_m, speed_step_m_s=0.5 * check.speed_step_m_s)
    grids = (
        TailGrid(check, 3), TailGrid(check, 2), TailGrid(check, 1), TailGrid(fine, 1),
        TailGrid(replace(check, path_levels=5), 1),
    )  # fmt: skip
    start, fewer_nodes, mean_w, halved, more_levels = (
        tail_integral(plant, table, limits, grid, threads) for grid in grids
    )
    by_grid = halved.probability - mean_w.probability
    by_levels = more_levels.probability - mean_w.probability
    by_nodes = start.probability - fewer_nodes.probability
    spent = sum(found.scenarios for found in (start, fewer_nodes, mean_w, halved, more_levels))
    tails, errors = [], []
    for i, margin in enumerate(margins_m_s):
        error = TailErrors(
            grid=abs(float(by_grid[i])),
            levels=abs(float(by_levels[i])),
            resistance=abs(float(by_nodes[i])),
            quadrature=float(start.quadrature[i]),
            mass=float(halved.negative[i]) + halved.lost,
        )
        p = min(max(float(start.probability[i] + by_grid[i] + by_levels[i]), 0.0), 1.0)
        low, high = max(p - error.bound, 0.0), min(p + error.bound, 1.0)
        tails.append(TailProbability(float(margin), p, low, high, "forward density", spent))
        errors.append(error)
    return PredictedTails(tuple(tails), tuple(errors))


def tail_integral(
    plant: Plant, table: ControllerTable, limits_m_s: NDArray[np.float64], grid: TailGrid, threads: int
) -> TailIntegral:
    """P(V_exit > limit) for every limit, on one grid."""
    transitions = check_chain(plant, grid.resolution)
    policy = policy_of(transitions, table)
    above = cells_above(transitions, limits_m_s)
    count = len(limits_m_s)
    extra, weight = resistance_scenarios(plant, grid.resistance_nodes)
    cv = plant.friction_cv

    def conditional(z: NDArray[np.float64]) -> NDArray[np.float64]:
        """(n, 2M + 1): over each limit, negative mass above each, lost; given z, averaged over w."""
        factor = plant.friction.cut_factor(z, cv)
        hidden = Scenarios(np.repeat(factor, len(extra)), np.tile(extra, len(z)), np.tile(weight, len(z)))
        exits, lost = exits_by_scenario(replace(transitions, scenarios=hidden), policy, threads)
        each = np.concatenate([exits @ above.T, -np.minimum(exits, 0.0) @ above.T, lost[:, None]], axis=1)
        return np.asarray((each.reshape(len(z), len(extra), -1) * weight[None, :, None]).sum(axis=1), dtype=np.float64)

    if cv == 0.0:
        value = conditional(np.zeros(1))[0]
        return TailIntegral(value[:count], np.zeros(count), value[count:-1], float(value[-1]), len(extra))
    lowest = max((plant.friction.floor - 1.0) / cv, -FARTHEST_Z)
    integral = adaptive_simpson(
        lambda z: conditional(z) * normal_density(z)[:, None], lowest, FARTHEST_Z, PANELS, TOLERANCE, FLOOR
    )
    value = integral.value + normal_cdf(lowest) * conditional(np.array([lowest]))[0]
    beyond = normal_cdf(-FARTHEST_Z) * (2.0 if lowest == -FARTHEST_Z else 1.0)
    return TailIntegral(
        probability=value[:count],
        quadrature=integral.error[:count],
        negative=value[count:-1],
        lost=float(value[-1]) + beyond,
        scenarios=(integral.points + 1) * len(extra),
    )


def policy_of(transitions: Chain, table: ControllerTable) -> CommandChances:
    """Command probabilities of the table's float32 lines, the stages that the cut may use."""
    lines, stages = lines_of(table, transitions.grid.path_m), transitions.actuator.stages
    used = SwitchingLines(lines.nodes_m, lines.lower_m_s[:stages], lines.upper_m_s[:stages])
    return commands_of(transitions, used)


def cells_above(transitions: Chain, limits_m_s: NDArray[np.float64]) -> NDArray[np.float64]:
    """(M, E): share of each energy cell that lies above a limit, the cell at the limit cut linearly in energy."""
    energy = transitions.grid.energy_m2_s2
    step = transitions.grid.energy_step_m2_s2
    return np.clip((energy - 0.5 * limits_m_s[:, None] ** 2) / step + 0.5, 0.0, 1.0)


def exits_by_scenario(
    transitions: Chain, policy: CommandChances, threads: int
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Exit probabilities (I, E) of every hidden scenario, and what is missing (I,): |1 − all that arrived|."""

    def one(i: int) -> tuple[NDArray[np.float64], float]:
        band = np.empty((len(transitions.drive_m_s2), 2), dtype=np.int64)
        exits, totals = forward_one(transitions, policy, i, np.empty((0, 0, 0, 0)), band)
        stalled, escaped = float(totals[0]), float(totals[1])
        return exits, abs(1.0 - float(exits.sum()) - stalled) + escaped

    with ThreadPoolExecutor(max_workers=threads) as pool:
        found = list(pool.map(one, range(len(transitions.scenarios.factor))))
    return np.array([exits for exits, _ in found]), np.array([lost for _, lost in found])


def normal_density(z: NDArray[np.float64]) -> NDArray[np.float64]:
    """φ(z)."""
    return np.asarray(np.exp(-0.5 * z**2) / math.sqrt(2.0 * math.pi), dtype=np.float64)


def normal_cdf(z: float) -> float:
    """Φ(z), accurate in the lower tail."""
    return 0.5 * math.erfc(-z / math.sqrt(2.0))
