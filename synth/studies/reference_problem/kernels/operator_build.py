"""The stage operator of the reference problem as short rows of weights, sixteen neighbouring speeds at a time.

The noise moves the speed only, so for one (pressure i, command u) all outcomes fall on the same two pressure rows and
merge into one row of weights over neighbouring speeds. A *unit* is one (i, u) for a block of 16 speeds j: its weights
are `count` vectors, lane by lane applied to the value at speed index `offset` + lane, `offset` + 1 + lane, …; and the
pressure rows that its lanes need are `rows` from `first row` on. Clipping is done on the index, not on the speed: a
speed one rounding error beyond the grid's edge would lose weight. A *chunk* is a group of pressures of one block; its
units are numbered by pressure and command.

`plan` int32 (chunks·units, 6) holds of each unit: which unit of its chunk comes at this place in the order of work,
first row, rows, offset, count, first weight vector. Everything is handed on by pointers: arrays would bring their
reference counts into every call.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numba import njit

from synth.studies.reference_problem.kernels.vectors import (
    LANES,
    choose,
    lane_numbers,
    larger,
    largest_lane,
    load,
    magnitude,
    multiply_add,
    pointer,
    root,
    smaller,
    smallest_lane,
    splat,
    store,
)

ORDER, FIRST_ROW, ROWS, OFFSET, COUNT, START = range(6)
COLUMNS = 6


class Sizes(NamedTuple):
    """Numbers of everything: `group` pressures a chunk, `units` a chunk, `width` speeds with those that fill blocks."""

    stages: int
    targets: int
    pressures: int
    speeds: int
    commands: int
    frictions: int
    drives: int
    group: int
    units: int
    width: int
    stride: int

    @property
    def chunks(self) -> int:
        """Blocks of speeds times groups of pressures; for the caller, kernels count them by `chunks_of`."""
        return self.width // LANES * -(-self.pressures // self.group)


class Physics(NamedTuple):
    """Float32 arrays, or pointers to them; frictions μ > 0 and drives ascending.

    `speed` (width,) m/s, padded by its last; `retention` (2, width): share of the pressure difference left after a
    step, rising and falling; `commands` in pressure rows; `drive` 2·h·a0; `chance` (frictions·drives,), μ slowest;
    `scales` 2·h·c per half row, 2·h·c·dead pressure, lowest speed squared, speed points per m/s.
    """

    speed: Any
    retention: Any
    commands: Any
    friction: Any
    drive: Any
    chance: Any
    scales: Any


@njit(cache=True, nogil=True, error_model="numpy")
def pointers_to(physics):
    """The same physics by pointers; the caller holds the arrays."""
    return Physics(
        pointer(physics.speed), pointer(physics.retention), pointer(physics.commands), pointer(physics.friction),
        pointer(physics.drive), pointer(physics.chance), pointer(physics.scales),
    )  # fmt: skip


@njit(cache=True, nogil=True, error_model="numpy")
def groups_of(sizes):
    """Chunks a block."""
    return (sizes.pressures + sizes.group - 1) // sizes.group


@njit(cache=True, nogil=True, error_model="numpy")
def chunks_of(sizes):
    """Chunks of the whole operator."""
    return sizes.width // LANES * groups_of(sizes)


@njit(cache=True, nogil=True, error_model="numpy")
def pressure_after(block, i, u, physics, sizes):
    """P' after one step, in rows, for the lanes of a block."""
    away = i - physics.commands[u]
    rising_or_falling = 0 if away < 0.0 else sizes.width
    kept = load(physics.retention, rising_or_falling + block * LANES)
    return multiply_add(splat(away), kept, splat(physics.commands[u]))


@njit(cache=True, nogil=True, error_model="numpy")
def braking(i, after, physics):
    """2·h·b for μ = 1: of the mean of the pressures before and after the step, less the dead pressure."""
    return larger(multiply_add(splat(physics.scales[0]), splat(i) + after, splat(-physics.scales[1])), splat(0.0))


@njit(cache=True, nogil=True, error_model="numpy")
def points_gained(v, brake, friction, drive, block, physics, sizes):
    """Change of speed in one step, in speed points, clipped so that lane l, index 16·block + l, stays on the grid.

    By (V'² − V²) / (V' + V): the difference of V' and V would lose the last digits.
    """
    change = multiply_add(splat(-friction), brake, splat(drive))
    after = root(larger(multiply_add(v, v, change), splat(physics.scales[2])))
    gained = change * splat(physics.scales[3]) / (v + after)
    low, high = splat(-LANES * block), splat(sizes.speeds - 1 - LANES * block)
    return smaller(larger(gained, low - lane_numbers()), high - lane_numbers())


@njit(cache=True, nogil=True, error_model="numpy")
def window(v, least_brake, most_brake, block, physics, sizes):
    """First speed point, relative to the lane's own, and number of points that all outcomes of all lanes need."""
    strongest, fastest = physics.friction[sizes.frictions - 1], physics.drive[sizes.drives - 1]
    low = points_gained(v, most_brake, strongest, physics.drive[0], block, physics, sizes)
    high = points_gained(v, least_brake, physics.friction[0], fastest, block, physics, sizes)
    first = math.floor(smallest_lane(low))
    return first, math.ceil(largest_lane(high)) - first + 1


@njit(cache=True, nogil=True, error_model="numpy")
def reserve(physics, sizes, begin):
    """Where the weights of each chunk begin at the latest; `begin` (chunks + 1,) in vectors.

    No window of a block is wider than from the hardest braking to none at all; two more are for rounding.
    """
    by_pointer = pointers_to(physics)
    top = sizes.pressures - 1
    hardest = braking(top, splat(top), by_pointer)
    begin[0] = 0
    for chunk in range(begin.shape[0] - 1):
        block = chunk // groups_of(sizes)
        v = load(by_pointer.speed, block * LANES)
        _, width = window(v, splat(0.0), hardest, block, by_pointer, sizes)
        begin[chunk + 1] = begin[chunk] + sizes.units * (width + 2)


@njit(cache=True, nogil=True, error_model="numpy")
def build_chunk(chunk, begin, physics, sizes, plan, weights, position, landing, keys):
    """Plan one chunk and fill its weights, from vector `begin` on, and the pressure positions from the first row.

    `weights` (vectors·16,), `position` (chunks·units·16,); `landing` (frictions·drives·16,) and `keys` (units,) int64
    are scratch.
    """
    block, first = chunk // groups_of(sizes), chunk % groups_of(sizes) * sizes.group
    plan_chunk(chunk, block, first, begin, physics, sizes, plan, keys)
    v = load(physics.speed, block * LANES)
    for slot in range(sizes.units):
        unit = (chunk * sizes.units + slot) * COLUMNS
        if plan[unit + ROWS] == 0:
            continue
        i, u = first + slot // sizes.commands, slot % sizes.commands
        after = pressure_after(block, i, u, physics, sizes)
        brake = braking(i, after, physics)
        store(position, (chunk * sizes.units + slot) * LANES, after - splat(plan[unit + FIRST_ROW]))
        base, top = splat(plan[unit + OFFSET] - block * LANES), splat(plan[unit + COUNT] - 1)
        outcome = 0
        for m in range(sizes.frictions):
            for a in range(sizes.drives):
                gained = points_gained(v, brake, physics.friction[m], physics.drive[a], block, physics, sizes)
                store(landing, outcome * LANES, smaller(larger(gained - base, splat(0.0)), top))
                outcome += 1
        merge_outcomes(landing, physics.chance, outcome, plan[unit + COUNT], weights, plan[unit + START] * LANES)


@njit(cache=True, nogil=True, error_model="numpy")
def merge_outcomes(landing, chance, outcomes, count, weights, start):
    """Weight of each of `count` speeds: the hat functions of linear interpolation at all landings, added up.

    The weights of a lane add up to one exactly, for a state that leads to itself multiplies an error of the sum at
    every stage: they are whole multiples of 2⁻²⁴, whose sums float32 holds, and the largest takes up the rest.
    """
    rest, largest = splat(1.0), splat(0.0)
    for k in range(count):
        here, total = splat(k), splat(0.0)
        for outcome in range(outcomes):
            near = larger(splat(1.0) - magnitude(load(landing, outcome * LANES) - here), splat(0.0))
            total = multiply_add(splat(chance[outcome]), near, total)
        total = (total + splat(0.5)) - splat(0.5)
        rest, largest = rest - total, larger(largest, total)
        store(weights, start + k * LANES, total)
    for k in range(count):
        weight = load(weights, start + k * LANES)
        store(weights, start + k * LANES, choose(weight, largest, weight, weight + rest))
        rest = choose(weight, largest, rest, splat(0.0))


@njit(cache=True, nogil=True, error_model="numpy")
def plan_chunk(chunk, block, first, begin, physics, sizes, plan, keys):
    """Shapes of the units of a chunk, which begins at pressure `first`, and the order of work.

    Units of equal rows and count follow each other, so that the processor foresees how often their loops turn.
    Pressures beyond the last, where the group does not divide them, are units without rows.
    """
    v = load(physics.speed, block * LANES)
    for slot in range(sizes.units):
        unit = (chunk * sizes.units + slot) * COLUMNS
        i, u = first + slot // sizes.commands, slot % sizes.commands
        rows = count = 0
        if i < sizes.pressures:
            after = pressure_after(block, i, u, physics, sizes)
            brake = braking(i, after, physics)
            lowest = math.floor(smallest_lane(after))
            rows = math.ceil(largest_lane(after)) - lowest + 1
            gained, count = window(v, brake, brake, block, physics, sizes)
            plan[unit + FIRST_ROW], plan[unit + OFFSET] = lowest, gained + block * LANES
        plan[unit + ROWS], plan[unit + COUNT] = rows, count
        key = (np.int64(rows) * 65536 + count) * 65536 + slot
        at = slot
        while at > 0 and keys[at - 1] > key:
            keys[at] = keys[at - 1]
            at -= 1
        keys[at] = key
    for at in range(sizes.units):
        slot = keys[at] % 65536
        plan[(chunk * sizes.units + at) * COLUMNS + ORDER] = slot
        unit = (chunk * sizes.units + slot) * COLUMNS
        plan[unit + START] = begin
        begin += plan[unit + COUNT]
