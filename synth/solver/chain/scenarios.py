"""What is hidden of a pass: friction and resistance of the cut as weighted scenarios, friction along the path as a
Markov chain over path quanta, and its mean over a transient.
"""

from __future__ import annotations

import math

import numpy as np

from plant_models import Friction, Plant
from plant_models.frozen_arrays import Floats, Ints, frozen_arrays
from synth.kernels.sweep.chain_arrays import PathNoise, TransientNoise


@frozen_arrays
class Scenarios:
    """Hidden constants of a pass: friction factor ξ_cut, added acceleration by w − E w, weights; shape (I,)."""

    factor: Floats
    extra_m_s2: Floats
    weight: Floats


RARE, RARE_IN_A_CHECK = 0.1, 0.03
"""Nodes of ξ_cut of less weight have the mean running resistance alone, in a design and in a prediction."""


def persistent_scenarios(plant: Plant, friction_nodes: int, resistance_nodes: int) -> Scenarios:
    """Gauss–Hermite nodes of ξ_cut, each with the Gauss nodes of w, or where it is `RARE` with the mean of w."""
    z, z_weight = np.polynomial.hermite_e.hermegauss(friction_nodes)
    return paired(plant, z, z_weight / z_weight.sum(), resistance_nodes, RARE)


def check_scenarios(plant: Plant, friction_nodes: int, resistance_nodes: int) -> Scenarios:
    """Scenarios for a prediction that must get the tails right.

    ξ_cut at equally spaced nodes up to four standard deviations (the cost has a kink where the brake power ends, which
    a Gauss rule misses), each with the Gauss nodes of w, or where it is `RARE_IN_A_CHECK` with the mean of w. In long
    passes the two do not add up: with w as its main effect alone ten cars of 535 t were predicted 12 % too well.
    """
    return paired(plant, *equally_spaced_normal(friction_nodes), resistance_nodes, RARE_IN_A_CHECK)


def paired(plant: Plant, z: Floats, z_weight: Floats, resistance_nodes: int, rare: float) -> Scenarios:
    """Nodes `z` of the standard normal law of ξ_cut with their weights, each with those of w unless it is `rare`.

    The law of ξ_cut is kept; that of w but for the cuts whose friction is rare.
    """
    spread, at_mean = resistance_scenarios(plant, resistance_nodes), (np.zeros(1), np.ones(1))
    resistance = [at_mean if weight < rare else spread for weight in z_weight]
    return Scenarios(
        factor=np.repeat(plant.friction.cut_factor(z, plant.friction_cv), [len(extra) for extra, _ in resistance]),
        extra_m_s2=np.concatenate([extra for extra, _ in resistance]),
        weight=np.concatenate([share * weight for share, (_, weight) in zip(z_weight, resistance, strict=True)]),
    )


def equally_spaced_normal(count: int) -> tuple[Floats, Floats]:
    """Nodes from −4 to 4 and trapezoidal weights of the standard normal law, (count,) each."""
    z = np.linspace(-4.0, 4.0, count)
    weight = np.exp(-0.5 * z**2)
    return z, weight / weight.sum()


def resistance_scenarios(plant: Plant, count: int) -> tuple[Floats, Floats]:
    """(added acceleration of w − E w in m/s², probability) at Gauss nodes of the gamma law."""
    w, weight = plant.resistance.nodes(count)
    return -plant.cut.reduced_gravity_m_s2 * 1e-3 * (w - plant.resistance.mean_n_per_kn), weight


def correlated_noise(friction: Friction, quantum_m: float, levels: int) -> PathNoise:
    """Rouwenhorst's chain: variance and exponential autocorrelation of η exactly, for any quantum.

    One level means no path noise. Source: Kopecky & Suen, Rev. Econ. Dyn. 13 (2010), §2.
    """
    if levels == 1 or friction.path_std == 0.0:
        return PathNoise(np.zeros(1), np.ones((1, 1)), np.ones(1))
    stay = 0.5 * (1.0 + float(friction.path_correlation(quantum_m)))
    matrix = np.array([[stay, 1 - stay], [1 - stay, stay]])
    for size in range(3, levels + 1):
        grown = np.zeros((size, size))
        grown[:-1, :-1] += stay * matrix
        grown[:-1, 1:] += (1 - stay) * matrix
        grown[1:, :-1] += (1 - stay) * matrix
        grown[1:, 1:] += stay * matrix
        grown[1:-1] /= 2.0
        matrix = grown
    span = float(friction.path_cell_std(quantum_m)) * math.sqrt(levels - 1)
    stationary = np.array([math.comb(levels - 1, i) for i in range(levels)]) / 2.0 ** (levels - 1)
    values = np.maximum(np.linspace(-span, span, levels), -1.0)  # bars brake or do nothing
    return PathNoise(values, matrix / matrix.sum(axis=1, keepdims=True), stationary)


def transient_noise(chain: PathNoise, overpressure: Floats, periods: Ints, longest: int) -> TransientNoise:
    """Exact first and second moments of Σ g_t η_t along the chain, weights g_t following the brake force.

    `overpressure` (C, max(periods)·substeps): force profile over time, of which the first `periods` of each row
    count; it is laid over the quanta as if speed were constant. `longest`: R.
    """
    weights = force_weights(overpressure, periods, longest)
    count, size = len(periods), len(chain.levels)
    level, square = chain.levels, chain.levels**2
    shape = (count, longest, size, size)
    zeroth = np.broadcast_to(np.eye(size), shape).copy()
    first = np.zeros(shape)
    second = np.zeros(shape)
    for t in range(longest):
        g = weights[:, :, t, None, None]
        second = second + 2.0 * g * first * level + g**2 * zeroth * square
        first = first + g * zeroth * level
        goes_on = (np.arange(longest) > t)[None, :, None, None]
        zeroth = np.where(goes_on, one_quantum_on(zeroth, chain.transition), zeroth)
        first = np.where(goes_on, one_quantum_on(first, chain.transition), first)
        second = np.where(goes_on, one_quantum_on(second, chain.transition), second)
    mean = first / zeroth.clip(1e-300)
    variance = (second / zeroth.clip(1e-300) - mean**2).clip(0.0)
    return TransientNoise(zeroth, mean, np.sqrt(variance))


def one_quantum_on(matrices: Floats, transition: Floats) -> Floats:
    """`matrices` @ `transition`, summed level by level: BLAS would round by its own kernel for the processor."""
    total: Floats = matrices[..., :, :1] * transition[0]
    for level in range(1, len(transition)):
        total = total + matrices[..., :, level : level + 1] * transition[level]
    return total


def force_weights(overpressure: Floats, periods: Ints, longest: int) -> Floats:
    """g (C, R, R): share of the brake work done in quantum t = 0 … r of a transient of r + 1 quanta."""
    steps = overpressure.shape[1]
    used = np.rint(periods * (steps / periods.max())).astype(int)
    weights = np.zeros((len(periods), longest, longest))
    for c, last in enumerate(used):
        work = np.concatenate([[0.0], np.cumsum(overpressure[c, :last])])
        if work[-1] <= 0.0:
            work = np.arange(last + 1.0)
        for r in range(longest):
            edges = np.interp(np.linspace(0.0, last, r + 2), np.arange(last + 1), work)
            weights[c, r, : r + 1] = np.diff(edges) / work[-1]
    return weights
