"""A likelihood with an edge whose flat and steep sides are known in closed form, as a flow that begins at a reading."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
import pytest

from plant_models.frozen_arrays import Floats
from synth.logs import unknowns as asked
from synth.logs.estimate import CENTRAL, NEAR, Linearised, Posterior, Side, beside_edges, highest
from synth.logs.unknowns import positive

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
