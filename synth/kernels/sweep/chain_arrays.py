"""The plant as a Markov chain, as the recursions over it take it: numbers and arrays by what they mean together.

N path quanta, E energies, H resting modes, L levels of the path noise, R decisions, C commands. Rows hold E' ≥ E
energies, so that whole packs may be read.
"""

from __future__ import annotations

from typing import NamedTuple

from plant_models.frozen_arrays import Floats, Ints
from synth.kernels.compiling import part_inline


class Grid(NamedTuple):
    """`speed` (E,) of the energies; steps of path, m, and of energy, m²/s²."""

    speed: Floats
    path_step: float
    energy_step: float


class Track(NamedTuple):
    """Acceleration without brakes, `drive`, and deceleration by one kPa, `brake` = β, in every quantum (N,)."""

    drive: Floats
    brake: Floats


class Modes(NamedTuple):
    """Stage and overpressure of the resting modes (H,); `entry`: the mode that the regulator finds."""

    stage: Ints
    pressure: Floats
    entry: int


class PathNoise(NamedTuple):
    """η, constant in each path quantum: `levels` (L,), `transition` (L, L) rows from, `stationary` (L,)."""

    levels: Floats
    transition: Floats
    stationary: Floats


class TransientNoise(NamedTuple):
    """Force-weighted mean of η over each transient that crosses r quantum boundaries, given both end levels.

    `probability` (·, r, L, L): of the end level, given the first; `mean`, `std` of the mean of η, given both.
    """

    probability: Floats
    mean: Floats
    std: Floats


class Landings(NamedTuple):
    """Where changes of stage end: `ends` (R, ·, F, 2, E') path and energy over the equally spaced `factors` (F,) of
    friction, see `landing.land`.

    `change_chain` (C, H): number of the transient of a command in a mode, −1 where there is none; of commands 2·d − 2
    goes down, 2·d − 1 up by d stages. `end_mode`: the mode that each transient leads to.
    """

    change_chain: Ints
    end_mode: Ints
    ends: Floats
    factors: Floats


class ChainArrays(NamedTuple):
    """All but policy, scenario and cost.

    `decision_at` (N,): number of the decision at a node, R or more where there is none. `period`, s, between decisions;
    0 where the next decision is a place. `entry` (M + 1, E): probability of entering with speed j and having the first
    sample at node r.
    """

    grid: Grid
    track: Track
    modes: Modes
    noise: PathNoise
    transient_noise: TransientNoise
    landings: Landings
    decision_at: Ints
    period: float
    entry: Floats


class Scenarios(NamedTuple):
    """What is hidden in I scenarios (I,): friction factor ξ_cut, and `extra` acceleration by the running resistance."""

    factor: Floats
    extra: Floats


class Scenario(NamedTuple):
    """One of them, with its tables from `landing_plan.landing_tables`: `met` (·, r, L, L, 2, 6), `slope` (H, L, N)."""

    factor: float
    extra: float
    met: Floats
    slope: Floats


class Change(NamedTuple):
    """A change of stage from path node `node`, decision number `decision`, at noise level `level`, by `transient` to
    the resting `mode`.

    `left` quanta until S_exit. `least_ahead`: least share of what lands that is decided on at the node ahead of it.
    """

    node: int
    decision: int
    level: int
    transient: int
    mode: int
    left: int
    least_ahead: float


@part_inline
def change_at(chain, n, decision, level, transient):
    """The change of stage at node `n`."""
    # Where the next decision is a place and not a time away, the cut rolls on to the node ahead.
    least_ahead = 0.0 if chain.period > 0.0 else 1.0
    left = chain.track.drive.shape[0] - n
    return Change(n, decision, level, transient, chain.landings.end_mode[transient], left, least_ahead)
