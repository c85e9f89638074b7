"""What is hidden of a pass and constant in it: friction of the cut and running resistance, as weighted scenarios."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from plant_models import Plant
from plant_models.frozen_arrays import frozen_arrays


@frozen_arrays
@dataclass(frozen=True, eq=False)
class Scenarios:
    """Hidden constants of a pass: friction factor ξ_cut, added acceleration by w − E w, weights; shape (I,)."""

    factor: NDArray[np.float64]
    extra_m_s2: NDArray[np.float64]
    weight: NDArray[np.float64]


RARE = 0.1
"""Gauss nodes of ξ_cut of less weight have the mean running resistance alone."""


def persistent_scenarios(plant: Plant, friction_nodes: int, resistance_nodes: int) -> Scenarios:
    """Gauss–Hermite nodes of ξ_cut, each with all Gauss nodes of w, or where it is `RARE` with the mean of w.

    The law of ξ_cut is that of the whole product, that of w too for most of the cuts; and there are half as many
    scenarios.
    """
    z, z_weight = np.polynomial.hermite_e.hermegauss(friction_nodes)
    factor, z_weight = plant.friction.cut_factor(z, plant.friction_cv), z_weight / z_weight.sum()
    spread, at_mean = resistance_scenarios(plant, resistance_nodes), (np.zeros(1), np.ones(1))
    resistance = [at_mean if weight < RARE else spread for weight in z_weight]
    return Scenarios(
        factor=np.repeat(factor, [len(extra) for extra, _ in resistance]),
        extra_m_s2=np.concatenate([extra for extra, _ in resistance]),
        weight=np.concatenate([share * weight for share, (_, weight) in zip(z_weight, resistance, strict=True)]),
    )


def check_scenarios(plant: Plant, friction_nodes: int, resistance_nodes: int) -> Scenarios:
    """Scenarios for a prediction that must get the tails right, and not pay for every pair of (ξ_cut, w).

    ξ_cut at equally spaced nodes up to four standard deviations (the cost has a kink where the brake power
    ends, which a Gauss rule misses); w added as its main effect: E f(ξ, w) ≈ E f(ξ, w̄) + E f(1, w) − f(1, w̄),
    so one weight may be negative. `friction_nodes` must be odd.
    """
    z, z_weight = equally_spaced_normal(friction_nodes)
    extra, w_weight = resistance_scenarios(plant, resistance_nodes)
    z_weight[friction_nodes // 2] -= 1.0
    return Scenarios(
        factor=np.concatenate([plant.friction.cut_factor(z, plant.friction_cv), np.ones(len(extra))]),
        extra_m_s2=np.concatenate([np.zeros(len(z)), extra]),
        weight=np.concatenate([z_weight, w_weight]),
    )


def equally_spaced_normal(count: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Nodes from −4 to 4 and trapezoidal weights of the standard normal law, (count,) each."""
    z = np.linspace(-4.0, 4.0, count)
    weight = np.exp(-0.5 * z**2)
    return z, weight / weight.sum()


def resistance_scenarios(plant: Plant, count: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """(added acceleration of w − E w in m/s², probability) at Gauss nodes of the gamma law."""
    w, weight = plant.resistance.nodes(count)
    return -plant.cut.reduced_gravity_m_s2 * 1e-3 * (w - plant.resistance.mean_n_per_kn), weight
