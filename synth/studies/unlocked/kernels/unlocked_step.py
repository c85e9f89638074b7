"""One sampling period of motion, and the value between the path nodes where it ends.

The value is interpolated by a parabola through three nodes *along the path on which the cut would roll on* at the
pressure reached: path and energy stay together, and what is interpolated is smooth. Linear interpolation, which
suffices where a whole transient is one step, would here smear the path by a third of a quantum at every sample.
"""

from __future__ import annotations

import math

from numba import njit

from synth.kernels.sweep.flow import LINEAR_CELLS, stencil

JUMP = 0.002
"""Share of the cost of a stall; values that differ by more are not smooth. See `limited`."""


@njit(cache=True, nogil=True, error_model="numpy", forceinline=True)
def along(table, s, per_metre, cells):
    """`table` (W + 1,), an integral over path, `per_metre` equal steps a metre, at path s; constant beyond the exit."""
    x = min(s * per_metre, cells - 1e-9)
    i = int(x)
    return table[i] + (x - i) * (table[i + 1] - table[i])


@njit(cache=True, nogil=True, error_model="numpy", forceinline=True)
def move(s, e, factor, extra, over, part, lift, work, per_metre, exit_m):
    """(path, energy) a period on; energy 0 for a stall. `over` (S,) mean overpressure in parts of `part` seconds.

    `lift`, `work` = ∫ of the acceleration without brakes and of β; `extra` acceleration on top inside the position.
    Path by a mean acceleration over the part, energy by the work over the path found: exact where nothing changes.
    """
    cells = work.shape[0] - 1
    up, braked = along(lift, s, per_metre, cells), along(work, s, per_metre, cells)
    for i in range(over.shape[0]):
        v = math.sqrt(2.0 * e)
        reach = v * part
        force = factor * over[i]
        inside = min(s + reach, exit_m) - min(s, exit_m)
        gain = (
            along(lift, s + reach, per_metre, cells) - up - force * (along(work, s + reach, per_metre, cells) - braked)
        )
        a = (gain + extra * inside) / max(reach, 1e-9)
        if v + a * part <= 0.0:
            return s, 0.0
        end = s + reach + 0.5 * a * part * part
        up_end, braked_end = along(lift, end, per_metre, cells), along(work, end, per_metre, cells)
        inside = min(end, exit_m) - min(s, exit_m)
        e += up_end - up - force * (braked_end - braked) + extra * inside
        s, up, braked = end, up_end, braked_end
        if e <= 0.0:
            return s, 0.0
    return s, e


@njit(cache=True, nogil=True, error_model="numpy", forceinline=True)
def parabola(ahead, reach):
    """First of three nodes 1 … `reach` for a landing `ahead` quanta on, and their weights.

    A landing in its own quantum, at a speed below ΔS/T_c, is put on the next node: there the sampling is a little
    slower than it is. The quantum must be small enough that this is below all speeds of interest.
    """
    first = min(max(int(ahead + 0.5) - 1, 1), reach - 2)
    x = max(ahead, 1.0) - first
    return first, 0.5 * (x - 1.0) * (x - 2.0), -x * (x - 2.0), 0.5 * x * (x - 1.0)


@njit(cache=True, nogil=True, error_model="numpy", forceinline=True)
def landed_value(rows, node, s, e, force, extra, path_step, energy_step, lift, work, per_metre, exit_m, stalled):
    """Value at path `s` (metres) and energy `e`; `rows` (A + 1, E) values at the nodes `node` + 0 … A."""
    cells, per_quantum = work.shape[0] - 1, 1.0 / path_step
    first, w0, w1, w2 = parabola(s * per_quantum - node, rows.shape[0] - 1)
    base = e - along(lift, s, per_metre, cells) + force * along(work, s, per_metre, cells) - extra * min(s, exit_m)
    scale = 1.0 / energy_step
    e0 = rolled(base, node + first, force, extra, path_step, lift, work, per_metre, exit_m) * scale
    e1 = rolled(base, node + first + 1, force, extra, path_step, lift, work, per_metre, exit_m) * scale
    e2 = rolled(base, node + first + 2, force, extra, path_step, lift, work, per_metre, exit_m) * scale
    a, b = cubic_at(rows[first], e0, stalled), cubic_at(rows[first + 1], e1, stalled)
    c = cubic_at(rows[first + 2], e2, stalled)
    # Kept between what it was interpolated from: where a command comes too late the value bends within a quantum.
    return min(max(w0 * a + w1 * b + w2 * c, min(a, b, c)), max(a, b, c))


@njit(cache=True, nogil=True, error_model="numpy", forceinline=True)
def cubic_at(row, position, stalled):
    """`row` (E,) at `position` in cells; `stalled` at and below cell 0, linear in the first and the last cells."""
    points = row.shape[0]
    if position <= 0.0:
        return stalled
    i = min(int(position), points - 2)
    x = min(position - i, 1.0)
    if i < LINEAR_CELLS or i == points - 2:
        return (1.0 - x) * row[i] + x * row[i + 1]
    a, b, c, d = row[i - 1], row[i], row[i + 1], row[i + 2]
    c0, c1, c2, c3 = stencil(x)
    return limited(c0 * a + c1 * b + c2 * c + c3 * d, min(a, b, c, d), max(a, b, c, d), stalled)


@njit(cache=True, nogil=True, error_model="numpy", forceinline=True)
def limited(value, low, high, stalled):
    """`value` kept between the values it was interpolated from where these differ as much as beside a stall.

    There the cost jumps by thousands of times what is to be gained elsewhere, and a polynomial across it would promise
    costs below zero.
    """
    if high - low > JUMP * stalled:
        return min(max(value, low), high)
    return value


@njit(cache=True, nogil=True, error_model="numpy", forceinline=True)
def rolled(base, node, force, extra, path_step, lift, work, per_metre, exit_m):
    """Energy at a path node on the path whose constant of motion is `base`; nodes lie on the steps of the tables."""
    s = node * path_step
    i = min(int(s * per_metre + 0.5), work.shape[0] - 1)
    return base + lift[i] - force * work[i] + extra * min(s, exit_m)
