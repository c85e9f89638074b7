"""What exit speeds give, as curves: chance of over-speed and mean gap over speed, and how runners roll unbraked."""

from __future__ import annotations

import numpy as np

from plant_models.frozen_arrays import Floats, frozen_arrays
from plant_models.library.weight_category import WeightCategory
from synth.aim.aim_table import AimOrder
from synth.aim.knowledge import thresholds_of
from synth.aim.scene import AimScene

CURVE_CUTS = 4000
"""Cuts that curves are of."""

SPEEDS = 40
"""Exit speeds of a curve."""

STATION_M = 5.0
"""Distance of the places at which runners are told."""

RUNNERS = (0.05, 0.5, 0.95)
"""Quantiles of speed: a bad, a middling and a good runner."""


@frozen_arrays
class AimCurves:
    """Cuts of `cars` cars of a category that are all told one speed: at `speed_m_s` (k,) and every free distance (d,)
    the share of `overspeed` (d, k) and the mean gap of a cut, `gap_m` (d, k), of `cuts` cuts."""

    category: WeightCategory
    cars: int
    free_distances_m: tuple[float, ...]
    required: float
    speed_m_s: Floats
    overspeed: Floats
    gap_m: Floats
    cuts: int


def aim_curves(scene: AimScene, order: AimOrder, cars: int) -> AimCurves:
    """The curves of cuts that no table was chosen on."""
    first = order.design_cuts + order.report_cuts
    cuts = scene.draw(order.category, cars, order.seed, first, CURVE_CUTS)
    exits = order.position.exits(cuts)
    arrivals = [cuts.release_m + distance for distance in order.free_distances_m]
    thresholds = np.stack([exits.threshold(cuts.critical_speeds_m_s(arrival)) for arrival in arrivals], axis=1)
    sorted_ones = thresholds_of(thresholds)
    known = thresholds[np.isfinite(thresholds)]
    low, high = order.requirement.bounds_m_s
    if len(known):
        low, high = max(low, float(np.quantile(known, 0.001))), min(high, float(np.quantile(known, 0.98)))
    speeds = np.linspace(low, max(high, low + 0.1), SPEEDS)
    over = np.stack([sorted_ones.overspeed(np.full(len(arrivals), v)) for v in speeds], axis=1)
    gaps = np.empty((len(arrivals), SPEEDS))
    for k, v in enumerate(speeds):
        stops = cuts.stops_m(exits.at(np.full(len(cuts), v)))
        gaps[:, k] = [np.maximum(arrival - stops, 0.0).mean() for arrival in arrivals]
    return AimCurves(
        order.category, cars, order.free_distances_m, order.requirement.p_overspeed, speeds, over, gaps, CURVE_CUTS
    )


@frozen_arrays
class Runners:
    """Single cars of a category that leave the bunch position and are not braked behind it.

    `head_m` (k,): where the head is; `energy_head_m` (3, k): v²/(2 g') at the quantiles `RUNNERS` of the speed there.
    """

    category: WeightCategory
    head_m: Floats
    energy_head_m: Floats
    cuts: int


def runners(scene: AimScene, category: WeightCategory, seed: int) -> Runners:
    """How they roll from the begin of the measured stretch to the end of the track."""
    cuts = scene.draw(category, 1, seed, 0, CURVE_CUTS // 2)
    start = float(cuts.begin_m.max())
    stations = np.arange(np.ceil(start), scene.track.end_m, STATION_M)
    at = np.broadcast_to(stations, (len(cuts), len(stations)))
    speed = cuts.rolling.roll_on(cuts.begin_m, cuts.stretch_speed_m_s, np.array(at)).speed_m_s
    gravity = float(np.median(cuts.rolling.cuts.reduced_gravity_m_s2))
    heads = np.quantile(speed, RUNNERS, axis=0) ** 2 / (2.0 * gravity)
    return Runners(category, stations, heads, len(cuts))
