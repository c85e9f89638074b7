"""The value of one change of stage from all energies and for all targets.

Where a cut lands does not depend on the target speed; only the value there does. So landings are planned once
(`landing_plan`) and the targets, side by side in memory in packs of eight, are interpolated with the same weights.
"""

from __future__ import annotations

from synth.kernels.compiling import part, part_inline
from synth.kernels.sweep.landing_plan import (
    ahead_of,
    first_end,
    landing_of_pack,
    law_met,
    planned,
    ring_from,
    store_plan,
)
from synth.kernels.vector.packs import EIGHT, item, load8, store


@part
def add_transient_values(change, count, ends, grid, scenario, values, mixed, stalled, scratch, out):
    """Add to `out` (E·T,) the expected value after a change of stage.

    `values` (ring, H, L, E·T) at a sample and `mixed` before the noise level changes; `stalled` (T,), T whole packs of
    eight; `count` runs in `scratch`, from `find_runs`; the rest as in `chain_arrays`.
    """
    _, runs, place, weight = scratch
    size, width, points = values.shape[2], stalled.shape[0], grid.speed.shape[0]
    at, met, slope = first_end(ends, change), scenario.met, scenario.slope
    on_path, ring = ahead_of(change, grid, scenario), ring_from(change, values, points, points)
    for k in range(count):
        stop, over = runs[k + 1, 0], runs[k, 1]
        for j in range(runs[k, 0], stop, EIGHT):
            for m in range(size):
                for side in range(2):
                    law = law_met(met, change, max(over, 0), m, side)
                    at_a, at_b, a, b, _, _, _ = landing_of_pack(
                        ends, at + j, law, over < 0, m, slope[change.mode, m, change.node :], on_path, ring
                    )
                    store_plan(at_a * width, at_b * width, a, b, 2 * m + side, place, weight)
            for lane in range(min(stop - j, EIGHT)):
                add_planned(place, weight, lane, 2 * size, width, stalled, values, mixed, out, (j + lane) * width)


@part_inline
def add_planned(place, weight, lane, plans, width, stalled, values, mixed, out, to):
    """Add the planned values of one energy to `out` (E·T,) from flat index `to` on."""
    for t in range(0, width, EIGHT):
        total = load8(out, to + t)
        for one in range(plans):
            a, b, of_a, of_b = planned(one, lane, place, weight)
            a0, a1, a2, a3 = four_weights(weight, of_a)
            if a < 0:
                total = total + load8(stalled, t) * a0
                continue
            b0, b1, b2, b3 = four_weights(weight, of_b)
            at = a + t
            v = load8(values, at) * a0 + load8(values, at + width) * a1
            v = v + (load8(values, at + 2 * width) * a2 + load8(values, at + 3 * width) * a3)
            at = b + t
            w = load8(mixed, at) * b0 + load8(mixed, at + width) * b1
            w = w + (load8(mixed, at + 2 * width) * b2 + load8(mixed, at + 3 * width) * b3)
            total = total + (v + w)
        store(out, to + t, total)


@part_inline
def four_weights(weight, at):
    """Every eighth number of `weight` from flat index `at` on."""
    return item(weight, at), item(weight, at + EIGHT), item(weight, at + 2 * EIGHT), item(weight, at + 3 * EIGHT)
