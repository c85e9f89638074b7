"""The track as rolling cuts feel it, sixteen cuts side by side: how far they have fallen, and what bends take."""

from __future__ import annotations

from typing import Any, NamedTuple

from plant_models.frozen_arrays import Floats, Ints
from synth.kernels.compiling import part_inline
from synth.kernels.vector import packs

LANES = packs.SIXTEEN
"""Cuts side by side: two packs of the machine, because each waits most of the time for roots and divisions."""


class Way(NamedTuple):
    """The track as each type of car feels it: `fall_m` (types, nodes) is the mean fall of its axles, less the head that
    resistance beyond that of the cut takes there, at node / `nodes_per_m` metres behind the first node.
    `fall_m2` (types, nodes): the fall summed up over the path from the first node.
    `gentlest` (types, nodes): least fall per metre of a car that is between the crest and the node, or just behind it.
    Several tracks stand one below the other."""

    nodes_per_m: float
    fall_m: Floats
    fall_m2: Floats
    gentlest: Floats


class Cuts(NamedTuple):
    """n cuts, a multiple of `LANES`: arrays of cars (cars, n), of cuts (n,), of bends (bends, n).

    `cars_of_pack` (n / LANES,): cars of the longest cut of each pack; others have a share of 0 there. `rows`: first
    place of each car's type in `fall_m`, flat. `nodes`: from the front coupler of each car to where the head is at the
    first node, in nodes. `middles_m`: of cars, behind the head. `long_steps`: longest step over that of a single car.
    `constant` and `air`: heads per metre. `bends_from_m`, `bends_to_m`: where bends begin and end; `bends_per_m`: one
    over their lengths; all three of one pack if they hold for all.
    """

    cars_of_pack: Ints
    rows: Ints
    shares: Floats
    nodes: Floats
    middles_m: Floats
    length_m: Floats
    long_steps: Floats
    gravity_m_s2: Floats
    constant: Floats
    linear: float
    air: Floats
    wind_m_s: Floats
    bends_from_m: Floats
    bends_to_m: Floats
    bends_per_m: Floats
    bend_v2: Floats
    bend_head: Floats


class Lanes(NamedTuple):
    """What the cuts from `i` on are; `cars` at most, their bends from `bends` on."""

    i: int
    cars: int
    bends: int
    length_m: Any
    long_steps: Any
    gravity_m_s2: Any
    constant: Any
    air: Any
    wind_m_s: Any


@part_inline
def lanes_from(cuts, i):
    """The cuts from `i` on."""
    return Lanes(
        i,
        packs.item(cuts.cars_of_pack, i // LANES),
        i % cuts.bends_from_m.shape[1],
        packs.load16(cuts.length_m, i),
        packs.load16(cuts.long_steps, i),
        packs.load16(cuts.gravity_m_s2, i),
        packs.load16(cuts.constant, i),
        packs.load16(cuts.air, i),
        packs.load16(cuts.wind_m_s, i),
    )


@part_inline
def place_of(way, cuts, at, x):
    """(node, nodes beyond it) of the cars at flat index `at` with the heads at `x`; at most 1 beyond it, but outside
    the table, where the fall goes on as at its end."""
    place = x * way.nodes_per_m - packs.load16(cuts.nodes, at)
    node = packs.whole(packs.least(packs.greatest(place, 0.0), way.fall_m.shape[1] - 1.5))
    return node, place - packs.fraction(node)


@part_inline
def fall_at(way, cuts, lanes, x):
    """(fall of the cuts when their heads are at `x`, metres; the same summed up over the path)."""
    fall, total = packs.choose(x == x, 0.0, x), packs.choose(x == x, 0.0, x)
    for j in range(lanes.cars):
        at = j * cuts.shares.shape[1] + lanes.i
        node, beyond = place_of(way, cuts, at, x)
        where = packs.load16(cuts.rows, at) + node
        low, high = packs.gather(way.fall_m, where), packs.gather(way.fall_m, where + 1)
        rise, share = beyond * (high - low), packs.load16(cuts.shares, at)
        fall = fall + share * (low + rise)
        path = beyond * (1.0 / way.nodes_per_m)
        total = total + share * (packs.gather(way.fall_m2, where) + path * (low + 0.5 * rise))
    return fall, total


@part_inline
def bend_at(cuts, lanes, b):
    """Where the bend `b` of the lanes begins and ends, and one over its length."""
    at = b * cuts.bends_from_m.shape[1] + lanes.bends
    return (
        packs.load16(cuts.bends_from_m, at),
        packs.load16(cuts.bends_to_m, at),
        packs.load16(cuts.bends_per_m, at),
    )


@part_inline
def bends_between(way, cuts, lanes, x, h):
    """Heads that the bends take while the heads go from `x` to `x` + `h`: (per (m/s)², whatever the speed), and by how
    much their mean on the way is above half of them, (per (m/s)², whatever the speed).

    Each car meets a bend with its middle.
    """
    count, none = cuts.shares.shape[1], packs.choose(x == x, 0.0, x)
    v2, head, early_v2, early_head = none, none, none, none
    for b in range(cuts.bends_from_m.shape[0]):
        begins, ends, per_m = bend_at(cuts, lanes, b)
        if packs.holds_anywhere((x + h > begins) & (x - lanes.length_m < ends)):
            part, early = none, none
            for j in range(lanes.cars):
                middle = x - packs.load16(cuts.middles_m, j * count + lanes.i)
                enters, leaves = packs.greatest(middle, begins), packs.least(middle + h, ends)
                inside = packs.load16(cuts.shares, j * count + lanes.i) * packs.greatest(leaves - enters, 0.0)
                part = part + inside
                early = early + inside * (0.5 * h + middle - 0.5 * (enters + leaves))
            part, early = part * per_m, early * per_m / h
            of_v2 = packs.load16(cuts.bend_v2, b * count + lanes.i)
            whatever = packs.load16(cuts.bend_head, b * count + lanes.i)
            v2, head = v2 + part * of_v2, head + part * whatever
            early_v2, early_head = early_v2 + early * of_v2, early_head + early * whatever
    return v2, head, early_v2, early_head


@part_inline
def start_by_themselves(way, cuts, lanes, x, target):
    """The lanes that start from rest wherever their heads are from `target` to `x`; False where that is not certain."""
    won = packs.choose(x == x, 0.0, x)
    for j in range(lanes.cars):
        at = j * cuts.shares.shape[1] + lanes.i
        node, _ = place_of(way, cuts, at, x)
        won = won + packs.load16(cuts.shares, at) * packs.gather(way.gentlest, packs.load16(cuts.rows, at) + node)
    lost = lanes.constant + lanes.air * lanes.wind_m_s * packs.magnitude(lanes.wind_m_s)
    for b in range(cuts.bends_from_m.shape[0]):
        begins, ends, per_m = bend_at(cuts, lanes, b)
        meets = (x > begins) & (target - lanes.length_m < ends)
        head = packs.load16(cuts.bend_head, b * cuts.shares.shape[1] + lanes.i)
        lost = lost + packs.choose(meets, head * per_m, 0.0)
    return (won > lost) & (target > lanes.length_m)
