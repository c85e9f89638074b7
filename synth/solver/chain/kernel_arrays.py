"""A chain as the kernels of the recursions take it."""

from __future__ import annotations

import numpy as np

from synth.kernels.sweep import chain_arrays as kernel
from synth.kernels.sweep.pass_time import Times
from synth.solver.chain.chain import Chain


def chain_arrays(c: Chain, commands: int | None = None) -> kernel.ChainArrays:
    """All but policy, scenarios and aim; of so many commands, by default all."""
    a, commands = c.landings, c.decisions.commands if commands is None else commands
    return kernel.ChainArrays(
        kernel.Grid(c.grid.speed_m_s, c.grid.path_step_m, c.grid.energy_step_m2_s2),
        kernel.Track(c.drive_m_s2, c.brake_m_s2_per_kpa),
        kernel.Modes(c.actuator.mode_stage, c.actuator.mode_overpressure_kpa, c.entry_mode),
        c.path_noise,
        c.transient_noise,
        kernel.Landings(a.change_chain[:commands], a.end_mode, a.ends, a.factors),
        c.decisions.at_nodes(len(c.drive_m_s2)),
        c.epochs.hold_period_s,
        c.entry,
    )


def scenario_arrays(c: Chain, chosen: slice = slice(None)) -> kernel.Scenarios:
    """The `chosen` scenarios."""
    return kernel.Scenarios(c.scenarios.factor[chosen], c.scenarios.extra_m_s2[chosen])


def pass_times(c: Chain) -> Times:
    """What the recursions must know to count the time of a pass."""
    path = c.grid.path_m
    duration = np.asarray(c.landings.samples * c.epochs.clock.sample_period_s, dtype=np.float64)
    return Times(np.diff(path), path[-1] - path[:-1], duration, np.array(c.decisions.lead_m))
