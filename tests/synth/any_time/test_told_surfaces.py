"""Surfaces for a regulator that is told the friction: each is best at its own, and between them they are joined."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from plant_models import Plant
from synth.problem.aim import Aim
from synth.problem.any_time_resolution import design_resolution
from synth.solver.any_time.sampled_chain import SampledChain, sampled_chain
from synth.solver.any_time.surface_evaluation import SurfaceEvaluation
from synth.solver.any_time.surface_polish import least_gap, polish_surfaces
from synth.solver.any_time.told_surfaces import ToldSurfaces, told_surfaces
from synth.solver.finer_speed import known_factors
from synth.solver.polynomial_lines import MINIMUM_GAP_M_S
from synth.solver.told_lines import SQUARED_ERROR_ALONE
from tests.synth.any_time.test_surfaces import AIM, TARGET_M_S, falling


@pytest.fixture(scope="module")
def design(plant: Plant) -> SampledChain:
    return sampled_chain(plant, design_resolution(plant, TARGET_M_S))


@pytest.fixture(scope="module")
def told(plant: Plant, design: SampledChain) -> ToldSurfaces:
    """From surfaces that are polished for all frictions."""
    common = polish_surfaces(falling(plant), SurfaceEvaluation(design, 2), AIM).best
    found = told_surfaces(design, TARGET_M_S, common)
    return ToldSurfaces(found.factor, found.surfaces)


def cost(design: SampledChain, told: ToldSurfaces, at: float, factor: float) -> float:
    """Of the surfaces for friction `at`, where the friction is `factor`."""
    known = replace(design, scenarios=known_factors(design.plant, np.array([factor]), 1))
    lines = told.at(at).at(design.grid.path_m[:-1], design.modes)
    return SurfaceEvaluation(known).gradient(lines, Aim(TARGET_M_S, SQUARED_ERROR_ALONE)).cost_m2_s2


def test_at_each_friction_its_own_surfaces_are_best(design: SampledChain, told: ToldSurfaces) -> None:
    for factor, other in ((0.85, 1.15), (1.15, 0.85), (1.0, 1.3)):
        assert cost(design, told, factor, factor) < cost(design, told, other, factor)


def test_between_two_frictions_surfaces_are_joined_and_keep_their_distance(told: ToldSurfaces) -> None:
    low, high = told.factor[3:5]
    middle = told.at(float(0.5 * (low + high)))
    mean = 0.5 * (told.surfaces[3].coefficients + told.surfaces[4].coefficients)
    assert middle.coefficients == pytest.approx(mean)
    assert (told.at(0.0).coefficients == told.surfaces[0].coefficients).all()
    assert (told.at(9.0).coefficients == told.surfaces[-1].coefficients).all()
    for factor in np.linspace(0.3, 1.7, 15):
        assert least_gap(told.at(float(factor))).min() >= MINIMUM_GAP_M_S - 1e-9
