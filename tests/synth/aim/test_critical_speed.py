"""A roll backwards tells what a roll forwards does: the two know nothing of each other's result."""

from __future__ import annotations

import numpy as np
import pytest

from synth.aim.outcome import couplings
from synth.aim.position_models import NormalPosition
from synth.aim.scene import AimScene
from tests.synth.aim.conftest import HEAVY, LIGHT

MARGIN_M_S = 0.003


@pytest.mark.parametrize("cars", [1, 4])
@pytest.mark.parametrize("category", [LIGHT, HEAVY], ids=["light", "heavy"])
@pytest.mark.parametrize("distance", [40.0, 250.0])
def test_cuts_couple_too_fast_exactly_above_their_threshold(
    scene: AimScene, category: object, cars: int, distance: float
) -> None:
    cuts = scene.draw(category, cars, 3, 0, 2000)  # type: ignore[arg-type]  # parametrized
    arrival = cuts.release_m + distance
    exits = NormalPosition(0.1, only_brakes=False).exits(cuts)
    threshold = exits.threshold(cuts.critical_speeds_m_s(arrival))
    for side, too_fast in ((-MARGIN_M_S, False), (MARGIN_M_S, True)):
        met = couplings(cuts, exits, np.maximum(threshold, 0.0) + side, arrival)
        told = np.isfinite(threshold) & (threshold + exits.error_m_s > 0.2)
        assert told.mean() > 0.9
        assert ((met.speed_m_s > scene.coupling_speed_m_s)[told] == too_fast).all()


def test_a_cut_that_no_exit_speed_serves_arrives_too_fast_from_a_crawl(steep: AimScene) -> None:
    cuts = steep.draw(HEAVY, 1, 3, 0, 500)
    arrival = cuts.release_m + 200.0
    critical = cuts.critical_speeds_m_s(arrival)
    never = critical == 0.0
    assert never.mean() > 0.5
    met = couplings(cuts, NormalPosition().exits(cuts), np.full(500, 0.05), arrival)
    assert (met.speed_m_s[never] > steep.coupling_speed_m_s).all()


def test_a_gap_is_what_stays_free_before_the_standing_cars(scene: AimScene) -> None:
    cuts = scene.draw(LIGHT, 1, 3, 0, 500)
    arrival = cuts.release_m + 300.0
    exits = NormalPosition(only_brakes=False).exits(cuts)
    commanded = np.full(500, 1.5)
    met, stops = couplings(cuts, exits, commanded, arrival), cuts.stops_m(commanded)
    short = stops < arrival
    assert 0.3 < short.mean() < 1.0
    assert met.gap_m[short] == pytest.approx((arrival - stops)[short], abs=0.05)
    assert (met.gap_m[~short] == 0.0).all()
    assert ((met.speed_m_s > 0.0) == ~short).all()


def test_a_command_that_is_no_number_is_refused(scene: AimScene) -> None:
    cuts = scene.draw(LIGHT, 1, 3, 0, 5)
    with pytest.raises(ValueError, match="not a finite number"):
        couplings(cuts, NormalPosition().exits(cuts), np.full(5, np.nan), cuts.release_m + 50.0)
