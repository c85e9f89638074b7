"""The value of one change of stage from all energies and for all targets.

Where a cut lands does not depend on the target speed; only the value there does. So landings are planned once
(`landing_plan`) and the targets, side by side in memory in packs of four, are interpolated with the same weights.
"""

from __future__ import annotations

from synth.kernels.borrowing import borrowing
from synth.kernels.landing_plan import plan_landings
from synth.kernels.packs import FOUR, load4, store


@borrowing
def add_transient_values(
    n, last, c, q, crossed, factor, mode, ends, factors, probability, mean, std,
    drive, brake, pressure, levels, extra, path_step, energy_step, values, mixed, stalled, place, weight, out,
):  # fmt: skip
    """Add to `out` (E·T,) the expected value after transient `c` from node `n` and noise level `q`.

    `values` (ring, H, L, E·T) at a sample and `mixed` before the noise level changes; `stalled` (T,), T whole packs of
    four; `crossed` (E',) from `quanta_crossed`; `place`, `weight` are scratch; the rest as in `landing_plan`.
    """
    ring, modes, size = values.shape[0], values.shape[1], values.shape[2]
    width = stalled.shape[0]
    points = out.shape[0] // width
    for m in range(size):
        held = factor * (1.0 + levels[m]) * pressure[mode]
        for side in range(2):
            plan_landings(
                n, last, c, q, m, side, 0, points, crossed, held, factor, ends, factors, probability, mean, std,
                drive, brake, extra, path_step, energy_step, points, ring, modes * size * points,
                (mode * size + m) * points, place, weight,
            )  # fmt: skip
            add_planned(place, weight, 0, points, width, stalled, values, mixed, out)


@borrowing
def add_planned(place, weight, begin, end, width, stalled, values, mixed, out):
    """Add the planned values at every energy to `out` (E·T,)."""
    for j in range(begin, end):
        a, b, to = place[0, j] * width, place[1, j] * width, j * width
        if a < 0:
            for t in range(width):
                out[to + t] += weight[0, j, 0] * stalled[t]
            continue
        a0, a1, a2, a3 = weight[0, j, 0], weight[0, j, 1], weight[0, j, 2], weight[0, j, 3]
        b0, b1, b2, b3 = weight[1, j, 0], weight[1, j, 1], weight[1, j, 2], weight[1, j, 3]
        for t in range(0, width, FOUR):
            at = a + t
            v = load4(values, at) * a0 + load4(values, at + width) * a1
            v = v + (load4(values, at + 2 * width) * a2 + load4(values, at + 3 * width) * a3)
            at = b + t
            w = load4(mixed, at) * b0 + load4(mixed, at + width) * b1
            w = w + (load4(mixed, at + 2 * width) * b2 + load4(mixed, at + 3 * width) * b3)
            store(out, to + t, load4(out, to + t) + (v + w))
