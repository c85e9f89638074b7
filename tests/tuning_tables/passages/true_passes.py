"""Passes of cuts over sensors as they truly are: exact times and speeds at every passage, within the limits."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import numpy.typing as npt
from hypothesis import strategies as st

from tuning_tables.passages.held_passages import held_passages
from tuning_tables.programs.passage_table import HeldPassages

LIMITS = np.array([0.3, 15.0, 0.5, 3.0, 0.05, 0.2], np.float32)
SLOWEST_M_S, FASTEST_M_S = 0.5, 12.0
Floats = npt.NDArray[np.float64]
Limits = npt.NDArray[np.float32]
Pulse = tuple[float, int, float]
"""Time in s, sensor, speed read in m/s."""


def tracking(path_m: npt.NDArray[np.floating], sensor: npt.NDArray[np.int64], limits: Limits = LIMITS) -> HeldPassages:
    """A table that knows these passages and decides at none."""
    return held_passages(np.zeros((1, 2, 1)), path_m, sensor, np.full(len(path_m), -1), limits)


@dataclass(frozen=True, eq=False)
class TruePass:
    """All passages heard (T,) and the pulse pair of each, in order."""

    path_m: npt.NDArray[np.float32]
    sensor: npt.NDArray[np.int64]
    pulses: tuple[Pulse, ...]


def rolled(places_m: Floats, axles_m: Floats, rng: np.random.Generator, extreme: bool) -> TruePass:
    """A cut rolls over the sensors; its speed changes by any acceleration within 95 % of the limits.

    Every stretch between two passages has three pieces of constant acceleration; `extreme`: of one of the two limits.
    Readings are off by 4 % at most.
    """
    met = sorted((float(place + axle), sensor) for sensor, place in enumerate(places_m) for axle in axles_m)
    time, speed = 0.0, rng.uniform(1.0, 8.0)
    pulses = [(time, met[0][1], speed)]
    for (before, _), (path, sensor) in pairwise(met):
        for share in rng.dirichlet(np.ones(3)) if path > before else ():
            part = share * (path - before)
            gain = rng.choice([-2.85, 0.475]) if extreme else rng.uniform(-2.85, 0.475)
            square = np.clip(speed**2 + 2.0 * gain * part, SLOWEST_M_S**2, FASTEST_M_S**2)
            after = max(np.sqrt(square), min(speed, SLOWEST_M_S))
            time += 2.0 * part / (speed + after)
            speed = after
        pulses.append((time, sensor, speed))
    read = [(time, sensor, float(speed * rng.uniform(0.96, 1.04))) for time, sensor, speed in pulses]
    return TruePass(
        np.array([path for path, _ in met], np.float32), np.array([sensor for _, sensor in met]), tuple(read)
    )


@st.composite
def true_passes(draw: st.DrawFn, most_axles: int = 6) -> TruePass:
    """Of one to six sensors, and of one to `most_axles` axles."""
    places = np.cumsum(draw(st.lists(st.floats(0.4, 15.0), min_size=1, max_size=6)))
    axles = np.cumsum([0.0, *draw(st.lists(st.floats(0.7, 9.0), max_size=most_axles - 1))])
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    return rolled(places, axles, rng, draw(st.booleans()))
