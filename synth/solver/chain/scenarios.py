"""What is hidden of a pass and constant in it: friction of the cut and running resistance, as weighted scenarios."""

from __future__ import annotations

import numpy as np

from plant_models import Plant
from plant_models.frozen_arrays import Floats, frozen_arrays


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
