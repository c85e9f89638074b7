"""Figures of an aim table over all readings together: what a yard gets, whatever is measured of a single cut."""

from __future__ import annotations

import numpy as np

from plant_models.frozen_arrays import Floats, frozen_arrays
from synth.aim.outcome import Couplings


@frozen_arrays
class AimFigures:
    """By cars and distance, each (cars, distances), of all judged cuts: share of over-speed with its exact 95 %
    interval; mean gap of a cut with its normal 95 % interval; share of cuts `without` a command.

    A cut without a command, since none keeps what is required for its reading, is let go at the lowest speed.
    """

    overspeed: Floats
    overspeed_low95: Floats
    overspeed_high95: Floats
    gap_m: Floats
    gap_low95_m: Floats
    gap_high95_m: Floats
    without: Floats


def aim_figures(rows: Floats) -> AimFigures:
    """The figures of `rows` (cars, distances, 7), each made by `figures_row`."""
    return AimFigures(*np.moveaxis(rows, -1, 0))


def figures_row(met: Couplings, without: float) -> Floats:
    """The seven figures of one number of cars and one distance."""
    over, gap = met.overspeed, met.gap_per_car_m
    gaps = met.cars * np.array([gap.value, max(gap.low95, 0.0), gap.high95])
    return np.array([over.value, over.low95, over.high95, *gaps, without])
