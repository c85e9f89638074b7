"""The exit-speed density of a table, resolved near its target: what a prediction prints and draws."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from plant_models.frozen_arrays import Floats, frozen_arrays
from synth.kernels.sweep.finer_end import HandOver, forward_to_finer_end, refine_landings
from synth.solver.chain.chain import Chain, chain_arrays, scenario_arrays
from synth.solver.chain.decisions import Policy
from synth.solver.chain.grid import MARGIN_CELLS, Grid
from synth.solver.chain.landings import in_whole_packs
from synth.solver.evaluation import commands, exit_density
from synth.solver.exit_density import ExitDensity, without_negative

CELLS = 20
"""At least so many cells lie within three standard deviations of the exit speed to both sides of its mean."""

SHARE_OF_NOISE, OTHER_SPREAD_M2_S2 = 0.42, 0.03
"""The least standard deviation of an exit speed near its target that is expected: this share of the noise of a measured
speed, and in energy what sampling and valves leave."""

LONGEST_M, LENGTH_M2_S = 18.0, 36.0
"""The finer grid begins `LENGTH_M2_S` / target before the exit, `LONGEST_M` at most. Errors of the coarse grid before
that die down by a factor of about e every 4 m, because the regulator goes on acting; faster cuts spread over more cells
of energy."""

ABOVE_LINES_M_S = 0.8
"""What stands so far above the highest line hardly comes down to the target any more."""

BLEND_CELLS = 16
"""Coarse cells below the ceiling over which the share that is handed over rises from 0 to 1."""


@frozen_arrays
class FinerEnd:
    """`chain`: from path node `node` of the coarse chain to S_exit, its low energies, `times` as dense.

    `handed` (E,): share of every coarse energy that goes over to it at that node. The chain has the scenarios of the
    coarse one, and an entry that means nothing.
    """

    chain: Chain
    node: int
    times: int
    handed: Floats


def times_as_fine(chain: Chain, target_speed_m_s: float) -> int:
    """How many times as fine energies must be for `CELLS` cells near the target, where the exit speed spreads least."""
    of_noise = SHARE_OF_NOISE * chain.epochs.reading_std_m_s(target_speed_m_s)
    least_spread = math.hypot(target_speed_m_s * of_noise, OTHER_SPREAD_M2_S2)  # of the energy
    return max(1, math.ceil(CELLS * chain.grid.energy_step_m2_s2 / (6.0 * least_spread)))


def finer_length_m(target_speed_m_s: float) -> float:
    """Path before the exit on which energies are finer."""
    return min(LONGEST_M, LENGTH_M2_S / target_speed_m_s)


def finer_end(chain: Chain, lines_m_s: Floats, length_m: float, times: int) -> FinerEnd:
    """The last `length_m` of `chain` with energies `times` as dense, below a ceiling above all lines that are met.

    `lines_m_s` (C, R, K + 1) by command, decision and stage.
    """
    grid, quanta = chain.grid, len(chain.drive_m_s2)
    node = quanta - min(max(round(length_m / grid.path_step_m), 1), quanta)
    decisions = chain.decisions.behind(node)
    first = len(chain.decisions) - len(decisions)
    upper = lines_m_s[1::2, first:]
    met = upper < grid.speed_m_s[-1]
    ceiling_m_s = float(upper.max(initial=0.0, where=met)) + ABOVE_LINES_M_S
    cells = min(math.ceil(0.5 * ceiling_m_s**2 / grid.energy_step_m2_s2), len(grid.speed_m_s))
    below = np.clip((cells - np.arange(len(grid.speed_m_s))) / BLEND_CELLS, 0.0, 1.0)
    drive = chain.drive_m_s2[node:]
    gained = float(np.maximum(drive + chain.scenarios.extra_m_s2.max(), 0.0).sum()) * grid.path_step_m
    points = times * min(cells + math.ceil(gained / grid.energy_step_m2_s2) + MARGIN_CELLS, len(grid.speed_m_s))
    energy = grid.energy_step_m2_s2 / times * np.arange(points, dtype=np.float64)
    finer = Grid(grid.path_m[node:].copy(), grid.path_step_m, energy, np.sqrt(2.0 * energy))
    landings = chain.landings
    ends = np.empty((*landings.ends[first:].shape[:4], len(in_whole_packs(energy))))
    refine_landings(landings.ends, landings.points, first, times, ends)
    end = replace(
        chain,
        grid=finer,
        decisions=decisions,
        measurement=chain.measurement.behind(first, finer.speed_m_s),
        drive_m_s2=drive.copy(),
        brake_m_s2_per_kpa=chain.brake_m_s2_per_kpa[node:].copy(),
        landings=replace(landings, ends=ends, points=points),
    )
    return FinerEnd(end, node, times, below * below * (3.0 - 2.0 * below))


NEGLIGIBLE = 3e-11
"""A state of less probability is left out; in all less than 2e-6 is lost."""


def resolved_density(chain: Chain, lines: Policy, target_speed_m_s: float) -> ExitDensity:
    """Exit-speed density of `lines`, all scenarios weighted, its last metres on energies that resolve it at the target.

    Nowhere negative; mass, mean and mean square are those of the recursion.
    """
    times = times_as_fine(chain, target_speed_m_s)
    if times == 1:
        return without_negative(exit_density(chain, lines))
    end = finer_end(chain, lines.at_decisions(chain.decisions), finer_length_m(target_speed_m_s), times)
    return without_negative(density_by_end(chain, lines, end))


def density_by_end(chain: Chain, lines: Policy, end: FinerEnd) -> ExitDensity:
    """The same with a given `end`, as the recursion leaves it; its energies are `end.times` as dense as the chain's."""
    c, last = chain, end.chain
    at_decisions = lines.at_decisions(c.decisions)
    late = at_decisions[:, len(c.decisions) - len(last.decisions) :]
    policy, late_policy = commands(c, at_decisions), commands(last, late)
    points, weight = end.times * len(c.grid.speed_m_s), c.scenarios.weight
    negligible = np.clip(NEGLIGIBLE / np.maximum(np.abs(weight), 1e-12), NEGLIGIBLE, 1e-7)
    exits, totals = np.empty((len(weight), points)), np.empty((len(weight), 4))
    forward_to_finer_end(
        HandOver(end.node, end.handed, end.times), policy, chain_arrays(c), late_policy, chain_arrays(last),
        scenario_arrays(c), negligible, exits, totals,
    )  # fmt: skip
    probability = (weight[:, None] * exits).sum(axis=0)
    stalled, escaped, lowered, raised = (float(each) for each in (weight[:, None] * totals).sum(axis=0))
    speed = np.sqrt(2.0 * c.grid.energy_step_m2_s2 / end.times * np.arange(points))
    return ExitDensity(speed, probability, max(stalled, 0.0), escaped, lowered + raised)
