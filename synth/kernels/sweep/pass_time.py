"""The price of the time that a cut takes, where the backward recursions count it: by path quanta and changes of stage.

A held quantum takes its width over the mean of the speeds at its ends. The next sample while a stage is held lies
between two nodes, or in the same quantum, and is met at either with a chance; as every node further on costs the
quantum before it, a wait costs one period in the mean. A change of stage takes its whole samples, and of the quantum in
which it ends what the place of its next decision is ahead or behind; or the path to the exit over the mean speed.

The T targets are one or whole packs of eight.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from numpy.typing import NDArray

from plant_models.frozen_arrays import Floats
from synth.kernels.compiling import part, part_inline
from synth.kernels.sweep.landing_plan import ahead_of, end_of_transient, first_end, law_met
from synth.kernels.vector.packs import (
    EIGHT,
    choose,
    eight,
    fraction,
    gather,
    greatest,
    least,
    load8,
    root,
    store,
    whole,
)


class Times(NamedTuple):
    """Of a chain: `quantum_m` widths and `left_m` path from each node to the exit (N,); `duration_s` of the transients;
    `lead_m` (R,) path from a decision to where its command leaves."""

    quantum_m: Floats
    left_m: Floats
    duration_s: Floats
    lead_m: Floats


class Prices(NamedTuple):
    """What a `command` costs, and a `second` (T,), in the type of the values; `times` that they are paid for."""

    command: NDArray[Any]
    second: NDArray[Any]
    times: Times


class Costs(NamedTuple):
    """What a policy is judged by: `terminal` cost by exit energy, `stalled` of a stall, and prices on the way.

    Of T targets side by side: `terminal` (E·T,), `stalled` (T,). Of one: (E,), and a number.
    """

    terminal: NDArray[Any]
    stalled: Any
    prices: Prices


@part
def add_quantum_times(n, prices, grid, shift, first, last, ahead, spent):
    """Add the price of the time over quantum `n` to all rows of `ahead` (M, H, L, E·T) but the first.

    Energies first ≤ j < last; `shift` (H, L) in cells of energy; `spent` (E,) is scratch.
    """
    price, twice, speed, energy_step = prices.second, 2.0 * prices.times.quantum_m[n], grid.speed, grid.energy_step
    if not is_priced(price):
        return
    for h in range(shift.shape[0]):
        for q in range(shift.shape[1]):
            gained = 2.0 * shift[h, q] * energy_step
            for j in range(first, last):
                spent[j] = twice / (speed[j] + math.sqrt(max(speed[j] * speed[j] + gained, 0.0)))
            for r in range(1, ahead.shape[0]):
                add_priced(spent, price, 0, first, last, ahead[r, h, q])


@part
def add_change_times(change, count, ends, grid, scenario, prices, runs, scratch, out):
    """Add the price of the expected time of a change of stage to `out` (E·T,), in all energies of the `count` `runs`.

    `scratch` (16,); the rest as in `transient_sweep`. What stalls takes no time: the stall has its price.
    """
    price, times, met, slope = prices.second, prices.times, scenario.met, scenario.slope
    if not is_priced(price):
        return
    size, speed, points = met.shape[3], grid.speed, grid.speed.shape[0]
    at, on_path = first_end(ends, change), ahead_of(change, grid, scenario)
    inside = times.duration_s[change.transient], times.lead_m[change.decision]
    for k in range(count):
        stop, over = runs[k + 1, 0], runs[k, 1]
        for j in range(runs[k, 0], stop if over >= 0 else 0, EIGHT):
            for lane in range(EIGHT):
                scratch[EIGHT + lane] = speed[min(j + lane, points - 1)]
            spent = eight(0.0)
            for m in range(size):
                for side in range(2):
                    law = law_met(met, change, over, m, side)
                    spent = spent + time_of_pack(
                        ends, at + j, law, slope[change.mode, m, change.node :], on_path,
                        times.quantum_m[change.node :], times.left_m[change.node], inside, load8(scratch, EIGHT),
                        speed[1],
                    ) * law[0]  # fmt: skip
            store(scratch, 0, spent)
            add_priced(scratch, price, -j, j, min(stop, j + EIGHT), out)


@part_inline
def is_priced(price):
    """Whether a second costs something for any target."""
    for t in range(price.shape[0]):
        if price[t] > 0.0:
            return True
    return False


@part_inline
def add_priced(spent, price, at, first, last, out):
    """Add `price` (T,) times `spent`[`at` + j] to `out` (E·T,), first ≤ j < last."""
    width = price.shape[0]
    if width == 1:
        for j in range(first, last):
            out[j] += price[0] * spent[at + j]
        return
    for j in range(first, last):
        for t in range(0, width, EIGHT):
            store(out, j * width + t, load8(out, j * width + t) + load8(price, t) * spent[at + j])


@part_inline
def time_of_pack(ends, at, law, slope, on_path, quantum, left_m, inside, v, slowest):
    """Time from a decision at speeds `v` until the next one after its change of stage, or until the exit.

    Landings as in `landing_plan.landing_of_pack`; `quantum` (·,) widths from this node on; `inside`: duration of the
    transient and lead of its command; `slowest`: no speed on the way to the next decision counts as less.
    """
    left, extra, quanta, _, least_ahead = on_path
    duration, lead = inside
    _, nearest, centre, low, middle, high = law
    path, e = end_of_transient(ends, at, nearest, centre, low, middle, high)
    e = greatest(e + path * extra, 0.0)
    ahead = path * quanta
    crossed = least(greatest(whole(ahead + 1e-9), 0), left)
    leaves, end = crossed >= left, least(crossed, left - 1)
    x = greatest(ahead - fraction(crossed), 0.0)
    part = choose(crossed < 1, 1.0, greatest(x, least_ahead))
    v_end = root(e * 2.0)
    v_ahead = root(greatest(e + gather(slope, end) * (1.0 - x), 0.0) * 2.0)
    wait = (part - x) * gather(quantum, end) * 2.0 / greatest(v_end + v_ahead, slowest)
    until_next = wait + duration + eight(lead) / v
    return choose(path < 0.0, 0.0, choose(leaves, eight(2.0 * left_m) / (v + v_end), until_next))
