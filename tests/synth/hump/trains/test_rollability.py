"""What is measured of a cut tells its resistance as well as Bayes' rule can, and says how well."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import pytest
from numpy.typing import NDArray

from synth.hump.trains.asked import Asked
from synth.hump.trains.expected_way import ExpectedWay
from synth.hump.trains.resistance_prior import ResistancePrior
from synth.hump.trains.rollability import MeasuredRollability
from synth.hump.trains.speed_sensors import SpeedSensors
from synth.hump.trains.train_memory import TrainMemory
from synth.simulation.free_roll import Rolled
from tests.synth.hump.trains.asked_cuts import CUT_M, FIRST_M, GRADE, GRAVITY_M_S2, LAST_M, alike_cuts, asked_at, large

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

ROUTES = large()
MEAN, STD, AIR, WIND = 1.7, 0.7, 0.02, 3.0
BENDS_M_S2 = np.array([0.5e-3, 1.5e-3, 0.0])
"""Mean heads of the bends ahead of each position per (m/s)²; drawn by an Erlang law of order 3."""
EXITS_M_S = (5.0, 4.5)
STD_M_S = 0.1


@dataclass(frozen=True)
class WindySlope:
    """Rolls on an even slope against air and wind, with bends that are spread over every stretch: 40 steps of the
    midpoint rule. `n_per_kn`, `wind_m_s`, `bends_m_s2` (cuts,): their own, the same on every stretch."""

    n_per_kn: Floats
    wind_m_s: Floats
    bends_m_s2: Floats

    def roll_on(
        self,
        rows: Ints,
        routes: Ints,
        start_m: Floats,
        speed_m_s: Floats,
        stations_m: Floats,
        resistance_n_per_kn: Floats | None = None,
    ) -> Rolled:
        """Times are not told."""
        w = self.n_per_kn[rows] if resistance_n_per_kn is None else resistance_n_per_kn
        path, square = stations_m[:, 0] - start_m, speed_m_s**2
        step = path / 40.0

        def change(square: Floats) -> Floats:
            against = np.sqrt(square) + self.wind_m_s[rows]
            lost = 1e-3 * (w + AIR * against * np.abs(against)) + self.bends_m_s2[rows] * square / path
            return np.asarray(2.0 * GRAVITY_M_S2 * (GRADE - lost))

        for _ in range(40):
            middle = np.maximum(square + 0.5 * step * change(square), 0.0)
            square = np.maximum(square + step * change(middle), 0.0)
        return Rolled(np.sqrt(square)[:, None], np.full((len(path), 1), np.nan), np.full(len(path), np.inf))


@dataclass(frozen=True)
class CutsAsked:
    """Cuts with what was drawn for them, and the question that they put to the control at the second position."""

    n_per_kn: Floats
    wind_m_s: Floats
    asked: Asked
    measured: MeasuredRollability

    @property
    def ahead_n_per_kn(self) -> Floats:
        """Resistance with the wind's part at the speed of the question."""
        speed = self.asked.start.speed_m_s
        against = speed + self.wind_m_s
        return np.asarray(self.n_per_kn + AIR * (against * np.abs(against) - speed**2))


def bends_drawn(random: np.random.Generator, count: int, position: int) -> Floats:
    return np.asarray(BENDS_M_S2[position] * random.gamma(3.0, 1.0 / 3.0, count))


def roll(n_per_kn: Floats, wind_m_s: Floats, random: np.random.Generator, position: int = 1) -> tuple[Floats, ...]:
    """True speeds at the entrances up to `position`, for cuts that leave the crest with 1.5 m/s."""
    count = len(n_per_kn)
    rows = np.arange(count)
    found: tuple[Floats, ...] = ()
    for place in range(position + 1):
        slope = WindySlope(n_per_kn, wind_m_s, bends_drawn(random, count, place))
        begin = 0.5 * CUT_M if place == 0 else ROUTES.exit_m[0, place - 1] + LAST_M
        leaves = np.full(count, 1.5 if place == 0 else EXITS_M_S[place - 1])
        end = np.full((count, 1), ROUTES.entrance_m[0, place] + FIRST_M)
        found += (slope.roll_on(rows, rows, np.full(count, begin), leaves, end).speed_m_s[:, 0],)
    return found


def rolled(n_per_kn: Floats, wind_m_s: Floats, seed: int, position: int = 1) -> CutsAsked:
    """Cuts that come to `position`; STD of w0 and WIND are believed in."""
    count, random = len(n_per_kn), np.random.default_rng(seed)
    speeds = roll(n_per_kn, wind_m_s, random, position)
    memory = TrainMemory(count, 1, ROUTES)
    memory.hump_speed_m_s[:] = 1.5
    for place in range(position):
        memory.begin_s[:, 0, place], memory.end_s[:, 0, place] = 20.0 * place, 20.0 * place + 5.0
        memory.entry_m_s[:, 0, place], memory.exit_m_s[:, 0, place] = speeds[place], EXITS_M_S[place]
    asked = asked_at(ROUTES, position, memory, speeds[position], np.full(count, 900.0))
    trains = alike_cuts(count, np.zeros(count, dtype=np.int64), np.ones(count, dtype=np.int64), seed=seed)
    spread = np.broadcast_to(BENDS_M_S2 / np.sqrt(3.0), (32, 3))
    prior = ResistancePrior(np.full(count, STD), np.full(count, AIR), 0.0, WIND, spread, np.zeros((32, 3)))
    mean = tuple(WindySlope(np.full(count, MEAN), np.zeros(count), np.full(count, c)) for c in BENDS_M_S2)
    way = ExpectedWay(ByStretch(mean), np.full(count, MEAN), np.full(count, GRAVITY_M_S2))
    return CutsAsked(n_per_kn, wind_m_s, asked, MeasuredRollability(SpeedSensors(ROUTES, trains, STD_M_S), way, prior))


@dataclass(frozen=True)
class ByStretch:
    """Rolls with the bends of the stretch on which the cuts begin."""

    slopes: tuple[WindySlope, ...]

    def roll_on(
        self,
        rows: Ints,
        routes: Ints,
        start_m: Floats,
        speed_m_s: Floats,
        stations_m: Floats,
        resistance_n_per_kn: Floats | None = None,
    ) -> Rolled:
        """See the class."""
        place = int((start_m[0] > ROUTES.exit_m[0]).sum())
        return self.slopes[place].roll_on(rows, routes, start_m, speed_m_s, stations_m, resistance_n_per_kn)


def drawn_cuts(count: int, seed: int) -> tuple[Floats, Floats]:
    random = np.random.default_rng(seed)
    return random.gamma((MEAN / STD) ** 2, STD**2 / MEAN, count), WIND * random.standard_normal(count)


@pytest.mark.parametrize("position", [0, 1, 2])
def test_measured_cuts_are_as_uncertain_as_they_say(position: int) -> None:
    count = 8000
    cuts = rolled(*drawn_cuts(count, 1), seed=2, position=position)
    told = cuts.measured.expected(cuts.asked)
    error = (told.mean_n_per_kn - cuts.ahead_n_per_kn) / told.std_n_per_kn
    assert error.mean() == pytest.approx(0.0, abs=0.06)  # the air is not linear in the wind
    assert error.std() == pytest.approx(1.0, abs=0.06)
    assert (np.abs(error) < 1.96).mean() == pytest.approx(0.95, abs=0.015)
    before = cuts.measured.on_the_way(
        cuts.measured.before_the_crest(np.arange(count)), np.arange(count), cuts.asked.start.speed_m_s
    )
    gained = (told.mean_n_per_kn - cuts.ahead_n_per_kn).var() / (before.mean_n_per_kn - cuts.ahead_n_per_kn).var()
    assert gained == pytest.approx((told.std_n_per_kn**2).mean() / (before.std_n_per_kn**2).mean(), rel=0.1)
    assert gained < (0.75, 0.5, 0.3)[position]


def test_one_cut_by_brute_force() -> None:
    """Bayes' rule on 300 000 cuts, each weighted by the likelihood of what was read of one cut."""
    one = rolled(np.array([2.4]), np.array([-2.0]), seed=11)
    sensors, random, count = one.measured.sensors, np.random.default_rng(12), 300_000
    first, second = (sensors.stretch(one.asked, position) for position in (0, 1))
    n_per_kn, wind = MEAN + STD * random.standard_normal(count), WIND * random.standard_normal(count)
    begins = 1.5 + np.zeros(count), second.from_m_s + STD_M_S * random.standard_normal(count)
    weight, rows = np.zeros(count), np.arange(count)
    for place, (stretch, begin) in enumerate(zip((first, second), begins, strict=True)):
        slope = WindySlope(n_per_kn, wind, bends_drawn(random, count, place))
        at, end = np.repeat(stretch.from_m, count), np.repeat(stretch.to_m, count)[:, None]
        comes = slope.roll_on(rows, rows, at, begin, end).speed_m_s[:, 0]
        weight -= 0.5 * ((comes - stretch.to_m_s) / STD_M_S) ** 2
    weight = np.exp(weight - weight.max())
    weight /= weight.sum()
    assert 1.0 / (weight**2).sum() > 3_000  # cuts that count
    speed = one.asked.start.speed_m_s
    ahead = n_per_kn + AIR * ((speed + wind) * np.abs(speed + wind) - speed**2)
    mean = (weight * ahead).sum()
    std = np.sqrt((weight * (ahead - mean) ** 2).sum())
    told = one.measured.expected(one.asked)
    assert told.std_n_per_kn[0] == pytest.approx(std, rel=0.1)
    assert told.mean_n_per_kn[0] == pytest.approx(mean, abs=0.2 * std)
    before = one.measured.before_the_crest(np.zeros(1, dtype=np.int64))
    alone = one.measured.on_the_way(before, np.zeros(1, dtype=np.int64), speed)
    assert alone.std_n_per_kn[0] > 1.5 * std


def test_nothing_later_is_looked_at() -> None:
    count = 50
    cuts = rolled(*drawn_cuts(count, 3), seed=4, position=2)
    early = replace(cuts.asked, position=1, start=replace(cuts.asked.start, time_s=np.full(count, 15.0)))
    found = cuts.measured.resistance_n_per_kn(early)
    memory, later = cuts.asked.memory, (slice(None), slice(None), slice(1, None))
    for array in (memory.entry_m_s, memory.exit_m_s, memory.begin_s, memory.end_s, memory.command_m_s):
        array[later] = 1e3
    memory.time_s[:], memory.end_m[:], memory.end_speed_m_s[:] = 1e3, 1e3, 1e3
    assert cuts.measured.resistance_n_per_kn(early).tolist() == found.tolist()
    memory.exit_m_s[:, :, 0] = 4.9
    assert cuts.measured.resistance_n_per_kn(early).tolist() != found.tolist()
    memory.end_s[:, :, 0] = 16.0  # the last axle is still in the first position: its exit speed is not read
    waits = cuts.measured.expected(early)
    only = replace(early, position=0, start=replace(early.start, speed_m_s=memory.entry_m_s[:, 0, 0]))
    first = cuts.measured.measured(cuts.measured.before_the_crest(early.lanes), early.lanes, only, 0)
    assert waits.mean_n_per_kn == pytest.approx(
        cuts.measured.on_the_way(first, early.lanes, early.start.speed_m_s).mean_n_per_kn, abs=1e-12
    )


def test_a_cut_does_not_depend_on_the_others() -> None:
    cuts = rolled(*drawn_cuts(40, 5), seed=6)
    some = np.array([3, 17, 30])
    few = replace(cuts.asked, lanes=some, routes=cuts.asked.routes[some], start=cuts.asked.start.chosen(some))
    all_found = cuts.measured.resistance_n_per_kn(cuts.asked)
    assert cuts.measured.resistance_n_per_kn(few).tolist() == all_found[some].tolist()
