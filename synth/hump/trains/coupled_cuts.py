"""Cuts that roll on as one, coupled: their cars one behind the other, what holds each up weighted by its mass."""

from __future__ import annotations

from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from plant_models.frozen_arrays import Floats, Ints, read_only
from synth.kernels.roll.lane_cuts import CutRows
from synth.simulation.free_roll import long_steps

Number = TypeVar("Number", bound=np.generic)


def coupled_rows(cuts: CutRows, members: Ints, mass_t: Floats, nodes_per_m: float) -> CutRows:
    """The cuts `members` (n, k), rows of `cuts` with the first ahead, −1 behind the last one, as n cuts; `mass_t`
    (rows,).

    Every force is the sum of those of the members, but the air is taken to be met with one head wind: the one that
    gives the right force as far as it grows with the speed. One bend holds all of it up alike.
    """
    there, of = members >= 0, np.maximum(members, 0)
    weights = np.where(there, mass_t[of], 0.0)
    total = in_turn(weights)
    shares = weights / total[:, None]
    lengths = np.where(there, cuts.length_m[of], 0.0)
    offsets = np.concatenate((np.zeros((len(of), 1)), np.cumsum(lengths, axis=1)[:, :-1]), axis=1)
    air = shares * cuts.air[of]
    alone = ~there[:, 1:].any(axis=1)
    first = of[:, 0]
    met = in_turn(air * (cuts.wind_m_s[of] - cuts.wind_m_s[first][:, None]))
    gravity = 1.0 / in_turn(shares / cuts.gravity_m_s2[of])
    number = np.where(there, cuts.cars[of], 0).sum(axis=1)
    behind = (offsets * nodes_per_m)[:, :, None]
    real = (np.arange(cuts.shares.shape[1]) < cuts.cars[of][:, :, None]) & there[:, :, None]
    order = np.argsort(~real.reshape(len(of), -1), axis=1, kind="stable")[:, : int(number.max(initial=1))]

    def of_cars(values: NDArray[Number]) -> NDArray[Number]:
        return np.take_along_axis(values.reshape(len(of), -1), order, axis=1)

    return CutRows(
        cars=number,
        rows=of_cars(np.where(real, cuts.rows[of], 0)),
        shares=of_cars(np.where(real, cuts.shares[of] * shares[:, :, None], 0.0)),
        nodes=of_cars(np.where(real, cuts.nodes[of] + behind, cuts.nodes[first][:, :1, None])),
        middles_m=of_cars(np.where(real, cuts.middles_m[of] + offsets[:, :, None], 0.0)),
        length_m=in_turn(lengths),
        long_steps=long_steps(number),
        gravity_m_s2=np.where(alone, cuts.gravity_m_s2[first], gravity),
        constant=in_turn(shares * cuts.constant[of]),
        air=in_turn(air),
        # Read-only as those of single cuts: kernels are compiled once for both.
        wind_m_s=read_only(cuts.wind_m_s[first] + met / np.maximum(in_turn(air), 1e-300)),
        v2_draws=read_only(in_turn(shares[:, :, None] * cuts.v2_draws[of])),
        head_draws=read_only(in_turn(shares[:, :, None] * cuts.head_draws[of])),
    )


def in_turn(values: Floats) -> Floats:
    """Sums over the second axis, first to last: members that are not there change no bit."""
    total = values[:, 0].copy()
    for k in range(1, values.shape[1]):
        total += values[:, k]
    return total
