"""The closed loop of the product, compiled once more with other functions in the place of some of the regulator's own.

Motion, drive and what follows from a command are the product's text; what the regulator hears is worked out for one
lane, so one pass at a time is run, and what the functions remember is of that pass.
"""

from __future__ import annotations

from types import FunctionType, ModuleType
from typing import Any

from numba import njit

from synth.kernels.any_time import any_time_law
from synth.kernels.any_time import closed_loop as any_time_loop
from synth.kernels.compiling import BORROWED
from synth.kernels.loop import closed_loop, lane_regulator
from synth.kernels.loop.lane_places import PASS, PIECE, SAMPLE, S, V

compiled: Any = njit(**{**BORROWED, "cache": False})
"""Compiled anew in a process, so that no stale cache is asked."""


def loop_at_rest(measure: Any, estimated_speed: Any, stage_by_table: Any) -> Any:
    """`kernels.loop.closed_loop.run_passes` for one pass.

    The functions are compiled, with arguments and answers of those of the same names in `kernels.loop.regulator`.
    """
    hear = hearing(measure, estimated_speed)

    @compiled
    def listen(work, count, pieces, sensor, law, noise_z, observed):  # type: ignore[no-untyped-def]  # numba infers
        if count == 0:
            return 0
        hear(work, pieces.mean_kpa, sensor, law.table, noise_z, observed)
        return 1 if work.ints[PIECE] < pieces.resting else 0

    regulate = with_others(lane_regulator, "regulate", stage_by_table=stage_by_table)
    return with_others(closed_loop, "run_passes", listen=listen, regulate=regulate)


def loop_at_any_time(measure: Any, estimated_speed: Any, stage_by_table: Any) -> Any:
    """`kernels.any_time.closed_loop.run_any_time_passes` for one pass, likewise."""
    hear = hearing(measure, estimated_speed)

    @compiled
    def listen(work, count, played, sensor, law, noise_z, observed):  # type: ignore[no-untyped-def]  # as above
        if count == 0:
            return 0
        hear(work, played.pieces.mean_kpa, sensor, law.rule.table, noise_z, observed)
        return 1

    wanted_stage = with_others(any_time_law, "wanted_stage", stage_by_table=stage_by_table)
    regulate = with_others(any_time_loop, "regulate", wanted_stage=wanted_stage)
    return with_others(any_time_loop, "run_any_time_passes", listen=listen, regulate=regulate)


def hearing(measure: Any, estimated_speed: Any) -> Any:
    """What the only pass, on lane 0, measures or estimates at a sample, to be compared in `work`."""

    @compiled
    def hear(work, mean_kpa, sensor, table, noise_z, observed):  # type: ignore[no-untyped-def]  # as above
        x, n = work.floats, work.ints
        speed = measure(x[V], noise_z[n[PASS], n[SAMPLE] % noise_z.shape[1]], sensor)
        if table.breaks > 0:
            speed = float(estimated_speed(table, observed.state[0], x[S], speed, observed.passed_kpa[0]))
            observed.passed_kpa[0] = mean_kpa[n[PIECE]]  # if there is no command
        work.told[0], work.heard[0] = 0, speed

    return hear


def with_others(module: ModuleType, name: str, **others: Any) -> Any:
    """The kernel `name` of `module`, its text compiled with `others` in the place of functions of these names."""
    return compiled(FunctionType(getattr(module, name).py_func.__code__, {**vars(module), **others}))
