"""The filter of a pass against the likelihood by quadrature, and its Ornstein–Uhlenbeck steps against closed forms."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import dblquad

from synth.kernels.measured.pass_filter import BySpeed, Cuts, Rows, Spread, filter_passes, mean_variance

NOISE, CV, MEAN_W, STD_W = 0.05, 0.15, 1.4, 0.4


def rows_of(seed: int, n: int = 14) -> Rows:
    """A pass that brakes from its fourth row on."""
    rng = np.random.default_rng(seed)
    step = np.full(n, 0.5)
    gained, drag = np.full(n, 0.035), np.full(n, 0.0045)
    work = np.where(np.arange(n) >= 3, 0.55, 0.0)
    friction, w = 1.0 + CV * rng.standard_normal(), MEAN_W + STD_W * rng.standard_normal()
    energy = 0.5 * 5.0**2 + np.concatenate(([0.0], np.cumsum(gained - w * drag - friction * work)[:-1]))
    step[-1] = gained[-1] = drag[-1] = work[-1] = 0.0
    return Rows(np.sqrt(2.0 * energy) + NOISE * rng.standard_normal(n), step, gained, drag, work)


def filtered(rows: Rows, path_std: float) -> tuple[np.ndarray, np.ndarray, Cuts]:
    """Innovations, their variances, and what is known of the cut."""
    n = len(rows.speed_m_s)
    innovation, variance = np.empty(n), np.empty(n)
    cuts = Cuts(*(np.empty(1) for _ in Cuts._fields))
    spread = Spread(np.array([CV]), np.array([MEAN_W]), np.array([STD_W]), path_std, 2.0, NOISE, 0.0)
    filter_passes(rows, spread, BySpeed(0.0, 0.0), np.array([0, n]), 0, 1, innovation, variance, cuts)
    return innovation, variance, cuts


def by_quadrature(rows: Rows) -> tuple[float, float]:
    """Logarithm of the likelihood of all readings but the first, given that one, and the mean friction after them."""
    z = np.linspace(-6.0, 6.0, 61)
    many = np.linspace(-6.0, 6.0, 121)
    # What the first reading tells: a flat law of the energy before it, as of the filter.
    start = 0.5 * (rows.speed_m_s[0] ** 2 - NOISE**2) + rows.speed_m_s[0] * NOISE * z
    friction = 1.0 + CV * many
    prior = np.exp(-0.5 * (many[:, None] ** 2 + z**2))
    gained, drag, work = (np.cumsum(x)[:-1] for x in (rows.gained_m2_s2, rows.drag_m2_s2, rows.braked_m2_s2))
    total, moment, whole = 0.0, 0.0, 0.0
    for each in z:
        energy = start[:, None] + gained - (MEAN_W + STD_W * each) * drag - friction[:, None, None] * work
        away = (rows.speed_m_s[1:] - np.sqrt(2.0 * np.maximum(energy, 1e-9))) / NOISE
        chance = math.exp(-0.5 * each**2) * prior * np.exp(-0.5 * (away**2).sum(axis=-1))
        total, moment = total + chance.sum(), moment + (chance * friction[:, None]).sum()
        whole += math.exp(-0.5 * each**2) * prior.sum()
    return math.log(total / whole) - len(work) * math.log(NOISE * math.sqrt(2.0 * math.pi)), moment / total


@pytest.mark.parametrize("seed", [0, 1, 2])
def test_the_likelihood_is_that_of_a_quadrature(seed: int) -> None:
    """Over energy, friction and resistance; the filter is linear about what it expects, which costs little."""
    rows = rows_of(seed)
    innovation, variance, cuts = filtered(rows, 0.0)
    assert math.isnan(innovation[0])
    told = -0.5 * float(np.sum(np.log(2.0 * np.pi * variance[1:]) + innovation[1:] ** 2 / variance[1:]))
    expected, friction = by_quadrature(rows)
    assert told == pytest.approx(expected, abs=0.03)
    assert cuts.friction[0] == pytest.approx(friction, abs=3e-4)


@pytest.mark.parametrize("ratio", [1e-4, 0.049, 0.051, 0.3, 2.0])
def test_the_mean_of_the_path_friction_has_the_variance_of_its_process(ratio: float) -> None:
    """∫∫ of the covariance, given the first value."""
    found, _ = dblquad(lambda s, t: math.exp(s - t) - math.exp(-s - t), 0.0, ratio, 0.0, lambda t: t, epsabs=1e-13)
    assert mean_variance(ratio) == pytest.approx(2.0 * found / ratio**2, rel=2e-4)


def test_readings_that_are_missing_are_left_out() -> None:
    rows = rows_of(3)
    rows.speed_m_s[[0, 5]] = np.nan
    innovation, variance, _ = filtered(rows, 0.1)
    assert np.flatnonzero(np.isnan(innovation)).tolist() == [0, 1, 5]
    assert variance[6] > variance[4]


PASSES, ROWS, ROW_S, PARTS = 4000, 25, 0.1, 8
DECELERATION_M_S2, PATH_STD, LENGTH_M = 1.2, 0.15, 2.0


def braked_passes(seed: int) -> Rows:
    """Passes whose friction is alike at every speed, but not along the path, from 5.5 to 7 m/s at the beginning."""
    rng = np.random.default_rng(seed)
    speed = np.empty((PASSES, ROWS))
    step, v, eta = np.zeros((PASSES, ROWS)), rng.uniform(5.5, 7.0, PASSES), PATH_STD * rng.standard_normal(PASSES)
    friction = 1.0 + CV * rng.standard_normal(PASSES)
    for row in range(ROWS):
        speed[:, row] = v
        for _ in range(PARTS if row < ROWS - 1 else 0):
            lost = friction * (1.0 + eta) * DECELERATION_M_S2 * ROW_S / PARTS
            part, v = (v - 0.5 * lost) * ROW_S / PARTS, v - lost
            step[:, row] += part
            memory = np.exp(-part / LENGTH_M)
            eta = memory * eta + PATH_STD * np.sqrt(1.0 - memory**2) * rng.standard_normal(PASSES)
    read = speed + NOISE * rng.standard_normal(speed.shape)
    nothing = np.zeros(PASSES * ROWS)
    return Rows(read.ravel(), step.ravel(), nothing, nothing, DECELERATION_M_S2 * step.ravel())


def scores(ends: list[tuple[Rows, BySpeed]], size: float) -> np.ndarray:
    """Slope of the log-likelihood of each pass between two ends, `size` from one to the other."""
    spread = Spread(np.full(PASSES, CV), np.zeros(PASSES), np.full(PASSES, 1e-6), PATH_STD, LENGTH_M, NOISE, 0.0)
    told = []
    for rows, by_speed in ends:
        innovation, variance = np.empty(PASSES * ROWS), np.empty(PASSES * ROWS)
        cuts = Cuts(*(np.empty(PASSES) for _ in Cuts._fields))
        first_row = np.arange(PASSES + 1) * ROWS
        filter_passes(rows, spread, by_speed, first_row, 0, PASSES, innovation, variance, cuts)
        terms = np.nan_to_num(np.log(variance) + innovation**2 / variance)
        told.append(-0.5 * terms.reshape(PASSES, ROWS).sum(axis=1))
    return np.asarray((told[1] - told[0]) / size)


def test_friction_that_is_alike_at_every_speed_is_not_said_to_change() -> None:
    """The speed in a law must be one that the readings told. Path by time knows more: a cut that brakes better than any
    reading has told yet is slower by its path, so friction would seem to fall with speed."""
    rows, size = braked_passes(7), 2e-3
    told = scores([(rows, BySpeed(b, 0.0)) for b in (-0.5 * size, 0.5 * size)], size)
    by_path = rows.step_m / ROW_S - 4.0
    wrongly = scores(
        [(rows._replace(braked_m2_s2=rows.braked_m2_s2 * (1.0 + b * by_path)), BySpeed(0.0, 0.0))
         for b in (-0.5 * size, 0.5 * size)], size,
    )  # fmt: skip
    z, z_wrongly = (each.mean() / each.std() * math.sqrt(PASSES) for each in (told, wrongly))
    assert abs(z) < 3.0
    assert z_wrongly < -5.0
