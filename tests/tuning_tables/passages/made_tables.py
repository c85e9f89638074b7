"""Tables for point sensors to test with, and passes of cuts over sensors as they truly are."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import numpy.typing as npt
from hypothesis import strategies as st

from tests.tuning_tables.random_tables import above_zero, cuts, digests, instants, numbers, probabilities, texts
from tuning_tables import Approach, CutId, Generator, Predicted, RetarderId, Validated
from tuning_tables.passages.passage_row import PassageRow, Row
from tuning_tables.passages.passage_table import PassageTable
from tuning_tables.passages.rule import held_passages
from tuning_tables.passages.sensor_layout import DecidesOn, PlausibleMotion, SensorLayout
from tuning_tables.programs.held import HeldPassages

NEVER = math.inf
ROWS = ((5.0, NEVER), (4.5, 6.25), (-NEVER, 5.5))
"""Of three stages: stage 0 never goes to stage 2 at once, stage 2 never to stage 0."""


def table_of(
    decides_on: DecidesOn = DecidesOn.FIRST_AXLE,
    places_m: tuple[float, ...] = (-4.0, 3.0, 9.5, 30.0, 45.0),
    axles_m: tuple[float, ...] = (0.0, 1.85, 8.65, 10.5),
    rows: tuple[Row, ...] = ROWS,
    pressures: tuple[float, ...] = (0.0, 150.0, 300.0),
) -> PassageTable:
    """The same rows at every passage; the last sensor of `places_m` may stand behind the exit and log."""
    sensors = SensorLayout(places_m, 0.2, 0.002, 1e-4, 1e-4, 0.02, 0.02, decides_on)
    exit_m = 26.95 + axles_m[-1]
    return PassageTable(
        id="leer-22t-3.0",
        created="2026-11-22T22:46:00Z",
        generator=Generator("retarder-synth", "0.1.0", "0123456789abcdef" * 4),
        retarder=RetarderId("Talbremse Süd", ((0.0, 12.475), (14.475, 26.95)), exit_m, 15.0),
        cut=CutId("Л", 22.0, axles_m, 1),
        target_speed_m_s=3.0,
        pressure_kpa=pressures,
        sensors=sensors,
        approach=Approach(-places_m[0], 1),
        initial_stage=0,
        passages=tuple(PassageRow(*met, rows) for met in sensors.passages(axles_m, exit_m)),
        plausible=PlausibleMotion((0.3, 15.0), 0.5, 3.0, 0.05, 0.3),
        valid_v_m_s=(0.5, 9.0),
        predicted=Predicted(0.08, -0.001, 0.01, 3.1, 0.0),
        validated=Validated(20000, 0.08, (0.079, 0.081)),
    )


speeds = st.floats(0.0, 40.0, width=32).map(lambda v: v + 0.0) | st.floats(0.0, width=32, allow_infinity=False)


@st.composite
def row_lists(draw: st.DrawFn, stages: int) -> tuple[Row, ...]:
    """A row for each stage in force."""
    rows = []
    for stage in range(stages):
        row = sorted(draw(st.lists(speeds, min_size=stages - 1, max_size=stages - 1)))
        lower, raiser = draw(st.integers(0, stage)), draw(st.integers(stage, stages - 1))
        row[:lower] = [-math.inf] * lower
        row[raiser:] = [math.inf] * (stages - 1 - raiser)
        if 0 < stage < stages - 1 and not row[stage - 1] < row[stage]:
            row[stage:] = [math.inf] * (stages - 1 - stage)
        rows.append(tuple(value + 0.0 for value in row))
    return tuple(rows)


@st.composite
def layouts(draw: st.DrawFn) -> SensorLayout:
    """One to five sensors, the first before the entrance."""
    places = [-draw(st.floats(0.001, 100.0))]
    for step in draw(st.lists(st.floats(0.4, 30.0), max_size=4)):
        places.append(places[-1] + step)
    timer = st.floats(0.0, 0.05).map(lambda value: value + 0.0)
    return SensorLayout(
        tuple(place + 0.0 for place in places),
        draw(st.floats(0.05, 0.35)),
        draw(st.floats(0.0, 0.2)) + 0.0,
        draw(timer),
        draw(timer),
        draw(st.floats(0.0, 2.0)) + 0.0,
        draw(st.floats(0.001, 0.5)),
        draw(st.sampled_from(DecidesOn)),
    )


@st.composite
def passage_tables(draw: st.DrawFn, names: st.SearchStrategy[str] = texts) -> PassageTable:
    """A table whose id is one of `names`, with two to five stages."""
    sensors = draw(layouts())
    steps = draw(st.lists(st.floats(0.5, 10.0), max_size=5))
    axles = (0.0, *(float(x) for x in np.cumsum(steps)))
    cut = draw(cuts())
    begin, length, beyond = draw(numbers(0.0, 10.0)), draw(st.floats(0.5, 30.0)), draw(st.floats(0.0, 30.0))
    exit_m = begin + length + beyond
    pressures = sorted(draw(st.lists(numbers(0.0, 1e4), unique=True, min_size=2, max_size=5)))
    entrance = draw(st.integers(0, len(pressures) - 1))
    low = draw(st.floats(0.01, 10.0))
    interval = sorted((draw(numbers(0.0)), draw(numbers(0.0))))
    return PassageTable(
        id=draw(names),
        created=draw(instants),
        generator=draw(st.builds(Generator, texts, texts, digests)),
        retarder=RetarderId(draw(texts), ((begin, begin + length),), exit_m, draw(numbers(0.0))),
        cut=CutId(cut.category, cut.mass_t, axles, cut.category_number),
        target_speed_m_s=draw(above_zero()),
        pressure_kpa=tuple(pressures),
        sensors=sensors,
        approach=Approach(-sensors.path_m[0], entrance),
        initial_stage=draw(st.integers(0, entrance)),
        passages=tuple(PassageRow(*met, draw(row_lists(len(pressures)))) for met in sensors.passages(axles, exit_m)),
        plausible=PlausibleMotion(
            (low, low + draw(st.floats(0.5, 30.0))),
            draw(st.floats(0.001, 10.0)),
            draw(st.floats(0.001, 10.0)),
            draw(st.floats(0.0, 0.9)) + 0.0,
            draw(st.floats(0.0, 10.0)) + 0.0,
        ),
        valid_v_m_s=(low, low + draw(st.floats(0.5, 20.0))),
        predicted=Predicted(
            draw(numbers(0.0)),
            draw(numbers()),
            draw(probabilities) + 0.0,
            draw(numbers(0.0)),
            draw(st.none() | probabilities.map(lambda p: p + 0.0)),
        ),
        validated=draw(st.none() | st.builds(Validated, st.integers(1, 2**53), numbers(0.0), st.just(tuple(interval)))),
    )


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
