"""What the model has not: other laws, edges, and Holm's rule.

Passes of a plant whose brake or cuts follow a law that the model has not, of a known size.

The simulator has one deceleration for each cell of the path. So a pass is run again and again, each time with the
decelerations that follow from its last speeds, until they stay: then it is the pass of the other law.
Laws that the model has not: said where they are large enough to matter, and not said where they are not there.
Holm's rule against the closed test that it is a short way for: all sets of hypotheses, each by Bonferroni.
A likelihood with an edge whose flat and steep sides are known in closed form, as a flow that begins at a reading.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np
import pytest
from numpy.typing import NDArray

from plant_models.frozen_arrays import Floats
from scripts.studies.identification import TRUTHS, Yard
from synth.kernels.loop.passes import Draws
from synth.logs import unknowns as asked
from synth.logs.estimate import CENTRAL, NEAR, Estimate, Linearised, Posterior, Side, beside_edges, highest
from synth.logs.fitting_passes import FittingPasses
from synth.logs.residual_tests import LAWS, PRESSURE, Effect, ResidualTest, beyond, rejected, residual_tests, wrong
from synth.logs.unknowns import positive, unknowns_of
from synth.simulation.closed_loop import ClosedLoop
from synth.simulation.controllers import Controller
from synth.simulation.passes import PassTrace
from synth.simulation.sampled_pass import rows_of_pass
from tests.effort import every

Speeds = NDArray[np.float64]
USUAL_M_S, USUAL_KPA = 4.0, 300.0
MOST_RUNS, SAME = 100, 1e-9
"""Runs of one pass, and how near to each other the relative changes of two of them are in the end."""


@dataclass(frozen=True)
class OtherLaws:
    """Relative changes: of friction and of running resistance by each m/s above 4 m/s, of the force at 600 kPa."""

    friction_by_speed: float = 0.0
    resistance_by_speed: float = 0.0
    force_by_pressure: float = 0.0

    def rows_of_pass(self, loop: ClosedLoop, controller: Controller, draws: Draws, number: int) -> Speeds:
        """As that of `logged_passes`, under these laws."""
        one = Draws._make(part[number : number + 1] for part in draws)
        lawful, own = self.settled(loop, controller, one)
        return rows_of_pass(lawful, controller, own, 0)

    def settled(self, loop: ClosedLoop, controller: Controller, one: Draws) -> tuple[ClosedLoop, Draws]:
        """Loop and draws of one pass in which every cell has these laws at the speed with which it is passed."""
        bent = replace(loop, drive=loop.drive._replace(
            mode_overpressure_kpa=self.bent(loop.drive.mode_overpressure_kpa),
            chain_overpressure_kpa=self.bent(loop.drive.chain_overpressure_kpa),
        ))  # fmt: skip
        middle = 0.5 * (loop.path.edges_m[1:] + loop.path.edges_m[:-1])
        drag = loop.path.drag_m_s2_per_n_kn * float(one.resistance_n_kn[0])
        now, own, before = bent, one, np.full(len(middle), np.inf)
        for _ in range(MOST_RUNS):
            above = speeds_at(middle, now.follow(controller, own)) - USUAL_M_S
            if np.max(np.abs(above - before)) < SAME:
                return now, own
            before = above
            slopes = one.brake_m_s2_per_kpa * (1.0 + self.friction_by_speed * above)
            gravity = loop.path.gravity_m_s2 - drag * self.resistance_by_speed * above
            own = one._replace(brake_m_s2_per_kpa=read_only(slopes))
            now = replace(bent, path=loop.path._replace(gravity_m_s2=read_only(gravity)))
        raise AssertionError(f"a pass does not settle within {MOST_RUNS} runs")

    def bent(self, overpressure_kpa: Speeds) -> Speeds:
        """The overpressure that brakes as these laws say where the force is straight in it."""
        return read_only(overpressure_kpa * (1.0 + self.force_by_pressure * (overpressure_kpa / USUAL_KPA - 1.0)))


def speeds_at(path_m: Speeds, trace: PassTrace) -> Speeds:
    """Speed of a pass at places; beyond its end, that of the end."""
    return np.asarray(np.interp(path_m, trace.path_m, trace.speed_m_s))


def read_only(values: Speeds) -> Speeds:
    """As the kernels know their arrays."""
    values.setflags(write=False)
    return values


PASSES, SEED = 200, 11
BY_SPEED, BENT, RESISTANCE = LAWS.values()


def told_by(passes: FittingPasses, yard: Yard) -> dict[Effect, ResidualTest]:
    """The tests at the true numbers, by what they look for: an estimate would take a minute."""
    unknowns = unknowns_of(passes, yard.config.parameters)
    truth = TRUTHS[0].values(tuple(unknown.key for unknown in unknowns))
    u = np.array([unknown.standing(truth[unknown.key]) for unknown in unknowns])
    there = Estimate(unknowns, len(passes), 0.0, u, np.eye(len(u)), np.eye(len(u)))
    return {test.effect: test for test in residual_tests(passes, there, 2)}


def said(tests: dict[Effect, ResidualTest]) -> set[Effect]:
    return {test.effect for test in wrong(tuple(tests.values()))}


def under(laws: OtherLaws, yard: Yard, monkeypatch: pytest.MonkeyPatch) -> FittingPasses:
    monkeypatch.setattr("synth.simulation.sampled_pass.rows_of_pass", laws.rows_of_pass)
    return yard.passes(TRUTHS[0], PASSES, SEED)


@pytest.fixture(scope="module")
def lawful(yard: Yard) -> FittingPasses:
    return yard.passes(TRUTHS[0], PASSES, SEED)


@pytest.mark.parametrize(
    ("laws", "effect", "size"),
    every(
        3,
        [
            (OtherLaws(friction_by_speed=-0.05), BY_SPEED, -5.0),
            (OtherLaws(force_by_pressure=0.15), BENT, 15.0),
            (OtherLaws(resistance_by_speed=0.3), RESISTANCE, 30.0),
        ],
    ),
)
def test_a_law_that_matters_is_found_with_its_size(
    laws: OtherLaws, effect: Effect, size: float, yard: Yard, monkeypatch: pytest.MonkeyPatch
) -> None:
    tests = told_by(under(laws, yard, monkeypatch), yard)
    assert effect in said(tests)
    low, high = tests[effect].interval
    assert abs(tests[effect].size - size) < high - low + 0.2 * abs(size)


@pytest.mark.parametrize(("amplitude_kpa", "speaks"), [(2.0, False), (8.0, True)])
def test_what_stays_in_the_gauge_is_told_in_kpa(
    amplitude_kpa: float, speaks: bool, yard: Yard, lawful: FittingPasses
) -> None:
    """A slow wave of the pressure, its rms amplitude / √2."""
    log = lawful.log
    wave = amplitude_kpa * np.sin(2.0 * np.pi * log.time_s / 1.7)
    tests = told_by(replace(lawful, log=replace(log, pressure_kpa=log.pressure_kpa + wave)), yard)
    assert (PRESSURE in said(tests)) == speaks
    assert tests[PRESSURE].size == pytest.approx(amplitude_kpa / np.sqrt(2.0), rel=0.1)


def test_what_is_beyond_is_a_p_value_of_both_sides() -> None:
    """Against draws, at the edge of what does not matter."""
    rng = np.random.default_rng(1)
    drawn = np.abs(2.0 + 1.5 * rng.standard_normal(400_000))
    for size in (0.5, 2.5, -6.0):
        assert beyond(size, 1.5, 2.0) == pytest.approx(np.mean(drawn >= abs(size)), abs=3e-3)
    assert beyond(1.96, 1.0, 0.0) == pytest.approx(0.05, abs=1e-4)


def test_keys_of_the_laws_are_those_of_the_likelihood() -> None:
    assert list(LAWS) == [asked.FRICTION_BY_SPEED, asked.FORCE_BY_PRESSURE, asked.RESISTANCE_BY_SPEED]


def by_closure(p_values: list[float], level: float) -> set[int]:
    """A hypothesis falls where every set that it is in falls."""
    numbers = range(len(p_values))
    sets = [each for size in range(1, len(p_values) + 1) for each in combinations(numbers, size)]
    falls = {each: min(p_values[i] for i in each) <= level / len(each) for each in sets}
    return {i for i in numbers if all(falls[each] for each in sets if i in each)}


@pytest.mark.parametrize("count", [1, 2, 3, 6])
def test_it_is_the_closed_test_of_bonferroni(count: int) -> None:
    rng = np.random.default_rng(count)
    sizes = set()
    for _ in range(300):
        ps = (rng.random(count) ** 4).tolist()
        found = rejected(ps, 0.1)
        assert set(found) == by_closure(ps, 0.1)
        assert [ps[i] for i in found] == sorted(ps[i] for i in found)
        sizes.add(len(found))
    assert sizes == set(range(count + 1)), "some answers were never asked for"


def test_what_is_not_known_does_not_pass_and_counts() -> None:
    assert rejected([float("nan"), 0.01], 0.02) == (1,)
    assert rejected([float("nan"), 0.011], 0.02) == ()
    assert rejected([], 0.05) == ()


EDGE, FLAT_STD, STEEP = 0.15, 0.06, 4000.0


class Edged(Posterior):
    """Two observations: one of the number itself, and a reading that moves with it beyond the edge only."""

    def __init__(self, flat: float, noise: float) -> None:
        super().__init__((), (positive(asked.TOUCH_DELAY, "s", 0.1, 0.05, 0.2),), 1)
        self.flat, self.noise = flat, noise

    def innovations(self, u: float) -> Floats:
        """Of both observations, over their standard deviations."""
        return np.array([(self.flat - u) / FLAT_STD, self.noise - STEEP * max(0.0, u - EDGE)])

    def value(self, u: Floats) -> float:
        r = self.innovations(float(u[0]))
        return 0.5 * float(u @ u + r @ r)

    def linearised_by(self, u: Floats, sides: Mapping[str, Side]) -> Linearised:
        side = sides.get(asked.TOUCH_DELAY, CENTRAL)
        ends = [self.innovations(float(u[0]) + place) for place in (side.to, side.start)]
        by_u = (ends[0] - ends[1]) / (side.to - side.start)
        score = -float(by_u @ self.innovations(float(u[0])))
        return Linearised(-self.value(u), np.array([[score]]), np.array([[float(by_u @ by_u)]]))

    @property
    def flat_summit(self) -> float:
        """Of the flat side, if the edge were not there."""
        return self.flat / (1.0 + FLAT_STD**2)

    @property
    def std(self) -> float:
        """Standard error of the flat side."""
        return 1.0 / math.sqrt(1.0 + FLAT_STD**-2)


def found(target: Edged, start: float) -> tuple[float, float]:
    """The summit that counts, and its standard error."""
    u, there = beside_edges(target, highest(target, np.array([start]), NEAR))
    return float(u[0]), 1.0 / math.sqrt(1.0 + float(there.information[0, 0]))


def test_the_flat_summit_counts_though_noise_makes_the_edge_a_little_higher() -> None:
    target = Edged(0.1, 1.5)
    on_edge = highest(target, np.array([EDGE]), NEAR)
    assert EDGE < on_edge[0] < EDGE + 2.0 / STEEP
    assert target.value(on_edge) < target.value(np.array([target.flat_summit])), "it is not the most likely point"
    u, std = found(target, EDGE)
    assert u == pytest.approx(target.flat_summit, abs=2.0 * NEAR * target.std)
    assert std == pytest.approx(target.std, rel=1e-6)


def test_readings_far_beyond_chance_hold_the_edge() -> None:
    target = Edged(0.1, 4.0)
    u, std = found(target, EDGE)
    assert EDGE < u < EDGE + 8.0 / STEEP
    assert std == pytest.approx(target.std, rel=1e-6)


def test_a_flat_side_that_rises_towards_the_edge_ends_there() -> None:
    target = Edged(0.2, 0.0)
    u, std = found(target, 0.0)
    assert u == pytest.approx(EDGE, abs=3.0 / STEEP)
    assert std == pytest.approx(target.std, rel=1e-6)


def test_a_number_well_beyond_the_edge_is_as_sharp_as_the_readings_tell() -> None:
    target = Edged(0.2, 0.05 * STEEP)
    u, std = found(target, 0.21)
    assert u == pytest.approx(EDGE + 0.05, abs=1.0 / STEEP)
    assert std == pytest.approx(1.0 / STEEP, rel=1e-3)
