"""Passes one after another, each under the correction that the exits before it have taught, while the plant ages:
friction that falls, a speed sensor that creeps.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from plant_models import Plant
from plant_models.frozen_arrays import Bools, Floats, frozen_arrays
from synth.kernels.loop.passes import Draws
from synth.simulation.closed_loop import ClosedLoop, TableController
from synth.simulation.passes import PassTrace
from synth.simulation.random_passes import RandomPasses
from tuning_tables.active_table import ActiveTable
from tuning_tables.correction import Correction, begun_correction
from tuning_tables.programs.correct import learn_exit, usable_exit


@dataclass(frozen=True)
class Ageing:
    """How a plant ages over a sequence of passes.

    `age`: passes (n,) of the plant, and how far the ageing is at each, (n,) from 0 to 1 → the passes that then come;
    `exit_bias_m_s`: what the measurement of the exit speed reads too much in the end.
    """

    name: str
    age: Callable[[RandomPasses, Plant, Floats], RandomPasses]
    exit_bias_m_s: float = 0.0


def stays(passes: RandomPasses, plant: Plant, share: Floats) -> RandomPasses:
    """Nothing changes."""
    return passes


@dataclass(frozen=True)
class FrictionFalls:
    """Every friction factor ends at (1 - `fall`) of what it was."""

    fall: float

    def __call__(self, passes: RandomPasses, plant: Plant, share: Floats) -> RandomPasses:
        """Standard normal numbers of the same law that stand for the smaller factors."""
        cv = plant.friction_cv
        factor = plant.friction.cut_factor(passes.cut_z, cv) * (1.0 - self.fall * share)
        return replace(passes, cut_z=(factor - 1.0) / cv)


@dataclass(frozen=True)
class SensorCreeps:
    """The sensor reads `bias_m_s` too much in the end, before it rounds: a shift of its noise."""

    bias_m_s: float

    def __call__(self, passes: RandomPasses, plant: Plant, share: Floats) -> RandomPasses:
        """The passes with shifted noise."""
        shift = (self.bias_m_s / plant.sensor.noise_m_s * share).astype(np.float32)
        return replace(passes, noise_z=passes.noise_z + shift[:, None])


def ageings(fall: float, creep_m_s: float) -> tuple[Ageing, ...]:
    """Those of the study: a plant that stays first."""
    return (
        Ageing("stays", stays),
        Ageing(f"friction falls by {100.0 * fall:g} %", FrictionFalls(fall)),
        Ageing(f"sensor creeps to {creep_m_s:+g} m/s, exits measured by another", SensorCreeps(creep_m_s)),
        Ageing(f"sensor creeps to {creep_m_s:+g} m/s, exits measured by itself", SensorCreeps(creep_m_s), creep_m_s),
    )


@frozen_arrays
class PassSequence:
    """n passes, arrays (n,): true exit speed - target, the correction each ran under, whether it was learnt from."""

    error_m_s: Floats
    correction_m_s: Floats
    usable: Bools


def corrected(table: ActiveTable, correction_m_s: np.float32) -> ActiveTable:
    """The table whose lines are lower by the correction: its rule at v is that of `table` at v + c."""
    coefficients = table.coefficients.copy()
    coefficients[:, :, 0] -= correction_m_s
    return replace(table, coefficients=coefficients)


def run_sequence(
    loop: ClosedLoop, table: ActiveTable, draws: Draws, readings_m_s: Floats, correction: Correction
) -> PassSequence:
    """The passes of `draws` in their order; the exit of each is measured with the error `readings_m_s`, (n,)."""
    state, count, target = begun_correction(), len(readings_m_s), float(table.target_speed_m_s)
    errors, applied = np.empty(count), np.empty(count)
    usable = np.empty(count, dtype=np.bool_)
    for number, reading in enumerate(readings_m_s):
        one = Draws._make(array[number : number + 1] for array in draws)
        trace = loop.follow(TableController(corrected(table, state[1])), one)
        errors[number], applied[number] = trace.exit_speed_m_s - target, state[1]
        measured = float(np.float32(errors[number] + reading))
        usable[number] = is_usable(trace, loop.stages - 1, measured)
        learn_exit(correction.setting, state, measured, bool(usable[number]))
    return PassSequence(errors, applied, usable)


def is_usable(trace: PassTrace, top_stage: int, error_m_s: float) -> bool:
    """`usable_exit` of a simulated pass; the regulator looks at the speed at its rests alone."""
    looked = trace.stage[~np.isnan(trace.measured_m_s)]
    at_top = int(np.count_nonzero(looked == top_stage))
    ends_at_top = bool(trace.stage[-1] == top_stage)
    return bool(usable_exit(len(looked), 0, at_top, ends_at_top, False, bool(trace.stalled), error_m_s))
