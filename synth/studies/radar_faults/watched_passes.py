"""The closed loop that can freeze its radar, and that tells the alarms and the last state of every estimator.

It is the kernel of the simulator, the same text compiled with other functions in the place of two of its own: the
sensor's, which remembers its last reading, and the estimator's, which notes the alarms. So the product's kernels know
nothing of either, and without fault every pass is the simulator's to the last bit.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from threading import Lock
from types import FunctionType
from typing import Any, NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from plant_models.frozen_arrays import frozen_arrays
from synth.kernels.loop import closed_loop as kernel
from synth.kernels.loop import regulator
from synth.simulation.closed_loop import ClosedLoop, TableController, empty_exits, sample_of
from synth.simulation.passes import ExitSample
from tuning_tables.estimator import STATE_SIZE, alarms


class FreezingSensor(NamedTuple):
    """`regulator.Sensor` with the memory of its last reading, (1,)."""

    period_s: float
    noise_m_s: float
    resolution_m_s: float
    last_m_s: NDArray[np.float64]


@frozen_arrays
@dataclass(frozen=True, eq=False)
class WatchedPasses:
    """`seen` (n,): bits of all alarms that a pass had at any sample; `at_end` (n,): those of its last sample.

    Both are 0 for a table without estimator.
    """

    sample: ExitSample
    seen: NDArray[np.int64]
    at_end: NDArray[np.int64]


def watched_passes(loop: ClosedLoop, controller: TableController, draws: kernel.Draws) -> WatchedPasses:
    """All passes of `draws`; a reading with z = `faults.FROZEN` is the one before it again (NaN: there was none).

    Raises `ValueError` for a table that is asked at any time.
    """
    law = controller.law()
    if not isinstance(law, regulator.Rule):
        raise ValueError("watched passes: only tables that decide at rest can be watched")
    # With a lead the radar reads at every sample, also during a change of stage; the rule of a table knows no lead.
    law = law._replace(lead_s=1.0)
    passes = len(draws.cut_factor)
    exits, seen, at_end = empty_exits(passes), np.zeros(passes, np.int64), np.zeros(passes, np.int64)
    sensor = FreezingSensor(*loop.sensor, np.empty(1))
    with _COMPILING:
        run = _watching()
    run(loop.path, loop.drive, sensor, law, draws, exits, seen, at_end)
    return WatchedPasses(sample_of(exits, draws), seen, at_end)


_COMPILING = Lock()
"""Two threads that begin together must not both compile."""


@cache
def _watching() -> Callable[..., None]:
    """The loop over passes; compiled anew in a process, so that no stale cache is asked."""
    compiled = njit(nogil=True, error_model="numpy")
    read, observe, told = regulator.measure, regulator.estimated_speed, compiled(alarms)
    size, left = STATE_SIZE, kernel.LEFT

    @compiled
    def measure(v, z, sensor):  # type: ignore[no-untyped-def]  # numba infers the types
        if z != np.inf:
            sensor.last_m_s[0] = read(v, z, sensor)
        return sensor.last_m_s[0]

    @compiled
    def estimated_speed(parameters, work, known, s, v, kpa):  # type: ignore[no-untyped-def]  # as above
        speed = observe(parameters, work, known[:size], s, v, kpa)
        now = told(parameters, known[:size])
        known[size], known[size + 1] = int(known[size]) | now, now
        return speed

    scope: dict[str, Any] = {**vars(kernel), "measure": measure, "estimated_speed": estimated_speed}
    run_pass = compiled(FunctionType(kernel.run_pass.py_func.__code__, scope))

    @compiled
    def run(path, drive, sensor, law, draws, exits, seen, at_end):  # type: ignore[no-untyped-def]  # as above
        free, known = np.empty(path.gravity_m_s2.shape[0]), np.empty(size + 2, np.float32)
        events = np.empty((0, 6))
        for i in range(draws.cut_factor.shape[0]):
            drag = path.drag_m_s2_per_n_kn * draws.resistance_n_kn[i]
            for j in range(free.shape[0]):
                free[j] = path.gravity_m_s2[j] - drag
            sensor.last_m_s[0] = np.nan
            v, time, status, switchings, _ = run_pass(
                path.edges_m, free, draws.brake_m_s2_per_kpa[i], drive, sensor, law,
                draws.entry_m_s[i], draws.first_sample_s[i], draws.noise_z[i], events, known,
            )  # fmt: skip
            exits.stalled[i] = status != left
            exits.speed_m_s[i] = v if status == left else 0.0
            exits.time_s[i], exits.switchings[i] = time, switchings
            seen[i], at_end[i] = int(known[size]), int(known[size + 1])

    watching: Callable[..., None] = run
    return watching
