"""The direct search finds the bottom of a narrow valley, and finds it again."""

from __future__ import annotations

import numpy as np
import pytest

from synth.studies.unlocked.evolution import evolve


def test_a_narrow_turned_valley() -> None:
    rng = np.random.default_rng(3)
    turn, _ = np.linalg.qr(rng.standard_normal((8, 8)))
    stiffness = turn @ np.diag(np.logspace(0, 4, 8)) @ turn.T
    bottom = rng.standard_normal(8)

    def cost(x: np.ndarray) -> float:
        return float((x - bottom) @ stiffness @ (x - bottom))

    point, least = evolve(cost, np.zeros(8), 0.5, 6000, seed=1)
    assert least < 1e-10
    assert point == pytest.approx(bottom, abs=1e-4)
    again, _ = evolve(cost, np.zeros(8), 0.5, 6000, seed=1)
    assert (again == point).all()


def test_the_beginning_is_never_lost() -> None:
    point, least = evolve(lambda x: float(np.abs(x).sum()), np.zeros(4), 1.0, 60, seed=2)
    assert least == 0.0
    assert (point == 0.0).all()
