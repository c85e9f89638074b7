"""A change of stage as one step of the chain: from the deciding sample to the first unlocked one, for one policy.

`spread_changes` takes masses to where they land, `change_values` fetches the expected values from there; both follow
the same plan (`landing_plan`), so that they are transposes of one another.

Values and masses live in rings over the path: node n is at index n mod ring length, the exit node N too. Rows hold
E' ≥ E energies; begin ≤ j < end are those that change the stage. Further arguments as in `chain_arrays`, and `scratch`
from `landing_plan.landing_scratch`.
"""

from __future__ import annotations

from synth.kernels.compiling import part, part_inline
from synth.kernels.sweep.flow import widen
from synth.kernels.sweep.landing_plan import (
    ahead_of,
    find_runs,
    first_end,
    landing_of_pack,
    law_met,
    planned,
    ring_from,
    store_plan,
)
from synth.kernels.vector.packs import (
    EIGHT,
    add_to,
    choose,
    eight,
    gather_four,
    greatest,
    item,
    least,
    load8,
    store,
    whole,
)


@part
def spread_changes(share, change, begin, end, landings, grid, scenario, arriving, mixing, landed, scratch):
    """Spread the masses `share` (E',) over `arriving` and `mixing` (ring, H, L, E'); returns the mass that stalls.

    `landed` (ring, H, 2): ranges of energies out of which both are zero, widened.
    """
    _, runs, place, weight = scratch
    ends, met, slope, points = landings.ends, scenario.met, scenario.slope, grid.speed.shape[0]
    size, row, at, last = arriving.shape[2], arriving.shape[3], first_end(ends, change), change.node + change.left
    on_path, ring = ahead_of(change, grid, scenario), ring_from(change, arriving, row, points)
    count = find_runs(change, begin, end, landings, grid, scenario, scratch)
    stalled = 0.0
    bottom, top = eight(points), eight(0.0)
    soonest, latest = whole(eight(last)), whole(top)
    for side in range(2):
        for k in range(count):
            stop, over = runs[k + 1, 0], runs[k, 1]
            for j in range(runs[k, 0], stop, EIGHT):
                mass = load8(share, j)
                for m in range(size):
                    law = law_met(met, change, max(over, 0), m, side)
                    at_a, at_b, a, b, by, lowest, highest = landing_of_pack(
                        ends, at + j, law, over < 0, m, slope[change.mode, m, change.node :], on_path, ring
                    )
                    a = a[0] * mass, a[1] * mass, a[2] * mass, a[3] * mass
                    b = b[0] * mass, b[1] * mass, b[2] * mass, b[3] * mass
                    store_plan(at_a, at_b, a, b, m, place, weight)
                    bottom, top = least(bottom, lowest), greatest(top, highest)
                    soonest, latest = least(soonest, by), greatest(latest, by)
                for lane in range(min(stop - j, EIGHT)):  # levels inside: additions to different rows can overlap
                    for m in range(size):
                        to_a, to_b, first_a, first_b = planned(m, lane, place, weight)
                        if to_a < 0:
                            stalled += item(weight, first_a)
                            continue
                        add_four(arriving, to_a, weight, first_a)
                        add_four(mixing, to_b, weight, first_b)
    store(place, 0, soonest)
    store(place, EIGHT, latest)
    store(weight, 0, bottom)
    store(weight, EIGHT, top)
    widen_landed(place, weight, change.node, last, points, landed[:, change.mode])
    return stalled


@part_inline
def add_four(masses, at, weight, first):
    """Add four numbers, every eighth of `weight` from flat index `first` on, to neighbours in `masses` from `at` on."""
    for k in range(4):
        add_to(masses, at + k, item(weight, first + EIGHT * k))


@part
def widen_landed(quanta, cells, n, last, points, landed):
    """Widen `landed` (ring, 2) by landings from node `n`.

    `quanta` (2, 8) least and largest numbers of quanta crossed, `cells` (2, 8) of positions, of which any may be met.
    """
    low, high, soonest, latest = points - 3, 1, last, 0
    for lane in range(EIGHT):
        low, high = min(low, int(item(cells, lane))), max(high, int(item(cells, EIGHT + lane)))
        soonest, latest = min(soonest, item(quanta, lane)), max(latest, item(quanta, EIGHT + lane))
    for k in range(n + soonest, n + latest + 2):
        widen(landed[k % landed.shape[0]], max(low, 1) - 1, min(high, points - 3) + 3)


@part
def change_values(change, begin, end, landings, grid, scenario, values, mixed, stalled, scratch, out):
    """`out`[begin:end] (E',) = expected value after the change; `values`, `mixed` (ring, H, L, E').

    What follows in `out` within a pack is overwritten too. Returns how many runs of energies `scratch` holds.
    """
    runs, ends, met, slope = scratch.runs, landings.ends, scenario.met, scenario.slope
    size, at, on_path = values.shape[2], first_end(ends, change), ahead_of(change, grid, scenario)
    ring = ring_from(change, values, values.shape[3], grid.speed.shape[0])
    count = find_runs(change, begin, end, landings, grid, scenario, scratch)
    for k in range(count):
        over = runs[k, 1]
        for j in range(runs[k, 0], runs[k + 1, 0], EIGHT):
            total = eight(0.0)
            for m in range(size):
                for side in range(2):
                    law = law_met(met, change, max(over, 0), m, side)
                    at_a, at_b, a, b, _, _, _ = landing_of_pack(
                        ends, at + j, law, over < 0, m, slope[change.mode, m, change.node :], on_path, ring
                    )
                    stopped = at_a < 0
                    at_a = greatest(at_a, 0)
                    landed, crossing = gather_four(values, at_a), gather_four(mixed, at_b)
                    f0 = landed[0] * a[0] + crossing[0] * b[0]
                    f1 = landed[1] * a[1] + crossing[1] * b[1]
                    f2 = landed[2] * a[2] + crossing[2] * b[2]
                    f3 = landed[3] * a[3] + crossing[3] * b[3]
                    total = total + choose(stopped, a[0] * stalled, (f0 + f1) + (f2 + f3))
            store(out, j, total)  # beyond the run: overwritten by the next, or out of range
    return count
