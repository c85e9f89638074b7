"""A position that is stuck: what it takes from cuts, by hand, and beside the sound position."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from plant_models import PlantError
from plant_models.library.catalogue import load_car, load_position, load_weight_categories
from scripts.studies.control_computer.stuck_position import StuckPosition, StuckStage, released
from synth.hump.trains.hump_position import Arrivals
from synth.hump.trains.normal_hump_position import LibraryBrake, NormalHumpPosition

BRAKE = LibraryBrake(load_position("knp-5-bunch").position, load_weight_categories(), load_car("gondola-4").car)


def test_stuck_released_it_lets_all_roll(arrivals: Callable[..., Arrivals]) -> None:
    """As a sound position without brake power does."""
    came = arrivals(30, commanded_m_s=1.0)
    passed, powerless = StuckPosition(released).passed(came), NormalHumpPosition(0.3, released).passed(came)
    assert (passed.exit_m_s == came.unbraked_exit_m_s).all()
    assert (passed.exit_m_s == powerless.exit_m_s).all()
    assert (passed.time_s == powerless.time_s).all()
    assert (passed.switchings == 0).all()


def test_stuck_at_a_stage_by_hand(arrivals: Callable[..., Arrivals]) -> None:
    """90 t, four wheel pairs, stage 2 rests 15 kPa below 300, 50 of which touch; 20/550 kN/kPa over 24.95 m."""
    came = replace(arrivals(3, mass_t=90.0, unbraked_m_s=6.0, category=4), commanded_m_s=np.array([0.5, 3.0, 9.0]))
    passed = StuckPosition(StuckStage(BRAKE, 2)).passed(came)
    expected = np.sqrt(6.0**2 - 2.0 * 4 * 235.0 * 20.0 / 550.0 * 24.95 / (90.0 + 0.42 * 4))
    np.testing.assert_allclose(passed.exit_m_s, expected, rtol=1e-9)
    np.testing.assert_allclose(passed.time_s, 2.0 * 37.45 / (6.0 + expected), rtol=1e-9)


def test_stuck_at_the_stage_that_a_category_is_allowed_it_is_the_full_brake(arrivals: Callable[..., Arrivals]) -> None:
    """A sound position that is commanded to stop a cut of category 1 gives it stage 2 all along."""
    came = arrivals(5, mass_t=60.0, commanded_m_s=0.0, category=0)
    stuck, sound = StuckPosition(StuckStage(BRAKE, 2)), NormalHumpPosition(0.0, BRAKE)
    np.testing.assert_allclose(stuck.passed(came).exit_m_s, sound.passed(came).exit_m_s, rtol=1e-12)
    higher = StuckPosition(StuckStage(BRAKE, 3)).passed(came).exit_m_s
    assert (higher < sound.passed(came).exit_m_s).all()


def test_it_holds_a_cut_that_has_less_energy(arrivals: Callable[..., Arrivals]) -> None:
    passed = StuckPosition(StuckStage(BRAKE, 4)).passed(arrivals(5, mass_t=30.0))
    assert (passed.exit_m_s == 0.0).all()
    assert np.isinf(passed.time_s).all()


def test_with_less_supply_it_takes_less(arrivals: Callable[..., Arrivals]) -> None:
    came = arrivals(2)
    half = StuckStage(replace(BRAKE, share=0.5), 3)(came)
    np.testing.assert_allclose(half, 0.5 * StuckStage(BRAKE, 3)(came), rtol=1e-12)


@pytest.mark.parametrize("stage", [0, 5])
def test_a_stage_that_is_not_there_is_refused(stage: int) -> None:
    with pytest.raises(PlantError, match="the stages 1 to 4"):
        StuckStage(BRAKE, stage)
