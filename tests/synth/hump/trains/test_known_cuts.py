"""What is known of cuts before they roll: good and bad runners beside drawn ones."""

from __future__ import annotations

import numpy as np
import pytest

from plant_models.rolling.resistance_law import HumpNormLaw, ResistanceLaw, Tb10062Law
from synth.hump.trains.trial import reduced_gravity_m_s2
from tests.synth.hump.trains.made_trials import Day


@pytest.mark.parametrize("law", [HumpNormLaw(), Tb10062Law()], ids=["norm", "tb 10062"])
def test_good_and_bad_runners_are_those_quantiles_of_drawn_cuts(law: ResistanceLaw) -> None:
    """2.3 % of single cars are below and above; of longer cuts, whose law is not that of a car, 1 to 4 %."""
    trial = Day(cuts=40, most_cars=6, cars_mean=2.0, law=law).on()
    trains = trial.source.trains(0, 300)
    known = trial.known(trains, np.tile(trial.routes.length_m, (300, 1)))
    resistance = trains.drawn.resistance_n_per_kn
    for cars in (1, 2, 4):
        own = trains.cars == cars
        below, above = (resistance < known.good_n_per_kn)[own].mean(), (resistance > known.bad_n_per_kn)[own].mean()
        chance = 4.0 * np.sqrt(0.023 / own.sum())
        if cars == 1:
            assert below == pytest.approx(0.023, abs=chance)
            assert above == pytest.approx(0.023, abs=chance)
        else:
            assert 0.0 <= below < 0.04 + chance
            assert 0.01 - chance < above < 0.04 + chance
    assert (known.good_n_per_kn < known.mean_n_per_kn).all()
    assert (known.mean_n_per_kn < known.bad_n_per_kn).all()


def test_rows_of_a_cut_are_those_of_its_train() -> None:
    trial = Day(cuts=7).on()
    trains = trial.source.trains(3, 5)
    known = trial.known(trains, np.tile(trial.routes.length_m, (5, 1)))
    rows = known.of_cut(2)
    assert rows.tolist() == [2, 9, 16, 23, 30]
    expected = known.expected(rows, known.route[rows], known.mean_n_per_kn[rows])
    np.testing.assert_array_equal(expected.first_axle_m, trains.first_axle_m[rows])
    np.testing.assert_array_equal(expected.cars.routes, trains.route[rows])
    gravity = reduced_gravity_m_s2(trains)
    np.testing.assert_allclose(known.braked_m2_s2, 2.0 * gravity[:, None] * 0.8 * np.array([2.4, 2.4, 1.5]))
    aim = known.aim_of(rows)
    np.testing.assert_allclose(aim.speed_m_s, 1.4, rtol=1e-6)
    np.testing.assert_allclose(np.asarray(aim.most_entry_m_s) ** 2, aim.speed_m_s**2 + known.braked_m2_s2[rows, -1])
