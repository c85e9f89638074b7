"""Laws of service: moments against the derivatives of the transform and against draws."""

from __future__ import annotations

import math

import numpy as np
import pytest

from plant_models.errors import PlantError
from synth.computer.sizing.service_law import (
    Constant,
    Erlang,
    Exponential,
    Hyperexponential,
    ServiceLaw,
)

LAWS: tuple[ServiceLaw, ...] = (
    Constant(2.0),
    Erlang(2.0, 1),
    Erlang(2.0, 4),
    Exponential(2.0),
    Hyperexponential(2.0, 1.5),
    Hyperexponential(2.0, 9.0),
)


def squared_cv(law: ServiceLaw) -> float:
    """The squared coefficient of variation, Var X / E[X]²."""
    return law.second_moment / law.mean**2 - 1.0


@pytest.mark.parametrize("law", LAWS, ids=repr)
def test_moments_are_the_derivatives_of_the_transform(law: ServiceLaw) -> None:
    # the n-th derivative at 0 by Cauchy's integral on a circle inside the region where the transform is analytic
    radius, points = 0.02, 64
    angles = 2.0 * math.pi * np.arange(points) / points
    values = law.transform(radius * np.exp(1j * angles))
    first = float(np.mean(values * np.exp(-1j * angles)).real) / radius
    second = 2.0 * float(np.mean(values * np.exp(-2j * angles)).real) / radius**2
    assert -first == pytest.approx(law.mean, rel=1e-11)
    assert second == pytest.approx(law.second_moment, rel=1e-9)
    assert law.transform(np.zeros(1, dtype=np.complex128))[0] == pytest.approx(1.0)


@pytest.mark.parametrize("law", LAWS, ids=repr)
def test_draws_have_the_moments_and_the_transform(law: ServiceLaw) -> None:
    drawn, count = law.draw(np.random.default_rng(5), 400_000), 400_000
    for values, right in (
        (drawn, law.mean),
        (drawn**2, law.second_moment),
        (np.exp(-0.7 * drawn), law.transform(np.array([0.7 + 0j]))[0].real),
    ):
        assert abs(values.mean() - right) <= 4.0 * values.std() / math.sqrt(count) + 1e-12


@pytest.mark.parametrize("law", LAWS, ids=repr)
def test_a_scaled_law_is_the_law_of_scaled_amounts(law: ServiceLaw) -> None:
    s = np.array([0.3 + 0.8j, 4.0 - 1.0j])
    quarter = law.transform(np.asarray(0.25 * s, dtype=np.complex128))
    assert np.allclose(law.scaled(0.25).transform(s), quarter, rtol=1e-14)
    assert law.scaled(0.25).mean == pytest.approx(0.5)
    assert squared_cv(law.scaled(0.25)) == pytest.approx(squared_cv(law))


def test_the_squared_coefficients_of_variation_are_those_of_the_names() -> None:
    assert [squared_cv(law) for law in LAWS] == pytest.approx([0.0, 1.0, 0.25, 1.0, 1.5, 9.0])


def test_balanced_means_are_balanced() -> None:
    law = Hyperexponential(3.0, 4.0)
    short, long = law.part_means
    assert law.short_share * short == pytest.approx((1.0 - law.short_share) * long)
    assert 2.0 * (law.short_share * short**2 + (1.0 - law.short_share) * long**2) == pytest.approx(law.second_moment)


def test_limits_between_laws() -> None:
    s = np.array([0.2 + 3.0j])
    assert np.allclose(Erlang(2.0, 1).transform(s), Exponential(2.0).transform(s))
    assert np.allclose(Hyperexponential(2.0, 1.0 + 1e-12).transform(s), Exponential(2.0).transform(s), rtol=1e-5)
    assert np.allclose(Erlang(2.0, 1_000_000).transform(s), Constant(2.0).transform(s), atol=1e-4)


def test_a_hyperexponential_law_varies_more_than_an_exponential_one() -> None:
    with pytest.raises(PlantError, match=r"squared_cv is 1\.0"):
        Hyperexponential(1.0, 1.0)
