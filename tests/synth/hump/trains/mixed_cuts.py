"""Cuts of different numbers of cars that no population made, for routes of three humps."""

from __future__ import annotations

from dataclasses import fields

import numpy as np

from plant_models.hump import Route
from plant_models.library.hump_entry import load_hump
from plant_models.rolling.random_cuts import DrawnCuts
from tests.oracles.rolling.made_cuts import MIX, random_cuts

WIDEST = 10


def route(hump: str, track: int) -> Route:
    """The route to `track` of a hump of the library."""
    graph = load_hump(hump).graph
    return graph.route(graph.leads[0], track)


def mixed_cuts(rng: np.random.Generator, n: int, bends: int, widest: int = WIDEST) -> DrawnCuts:
    """Cuts of 1 to `widest` cars, most of them short, filled up with cars of mass 0; draws for `bends` bends."""
    full = random_cuts(rng, n, widest, bends)
    cars = np.minimum(rng.geometric(0.4, n), widest)
    cars[0] = widest
    real = np.arange(widest) < cars[:, None]
    mass = np.where(real, full.mass_t, 0.0)
    draws = rng.gamma(3.0, size=(n, bends))
    return DrawnCuts(
        mix=MIX,
        types=full.types,
        mass_t=mass,
        basic_n_per_kn=full.basic_n_per_kn,
        head_wind_m_s=full.head_wind_m_s,
        bend_v2_m_s2=draws,
        bend_head_m=draws.copy(),
        air_n_per_kn=rng.uniform(0.2, 1.0, n) / mass.sum(axis=1),
    )


def without_padding(cuts: DrawnCuts, rows: np.ndarray) -> DrawnCuts:
    """The cuts `rows`, all of one number of cars, in arrays of that width."""
    cars = int(cuts.cars_of_cut[rows[0]])
    of_cars = ("types", "mass_t", "basic_n_per_kn")
    arrays = {
        f.name: getattr(cuts, f.name)[rows][:, :cars] if f.name in of_cars else getattr(cuts, f.name)[rows]
        for f in fields(cuts)
        if f.name != "mix"
    }
    return DrawnCuts(mix=cuts.mix, **arrays)
