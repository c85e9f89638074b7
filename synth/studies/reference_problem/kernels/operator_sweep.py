"""Backward induction of the reference problem over an operator of short rows, for one thread of several.

The value lies in a flat float32 array: target t, pressure i, speed j at (t·pressures + i)·stride + MARGIN + j, with
zeros around, because a window may reach beyond the grid's edge with weights of zero. Two such arrays take turns.
"""

from __future__ import annotations

from numba import njit

from synth.studies.reference_problem.kernels.operator_build import (
    COLUMNS,
    COUNT,
    FIRST_ROW,
    OFFSET,
    ORDER,
    ROWS,
    START,
    build_chunk,
    chunks_of,
    groups_of,
    pointers_to,
)
from synth.studies.reference_problem.kernels.shared_work import finish, take, wait
from synth.studies.reference_problem.kernels.vectors import (
    LANES,
    choose,
    larger,
    load,
    magnitude,
    multiply_add,
    pointer,
    smaller,
    splat,
    store,
    store_bytes,
)

MARGIN = 16
"""Zeros before each row: a window may begin up to 15 speeds before the grid."""
OVERHANG = 48
"""Zeros after the last row: a window may end up to 15 speeds behind the grid, its last lane 15 further."""


@njit(cache=True, nogil=True, error_model="numpy")
def solve_share(thread, threads, taken, done, begin, physics, sizes, plan, weights, position, scratch, value, policy):
    """One thread's share of a solve: build the operator, then all stages, for all targets.

    `physics`, `sizes`, `plan`, `weights`, `position`: see `operator_build`; `begin` from `reserve`; `taken`, `done`:
    see `shared_work`, stages + 1 phases; `scratch` of this thread: landings (frictions·drives·16,), keys (units,)
    int64, expected values (2·units·16,). `value` (2, targets·pressures·stride + OVERHANG): on entry [0] holds the
    terminal cost, at the end [stages % 2] the value at entry. `policy` uint8 (targets, stages, pressures·width):
    stage n of the path, entry first, the smallest of equally good commands.
    """
    chunks = chunks_of(sizes)
    by_pointer = pointers_to(physics)
    landing, keys = pointer(scratch[0]), pointer(scratch[1])
    flat = (pointer(plan), pointer(weights), pointer(position), pointer(value), pointer(scratch[2]))
    best = pointer(policy)
    chunk = take(taken, 0, thread, threads, chunks)
    while chunk >= 0:
        build_chunk(chunk, begin[chunk], by_pointer, sizes, flat[0], flat[1], flat[2], landing, keys)
        finish(done, 0)
        chunk = take(taken, 0, thread, threads, chunks)
    wait(done, 0, chunks)
    for stage in range(1, sizes.stages + 1):
        before, after = (stage - 1) % 2 * value.shape[1], stage % 2 * value.shape[1]
        chunk = take(taken, stage, thread, threads, chunks)
        while chunk >= 0:
            sweep_chunk(chunk, sizes, flat, before, after, best, sizes.stages - stage)
            finish(done, stage)
            chunk = take(taken, stage, thread, threads, chunks)
        wait(done, stage, chunks)


@njit(cache=True, nogil=True, error_model="numpy")
def sweep_chunk(chunk, sizes, flat, before, after, policy, stage):
    """Value and best command of one chunk for all targets, two at a time.

    `flat` are the pointers to plan, weights, positions, values and scratch; the values of the stage behind begin at
    `before`, those of this stage go to `after`.
    """
    block, first = chunk // groups_of(sizes), chunk % groups_of(sizes) * sizes.group
    rows = min(sizes.group, sizes.pressures - first)
    stride, plane = sizes.stride, sizes.pressures * sizes.stride
    for t in range(0, sizes.targets, 2):
        pair = min(2, sizes.targets - t)
        if pair == 2:
            expect_two(chunk * sizes.units, sizes.units, flat, before + t * plane + MARGIN, stride, plane)
        else:
            expect_one(chunk * sizes.units, sizes.units, flat, before + t * plane + MARGIN, stride)
        for side in range(pair):
            to = after + (t + side) * plane + first * stride + MARGIN + block * LANES
            chosen = (((t + side) * sizes.stages + stage) * sizes.pressures + first) * sizes.width + block * LANES
            for row in range(rows):
                at = (side * sizes.units + row * sizes.commands) * LANES
                choose_best(flat[4], at, sizes.commands, flat[3], to + row * stride, policy, chosen + row * sizes.width)


@njit(cache=True, nogil=True, error_model="numpy")
def choose_best(expected, at, commands, value, to, policy, chosen):
    """Write the least of the commands' values at `at`, and which it is."""
    best, command = load(expected, at), splat(0.0)
    for u in range(1, commands):
        other = load(expected, at + u * LANES)
        command = choose(other, best, splat(u), command)
        best = smaller(other, best)
    store(value, to, best)
    store_bytes(policy, chosen, command)


@njit(cache=True, nogil=True, error_model="numpy")
def expect_one(begin, units, flat, origin, stride):
    """Expected value of each unit from `begin` on, for the target whose value begins at `origin`."""
    plan, weights, position, value, expected = flat
    for at in range(begin, begin + units):
        slot = plan[at * COLUMNS + ORDER]
        unit = (begin + slot) * COLUMNS
        place = load(position, (begin + slot) * LANES)
        row = origin + plan[unit + FIRST_ROW] * stride + plan[unit + OFFSET]
        start, count, rows = plan[unit + START] * LANES, plan[unit + COUNT], plan[unit + ROWS]
        if rows == 2:
            low, high = sum_two(weights, start, count, value, row, row + stride)
            store(expected, slot * LANES, multiply_add(place, high - low, low))
            continue
        total = splat(0.0)
        for r in range(0, rows - 1, 2):
            low, high = sum_two(weights, start, count, value, row + r * stride, row + (r + 1) * stride)
            total = multiply_add(share(place, r), low, total)
            total = multiply_add(share(place, r + 1), high, total)
        if rows % 2 == 1:
            last = sum_one(weights, start, count, value, row + (rows - 1) * stride)
            total = multiply_add(share(place, rows - 1), last, total)
        store(expected, slot * LANES, total)


@njit(cache=True, nogil=True, error_model="numpy")
def expect_two(begin, units, flat, origin, stride, other):
    """The same for two targets, `other` apart, which share every weight; equal, bit for bit, to one at a time."""
    plan, weights, position, value, expected = flat
    for at in range(begin, begin + units):
        slot = plan[at * COLUMNS + ORDER]
        unit = (begin + slot) * COLUMNS
        place = load(position, (begin + slot) * LANES)
        row = origin + plan[unit + FIRST_ROW] * stride + plan[unit + OFFSET]
        start, count, rows = plan[unit + START] * LANES, plan[unit + COUNT], plan[unit + ROWS]
        if rows == 2:
            a, b, c, d = sum_four(weights, start, count, value, row, row + stride, row + other, row + other + stride)
            store(expected, slot * LANES, multiply_add(place, b - a, a))
            store(expected, (units + slot) * LANES, multiply_add(place, d - c, c))
            continue
        one, two = splat(0.0), splat(0.0)
        for r in range(0, rows - 1, 2):
            here, above = row + r * stride, row + (r + 1) * stride
            a, b, c, d = sum_four(weights, start, count, value, here, above, here + other, above + other)
            near, far = share(place, r), share(place, r + 1)
            one, two = multiply_add(near, a, one), multiply_add(near, c, two)
            one, two = multiply_add(far, b, one), multiply_add(far, d, two)
        if rows % 2 == 1:
            last = row + (rows - 1) * stride
            a, c = sum_two(weights, start, count, value, last, last + other)
            near = share(place, rows - 1)
            one, two = multiply_add(near, a, one), multiply_add(near, c, two)
        store(expected, slot * LANES, one)
        store(expected, (units + slot) * LANES, two)


@njit(cache=True, nogil=True, error_model="numpy")
def share(place, row):
    """Weight of pressure row `row` (from the first) in linear interpolation at `place`."""
    return larger(splat(1.0) - magnitude(place - splat(row)), splat(0.0))


@njit(cache=True, nogil=True, error_model="numpy")
def sum_one(weights, start, count, value, a):
    """Σ weights[start + 16·k + lane] · value[a + k + lane] over k < `count`."""
    p = splat(0.0)
    for k in range(count):
        p = multiply_add(load(weights, start + k * LANES), load(value, a + k), p)
    return p


@njit(cache=True, nogil=True, error_model="numpy")
def sum_two(weights, start, count, value, a, b):
    """The same for the rows beginning at `a` and `b`; every weight is loaded once."""
    p, q = splat(0.0), splat(0.0)
    for k in range(count):
        weight = load(weights, start + k * LANES)
        p = multiply_add(weight, load(value, a + k), p)
        q = multiply_add(weight, load(value, b + k), q)
    return p, q


@njit(cache=True, nogil=True, error_model="numpy")
def sum_four(weights, start, count, value, a, b, c, d):
    """The same for four rows."""
    p, q, r, s = splat(0.0), splat(0.0), splat(0.0), splat(0.0)
    for k in range(count):
        weight = load(weights, start + k * LANES)
        p = multiply_add(weight, load(value, a + k), p)
        q = multiply_add(weight, load(value, b + k), q)
        r = multiply_add(weight, load(value, c + k), r)
        s = multiply_add(weight, load(value, d + k), s)
    return p, q, r, s
