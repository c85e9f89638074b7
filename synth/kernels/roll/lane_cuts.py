"""Kernel that lays cuts of different numbers of cars, each on a route of its own, side by side for the free roll."""

from __future__ import annotations

from typing import NamedTuple

from plant_models.frozen_arrays import Floats, Ints
from synth.kernels.compiling import borrowing
from synth.kernels.roll.felt_track import LANES


class RouteRows(NamedTuple):
    """Routes: `rows_from` (routes,): first place of their tables in `Way.fall_m`, flat; `ends_m` (routes,); arrays
    of bends (routes, bends) as in `Cuts`; `v2_scale`, `head_scale`: heads that bends take from a draw of 1, 0 where
    there are no more bends."""

    rows_from: Ints
    ends_m: Floats
    bends_from_m: Floats
    bends_to_m: Floats
    bends_per_m: Floats
    v2_scale: Floats
    head_scale: Floats


class CutRows(NamedTuple):
    """Cuts as in `Cuts`, but a cut a row: arrays of cars (n, cars), of cuts (n,), of bends (n, bends). `rows`: first
    place of each car's type in the tables of its route, flat. `v2_draws`, `head_draws`: of bends."""

    cars: Ints
    rows: Ints
    shares: Floats
    nodes: Floats
    middles_m: Floats
    length_m: Floats
    long_steps: Floats
    gravity_m_s2: Floats
    constant: Floats
    air: Floats
    wind_m_s: Floats
    v2_draws: Floats
    head_draws: Floats


@borrowing
def lay_in_lanes(cuts, routes, cut_of, route_of, lanes, first, last):
    """Fill lanes `first` … `last` − 1, multiples of `LANES`, of `lanes` (`Cuts`; its `constant` stands already): lane k
    is the cut `cut_of[k]` on the route `route_of[k]`."""
    for i in range(first, last, LANES):
        most = 1
        for k in range(i, i + LANES):
            most = max(most, cuts.cars[cut_of[k]])
        lanes.cars_of_pack[i // LANES] = most
        for k in range(i, i + LANES):
            row, route = cut_of[k], route_of[k]
            for j in range(most):
                lanes.rows[j, k] = routes.rows_from[route] + cuts.rows[row, j]
                lanes.shares[j, k] = cuts.shares[row, j]
                lanes.nodes[j, k] = cuts.nodes[row, j]
                lanes.middles_m[j, k] = cuts.middles_m[row, j]
            lanes.length_m[k] = cuts.length_m[row]
            lanes.long_steps[k] = cuts.long_steps[row]
            lanes.gravity_m_s2[k] = cuts.gravity_m_s2[row]
            lanes.air[k] = cuts.air[row]
            lanes.wind_m_s[k] = cuts.wind_m_s[row]
            for b in range(lanes.bend_v2.shape[0]):
                lanes.bends_from_m[b, k] = routes.bends_from_m[route, b]
                lanes.bends_to_m[b, k] = routes.bends_to_m[route, b]
                lanes.bends_per_m[b, k] = routes.bends_per_m[route, b]
                lanes.bend_v2[b, k] = cuts.v2_draws[row, b] * routes.v2_scale[route, b]
                lanes.bend_head[b, k] = cuts.head_draws[row, b] * routes.head_scale[route, b]
