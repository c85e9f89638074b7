"""A plant that is commanded at every sample, as a Markov chain, as the passes over it take it.

N path quanta, E energies in rows of E' ≥ E, M modes of the drive, L levels of the path noise, D periods, W ways.
"""

from __future__ import annotations

from typing import NamedTuple

from plant_models.frozen_arrays import Floats, Ints


class Motion(NamedTuple):
    """A sampling period of motion: `quanta` (E',) that it is long at each speed, `longer` = period² / 2ΔS, steps of
    path ΔS and energy Δe, `bands` (R + 2,): the first energy of each middle node.

    `drive`, `brake`: integrals over the path up to each node (N + 1,); behind the exit nothing changes energy.
    """

    quanta: Floats
    longer: float
    path_step: float
    energy_step: float
    bands: Ints
    drive: Floats
    brake: Floats


class Periods(NamedTuple):
    """The different sampling periods that a drive can be in, and where they lead.

    `of_mode` (M, 3): number of the period that follows a command in a mode, −1 where there is none; `kpa` (D,) mean
    overpressure of each, `way` (D,) where it leads. `target`, `share` (W, 4): modes, and shares of each, that stand for
    the drive at the end of a way; the last way leads to the mode at the entry.
    """

    of_mode: Ints
    kpa: Floats
    way: Ints
    target: Ints
    share: Floats


class Entry(NamedTuple):
    """`chance` (A, E): probability of entering with energy j and having the first sample at node r; `way` and pressure
    `kpa` until then."""

    chance: Floats
    way: int
    kpa: float


class SampledArrays(NamedTuple):
    """All but policy, scenario and cost; `stationary` (L,), `mixing` (L, L, E') of the path noise after a period."""

    periods: Periods
    entry: Entry
    stationary: Floats
    mixing: Floats
    motion: Motion


class Lines(NamedTuple):
    """`lines` (2, N, M): below and above them the command is down and up, in readings; `reading` (E',) of the true
    speeds, with errors of std `noise` (N,)."""

    lines: Floats
    reading: Floats
    noise: Floats


class Met(NamedTuple):
    """States that a forward pass met: `band` (N, M, 2), `way_band` (N, W, 2) ranges of energies; `where` (N, M): begin
    of a mode's record in `records`.

    A record is whole packs from the first energy on: the density of every level, the chances of down and up.
    """

    records: Floats
    band: Ints
    where: Ints
    way_band: Ints


class Costs(NamedTuple):
    """`terminal` (E,) cost by exit energy, `stalled` of a stall, of a `command`, of the time of a `period`."""

    terminal: Floats
    stalled: float
    command: float
    period: float
