"""The reference problem in plain loops, as one writes them first: a yardstick for what the vectors gain."""

from __future__ import annotations

import math

from numba import njit


@njit(cache=True, nogil=True, error_model="numpy")
def locate_plainly(
    step, pressures, speeds, commanded, friction, drive, rise, fall, braking, dead, row_place, cell_place
):
    """Where every outcome lands: `row_place` (P, V, U) and `cell_place` (P, V, U, M·A), in grid indices, clipped.

    Pressures and speeds in kPa and m/s on equally spaced grids, `drive` a0 in m/s², `braking` c in m/s² per kPa.
    """
    row_kpa, cell = pressures[1] - pressures[0], speeds[1] - speeds[0]
    for i in range(pressures.shape[0]):
        for j in range(speeds.shape[0]):
            for u in range(commanded.shape[0]):
                constant = rise if commanded[u] > pressures[i] else fall
                after = commanded[u] + (pressures[i] - commanded[u]) * math.exp(-step / speeds[j] / constant)
                row_place[i, j, u] = after / row_kpa
                brake = braking * max((pressures[i] + after) / 2.0 - dead, 0.0)
                for m in range(friction.shape[0]):
                    for a in range(drive.shape[0]):
                        squared = speeds[j] ** 2 + 2.0 * step * (drive[a] - friction[m] * brake)
                        squared = min(max(squared, speeds[0] ** 2), speeds[-1] ** 2)
                        place = (math.sqrt(squared) - speeds[0]) / cell
                        cell_place[i, j, u, m * drive.shape[0] + a] = min(max(place, 0.0), speeds.shape[0] - 1.0)


@njit(cache=True, nogil=True, error_model="numpy")
def sweep_plainly(row_place, cell_place, chance, value, policy):
    """`value` (P, V) float64 becomes the value at entry; `policy` (stages, P, V) uint8; `chance` (M·A,)."""
    rows, cells = value.shape
    before = value.copy()
    for stage in range(policy.shape[0] - 1, -1, -1):
        for i in range(rows):
            for j in range(cells):  # `before[:] = value` takes numba seconds to compile
                before[i, j] = value[i, j]
        for i in range(rows):
            for j in range(cells):
                best, chosen = math.inf, 0
                for u in range(row_place.shape[2]):
                    row = min(int(row_place[i, j, u]), rows - 2)
                    share = row_place[i, j, u] - row
                    total = 0.0
                    for outcome in range(chance.shape[0]):
                        k = min(int(cell_place[i, j, u, outcome]), cells - 2)
                        x = cell_place[i, j, u, outcome] - k
                        low = (1.0 - x) * before[row, k] + x * before[row, k + 1]
                        high = (1.0 - x) * before[row + 1, k] + x * before[row + 1, k + 1]
                        total += chance[outcome] * ((1.0 - share) * low + share * high)
                    if total < best:
                        best, chosen = total, u
                value[i, j] = best
                policy[stage, i, j] = chosen
