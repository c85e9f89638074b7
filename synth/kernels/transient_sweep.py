"""The value of one change of stage from all energies and for all targets.

Where a cut lands does not depend on the target speed; only the value there does. So landings are planned once
(`landing_plan`) and the targets, side by side in memory in packs of four, are interpolated with the same weights.
"""

from __future__ import annotations

from synth.kernels.borrowing import borrowing, borrowing_inline
from synth.kernels.landing_plan import landing_of_pack, law_met
from synth.kernels.packs import EIGHT, FOUR, item, load4, store


@borrowing
def add_transient_values(
    n, last, c, q, runs, count, mode, ends, met, slope,
    extra, path_step, energy_step, values, mixed, stalled, place, weight, out,
):  # fmt: skip
    """Add to `out` (E·T,) the expected value after transient `c` from node `n` and noise level `q`.

    `values` (ring, H, L, E·T) at a sample and `mixed` before the noise level changes; `stalled` (T,), T whole packs of
    four; `runs`, `count` from `find_runs`; `place`, `weight` are scratch; the rest as in `landing_plan`.
    """
    ring, modes, size = values.shape[0], values.shape[1], values.shape[2]
    width, row = stalled.shape[0], ends.shape[4]
    points = out.shape[0] // width
    at = (n * ends.shape[1] + c) * ends.shape[2] * 2 * row
    quanta, cells, start, stride = 1.0 / path_step, 1.0 / energy_step, n % ring, modes * size * points
    for m in range(size):
        gained, first = slope[mode, m, n:], start * stride + (mode * size + m) * points
        for side in range(2):
            for k in range(count):
                stop, over = runs[k + 1, 0], runs[k, 1]
                law = law_met(met, c, max(over, 0), q, m, side)
                for j in range(runs[k, 0], stop, EIGHT):
                    at_a, at_b, a, b, _, _, _ = landing_of_pack(
                        ends, at + j, row, law, over < 0, gained, last - n, extra, quanta, cells, points,
                        stride, first, ring - start, ring * stride,
                    )  # fmt: skip
                    store(place, 0, at_a * width)
                    store(place, EIGHT, at_b * width)
                    for i in range(4):
                        store(weight, i * EIGHT, a[i])
                        store(weight, (4 + i) * EIGHT, b[i])
                    for lane in range(min(stop - j, EIGHT)):
                        add_planned(place, weight, lane, width, stalled, values, mixed, out, (j + lane) * width)


@borrowing_inline
def add_planned(place, weight, lane, width, stalled, values, mixed, out, to):
    """Add the planned values of one energy to `out` (E·T,) from flat index `to` on."""
    a, b = item(place, lane), item(place, EIGHT + lane)
    a0, a1, a2, a3 = four_weights(weight, lane)
    b0, b1, b2, b3 = four_weights(weight, 4 * EIGHT + lane)
    for t in range(0, width, FOUR):
        if a < 0:
            store(out, to + t, load4(out, to + t) + load4(stalled, t) * a0)
            continue
        at = a + t
        v = load4(values, at) * a0 + load4(values, at + width) * a1
        v = v + (load4(values, at + 2 * width) * a2 + load4(values, at + 3 * width) * a3)
        at = b + t
        w = load4(mixed, at) * b0 + load4(mixed, at + width) * b1
        w = w + (load4(mixed, at + 2 * width) * b2 + load4(mixed, at + 3 * width) * b3)
        store(out, to + t, load4(out, to + t) + (v + w))


@borrowing_inline
def four_weights(weight, at):
    """Every eighth number of `weight` from flat index `at` on."""
    return item(weight, at), item(weight, at + EIGHT), item(weight, at + 2 * EIGHT), item(weight, at + 3 * EIGHT)
