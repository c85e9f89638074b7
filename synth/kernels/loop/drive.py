"""What the drive of a retarder plays while it is commanded at rest: its modes and chains, and these as pieces."""

from __future__ import annotations

from typing import NamedTuple

from plant_models.frozen_arrays import Floats, Ints


class Drive(NamedTuple):
    """Resting modes and chains of the actuator (`stage_regulator.Actuator`, same names).

    A pass begins at `initial_mode` of `initial_stage`; before the entrance no higher stage than `entrance_stage` is
    commanded, whatever the law.
    """

    mode_overpressure_kpa: Floats
    command: Ints
    chain_mode: Ints
    chain_samples: Ints
    chain_overpressure_kpa: Floats
    substeps: int
    initial_mode: int
    initial_stage: int
    entrance_stage: int


class Pieces(NamedTuple):
    """Pieces of constant overpressure, one after the other: what the drive plays (P of them).

    Piece 0 is before the first sample; a resting mode is one piece of a sampling period that is followed by itself, a
    chain several that end in a resting mode. Pieces below `resting` are at rest (1 + mode), those below `sampled` begin
    a sample, at rest or within a chain. `kpa`, `duration_s`, `after` (P,): overpressure, duration (that of piece 0 is
    each pass's own, noted as 0) and the piece that follows; `start_s` (P,) since the sample that it begins in;
    `mean_kpa` (P,): mean overpressure of the sampling period, noted with the first piece of each.
    `command` (modes, K + 1): first piece of the chain to a stage. `initial_stage`, `entrance_stage` as in `Drive`.
    """

    kpa: Floats
    duration_s: Floats
    start_s: Floats
    mean_kpa: Floats
    after: Ints
    command: Ints
    resting: int
    sampled: int
    initial_stage: int
    entrance_stage: int
