"""Where every change of stage ends: the motion through it, integrated once for all policies and targets."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from plant_models import Plant, path_coefficients
from plant_models.frozen_arrays import Floats, Ints, frozen_arrays
from plant_models.stage_regulator import Actuator
from synth.kernels.sweep.landing import Ground, Transients, land
from synth.kernels.vector.packs import EIGHT, SIXTEEN
from synth.solver.chain.decisions import Decisions, steps_of
from synth.solver.chain.grid import Grid

FACTOR_STEP = 1.0
"""Largest distance of the friction factors for which transients are integrated; between them a parabola. Halving it
changes no predicted rms by more than 1e-6 m/s."""

FINE_CELLS_PER_QUANTUM = 4


@frozen_arrays
class Landings:
    """End of every change of stage that may be commanded, from every decision, for friction `factors` (F,).

    `ends` (R, ·, F, 2, E'), see `kernels.landing.land`, of which `points` E are energies of the grid; `change_chain`
    (C, H): index of the transient of a command in a mode, −1 if none; the first two commands go one stage down and one
    up. `end_mode` of the transients.
    """

    factors: Floats
    ends: Floats
    change_chain: Ints
    end_mode: Ints
    overpressure_kpa: Floats
    samples: Ints
    points: int

    @property
    def travel_m(self) -> Floats:
        """Path until the end of the transient, or to S_exit, as sweeps count it, (R, ·, F, E); −1 for a stall."""
        return self.ends[..., 0, : self.points]

    @property
    def energy_m2_s2(self) -> Floats:
        """v²/2 at the end of the transient, (R, ·, F, E)."""
        return self.ends[..., 1, : self.points]


def make_landings(
    plant: Plant, grid: Grid, decisions: Decisions, actuator: Actuator, period_s: float, factors: Floats
) -> Landings:
    """Integrate the motion through every change of stage (`land`), for friction `factors` (F,).

    `period_s`: the step of the clock in which the actuator counts.
    """
    used: list[int] = []
    held: list[float] = []
    change_chain = np.full((decisions.commands, len(actuator.mode_stage)), -1)
    for command in range(decisions.commands):
        for mode, stage in enumerate(actuator.mode_stage):
            wanted = stage + steps_of(command)
            if 0 <= wanted < actuator.stages:
                change_chain[command, mode] = len(used)
                used.append(int(actuator.command[mode, wanted]))
                held.append(float(actuator.mode_overpressure_kpa[mode]))
    fine = np.linspace(plant.start_m, plant.exit_m, FINE_CELLS_PER_QUANTUM * (len(grid.path_m) - 1) + 1)
    cells = path_coefficients(plant.position, plant.cut, plant.profile, fine)
    work = np.concatenate([[0.0], np.cumsum(cells.brake_m_s2_per_kpa * np.diff(fine))])
    drive = cells.free_m_s2(plant.resistance.mean_n_per_kn)
    samples = actuator.chain_samples[used]
    steps = samples * actuator.substeps
    overpressure = np.ascontiguousarray(actuator.chain_overpressure_kpa[used, : steps.max()])
    speed = in_whole_packs(grid.speed_m_s)
    ends = np.empty((len(decisions), len(used), len(factors), 2, len(speed)))
    length_m = (len(grid.path_m) - 1) * grid.path_step_m
    shared = shared_beginnings(overpressure, steps, held)
    transients = Transients(np.array(held), overpressure, steps, shared, period_s / actuator.substeps)
    ground = Ground(length_m / len(drive), work, drive)
    land(decisions.place_m, decisions.lead_m, ground, transients, factors, speed, ends)
    if not isinstance(grid.stretch, float):
        for decision, node in enumerate(decisions.node):
            ends[decision, :, :, 0] = grid.counted_m(node, ends[decision, :, :, 0])
    return Landings(factors, ends, change_chain, actuator.chain_mode[used], overpressure, samples, len(grid.speed_m_s))


def shared_beginnings(overpressure: Floats, steps: Ints, held: Sequence[float]) -> Ints:
    """The transients (C, 3) in an order to integrate them in: each, the earlier one it branches off from, where.

    Valves know nothing of the goal until the pressure is there: from one pressure all changes in one direction begin
    alike, and only the longest is integrated from its beginning on. `overpressure` (C, ·) in `steps` (C,).
    """
    order = sorted(range(len(steps)), key=lambda c: (held[c], -steps[c], c))
    found: list[tuple[int, int, int]] = []
    for c in order:
        trunk, common = -1, 0
        for earlier, _, branched in found:
            if held[earlier] == held[c]:
                last = min(steps[c], steps[earlier])
                differ = np.flatnonzero(overpressure[c, :last] != overpressure[earlier, :last])
                alike = int(differ[0]) if len(differ) else int(last)
                if alike > max(common, branched):
                    trunk, common = earlier, alike
        found.append((c, trunk, common))
    return np.array(found)


def in_whole_packs(speed_m_s: Floats) -> Floats:
    """The speeds, the last one repeated, so that whole packs may be read from any of them on (`kernels.packs`)."""
    return np.pad(speed_m_s, (0, EIGHT + -(len(speed_m_s) + EIGHT) % SIXTEEN), mode="edge")


def friction_factors(plant: Plant) -> Floats:
    """Factors ξ, at most `FACTOR_STEP` apart, that cover four standard deviations of ξ_cut and three of η."""
    cv, std = plant.friction_cv, plant.friction.path_std
    low = min(max(plant.friction.floor, 1.0 - 4.0 * cv) * max(1.0 - 3.0 * std, 0.0), 0.9)
    high = max((1.0 + 4.0 * cv) * (1.0 + 3.0 * std), 1.1)
    return np.linspace(low, high, max(3, math.ceil((high - low) / FACTOR_STEP) + 1))
