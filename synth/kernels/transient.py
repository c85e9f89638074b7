"""A change of stage as one step of the chain: from the deciding sample to the first unlocked one, for one policy.

`spread_changes` takes masses to where they land, `change_values` fetches the expected values from there; both follow
the same plan (`landing_plan`), so that they are transposes of one another.

Values and masses live in rings over the path: node n is at index n mod ring length, the exit node N too. Rows hold
E' ≥ E energies. Further arguments, the same for both: `n`, `c`, `q` node, transient, noise level; begin ≤ j < end the
energies; `factor` ξ_cut; `mode` reached; `pressure` (H,) over-pressure of modes; `levels` (L,); `scratch` from
`landing_plan.landing_scratch`; the rest as in `landing_plan`.
"""

from __future__ import annotations

from synth.kernels.borrowing import borrowing, borrowing_inline
from synth.kernels.landing_plan import plan_landings, quanta_crossed
from synth.kernels.packs import add_to, item, load4, total


@borrowing
def spread_changes(
    share, n, last, c, q, begin, end, factor, mode, ends, factors, probability, mean, std,
    drive, brake, pressure, levels, extra, path_step, energy_step, points, arriving, mixing, scratch,
):  # fmt: skip
    """Spread the masses `share` (E',) over `arriving` and `mixing` (ring, H, L, E'); returns the mass that stalls."""
    crossed, place, weight = scratch
    ring, modes, size, row = arriving.shape
    quanta_crossed(n, c, begin, end, factor, ends, factors, path_step, probability.shape[1] - 1, crossed)
    stalled = 0.0
    for m in range(size):
        held = factor * (1.0 + levels[m]) * pressure[mode]
        for side in range(2):
            plan_landings(
                n, last, c, q, m, side, begin, end, crossed, held, factor, ends, factors, probability, mean, std,
                drive, brake, extra, path_step, energy_step, points, ring, modes * size * row,
                (mode * size + m) * row, place, weight,
            )  # fmt: skip
            for j in range(begin, end):
                mass = share[j]
                if place[0, j] < 0:
                    stalled += weight[0, j, 0] * mass
                elif mass != 0.0:
                    add_four(arriving, place[0, j], weight, 4 * j, mass)
                    add_four(mixing, place[1, j], weight, 4 * (row + j), mass)
    return stalled


@borrowing_inline
def add_four(masses, at, weight, first, mass):
    """Add `mass` to four neighbours at flat index `at` of `masses`, by the four weights from flat index `first` on."""
    for k in range(4):
        add_to(masses, at + k, item(weight, first + k) * mass)


@borrowing
def change_values(
    n, last, c, q, begin, end, factor, mode, ends, factors, probability, mean, std,
    drive, brake, pressure, levels, extra, path_step, energy_step, points, values, mixed, stalled, scratch, out,
):  # fmt: skip
    """`out`[begin:end] (E',) = expected value after transient `c`; `values`, `mixed` (ring, H, L, E')."""
    crossed, place, weight = scratch
    ring, modes, size, row = values.shape
    quanta_crossed(n, c, begin, end, factor, ends, factors, path_step, probability.shape[1] - 1, crossed)
    out[begin:end] = 0.0
    for m in range(size):
        held = factor * (1.0 + levels[m]) * pressure[mode]
        for side in range(2):
            plan_landings(
                n, last, c, q, m, side, begin, end, crossed, held, factor, ends, factors, probability, mean, std,
                drive, brake, extra, path_step, energy_step, points, ring, modes * size * row,
                (mode * size + m) * row, place, weight,
            )  # fmt: skip
            for j in range(begin, end):
                if place[0, j] < 0:
                    out[j] += weight[0, j, 0] * stalled
                    continue
                found = load4(values, place[0, j]) * load4(weight, 4 * j)
                found = found + load4(mixed, place[1, j]) * load4(weight, 4 * (row + j))
                out[j] += total(found)
