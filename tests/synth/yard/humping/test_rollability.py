"""What is measured of a cut tells its resistance as well as Bayes' rule can, and says how well."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest
from numpy.typing import NDArray

from synth.yard.free_roll import Rolled
from synth.yard.humping.expected_way import ExpectedWay
from synth.yard.humping.humping import Asked
from synth.yard.humping.resistance_prior import ResistancePrior
from synth.yard.humping.rollability import MeasuredRollability
from synth.yard.humping.speed_sensors import SpeedSensors
from synth.yard.humping.train_memory import TrainMemory
from tests.synth.yard.humping.asked_cuts import CUT_M, FIRST_M, GRADE, GRAVITY_M_S2, LAST_M, AlikeCuts, asked_at, large

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
class Rolled2:
    """Cuts with what was drawn for them, and the question that they put to the control at the second position."""

    n_per_kn: Floats
    wind_m_s: Floats
    asked: Asked
    measured: MeasuredRollability

    @property
    def ahead_n_per_kn(self) -> Floats:
        """Resistance with the wind's part at the speed of the question."""
        speed = self.asked.start.speed_m_s
        return self.n_per_kn + AIR * ((speed + self.wind_m_s) * np.abs(speed + self.wind_m_s) - speed**2)


def bends_drawn(random: np.random.Generator, count: int, position: int) -> Floats:
    return BENDS_M_S2[position] * random.gamma(3.0, 1.0 / 3.0, count)


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


def rolled(n_per_kn: Floats, wind_m_s: Floats, seed: int, position: int = 1) -> Rolled2:
    """Cuts that come to `position`; STD of w0 and WIND are believed in."""
    count, random = len(n_per_kn), np.random.default_rng(seed)
    speeds = roll(n_per_kn, wind_m_s, random, position)
    memory = TrainMemory(count, 1, ROUTES)
    memory.hump_speed_m_s[:] = 1.5
    for place in range(position):
        memory.begin_s[:, 0, place], memory.end_s[:, 0, place] = 20.0 * place, 20.0 * place + 5.0
        memory.entry_m_s[:, 0, place], memory.exit_m_s[:, 0, place] = speeds[place], EXITS_M_S[place]
    asked = asked_at(ROUTES, position, memory, speeds[position], np.full(count, 900.0))
    trains = AlikeCuts(count, np.zeros(count, dtype=np.int64), np.ones(count, dtype=np.int64), seed=seed)
    spread = np.broadcast_to(BENDS_M_S2 / np.sqrt(3.0), (32, 3))
    prior = ResistancePrior(np.full(count, STD), np.full(count, AIR), 0.0, WIND, spread, np.zeros((32, 3)))
    mean = tuple(WindySlope(np.full(count, MEAN), np.zeros(count), np.full(count, c)) for c in BENDS_M_S2)
    way = ExpectedWay(ByStretch(mean), np.full(count, MEAN), np.full(count, GRAVITY_M_S2))
    return Rolled2(n_per_kn, wind_m_s, asked, MeasuredRollability(SpeedSensors(ROUTES, trains, STD_M_S), way, prior))


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
