"""A traced pass with points between its events, for pictures and comparisons; the simulator needs none there."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from synth.kernels.loop.passage_loop import roll
from synth.kernels.loop.passes import Draws
from synth.simulation.passage_loop import PassageLoop
from synth.simulation.passage_sample import PassageTrace

TRACE_STEP_S = 0.05
"""Between points of a traced pass, which has events of its own only at coils and changes of pressure."""


def filled_trace(loop: PassageLoop, trace: PassageTrace, draws: Draws, step_s: float = TRACE_STEP_S) -> PassageTrace:
    """`trace` of the only pass of `draws` with points at most `step_s` apart.

    Between two events the overpressure is constant, so each point is as exact as the events are.
    """
    path = loop.radar.path
    free = path.gravity_m_s2 - path.drag_m_s2_per_n_kn * draws.resistance_n_kn[0]
    added: list[tuple[float, float, float, int]] = []
    for event, (start, end) in enumerate(pairwise(trace.time_s.tolist())):
        s, v = float(trace.path_m[event]), float(trace.speed_m_s[event])
        cell = min(int(np.searchsorted(path.edges_m, s, side="right")) - 1, free.size - 1)
        for time in np.arange(start + step_s, end - 1e-9, step_s).tolist():
            cell, s, v, _, _ = roll(
                path.edges_m, free, draws.brake_m_s2_per_kpa[0], trace.overpressure_kpa[event], step_s, np.inf,
                cell, s, v,
            )  # fmt: skip
            added.append((time, s, v, event))
    times = np.array([time for time, *_ in added])
    events = np.array([event for *_, event in added], dtype=np.int64)
    order = np.argsort(np.concatenate([trace.time_s, times]), kind="stable")

    def with_points(events_of: NDArray[Any], points: NDArray[Any]) -> NDArray[Any]:
        return np.concatenate([events_of, points])[order]

    return replace(
        trace,
        time_s=with_points(trace.time_s, times),
        path_m=with_points(trace.path_m, np.array([s for _, s, _, _ in added])),
        speed_m_s=with_points(trace.speed_m_s, np.array([v for _, _, v, _ in added])),
        overpressure_kpa=with_points(trace.overpressure_kpa, trace.overpressure_kpa[events]),
        stage=with_points(trace.stage, trace.stage[events]),
        measured_m_s=with_points(trace.measured_m_s, np.full(times.size, np.nan)),
    )
