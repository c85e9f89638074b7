"""Tables of exit speeds: the share that they promise, their interpolation, and their faults of input."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from plant_models import PlantError
from synth.aim.aim_table import AimedSpeeds, AimOrder, aimed_speeds, errors_between, table_cuts
from synth.aim.knowledge import ByCategory, ByReading, Requirement
from synth.aim.position_models import NormalPosition
from synth.aim.readings import ResistanceByTwoSpeeds
from synth.aim.scene import AimScene
from tests.synth.aim.conftest import HEAVY, LIGHT

ORDER = AimOrder(
    LIGHT, (1, 3), (30.0, 80.0, 150.0), Requirement(0.1, (0.5, 7.0)), NormalPosition(0.05), 20_000, 10_000, seed=1
)
KNOWLEDGES = (ByCategory(), ByReading(ResistanceByTwoSpeeds(0.03), nodes=21))


@pytest.fixture(scope="module")
def made(scene: AimScene) -> tuple[AimedSpeeds, ...]:
    return aimed_speeds(scene, ORDER, KNOWLEDGES)


def test_shapes_and_axes(made: tuple[AimedSpeeds, ...]) -> None:
    alone, measured = made
    assert alone.readings is None
    assert measured.readings is not None
    assert alone.speed_m_s.shape == alone.overspeed.shape == alone.cuts.shape == (2, 3)
    assert measured.speed_m_s.shape == measured.gap_per_car_m.shape == (2, 3, 21)


@pytest.mark.requirement("AIM-06")
def test_every_cell_keeps_the_share(made: tuple[AimedSpeeds, ...]) -> None:
    for table in made:
        told = table.cuts > 0
        assert told.sum() >= 6
        assert (table.overspeed_low95[told] < 0.11).all()
        assert np.mean((table.overspeed_low95[told] < 0.1) & (table.overspeed_high95[told] > 0.1)) > 0.75
    assert made[0].overspeed == pytest.approx(np.full((2, 3), 0.1), abs=0.011)


def test_more_knowledge_never_leaves_more_gap(made: tuple[AimedSpeeds, ...]) -> None:
    alone, measured = made
    cells = np.where(measured.cuts > 0, measured.gap_per_car_m * measured.cuts, 0.0).sum(axis=-1)
    means = cells / measured.cuts.sum(axis=-1)
    assert (means[:, 1:] < alone.gap_per_car_m[:, 1:]).all()


def test_speeds_are_whole_millimetres_and_do_not_fall_with_the_reading(made: tuple[AimedSpeeds, ...]) -> None:
    for table in made:
        speeds = table.speed_m_s[np.isfinite(table.speed_m_s)] * 1e3
        assert speeds == pytest.approx(np.round(speeds), abs=1e-6)
    steps = np.diff(made[1].speed_m_s, axis=-1)
    assert (steps[np.isfinite(steps)] >= 0.0).all()


def test_interpolation_errors_are_those_of_a_finer_table(scene: AimScene) -> None:
    cuts = table_cuts(scene, replace(ORDER, cars=(1,), checked_cuts=20_000))[0]
    above, below = errors_between(ORDER, ByCategory(), cuts, None, np.empty((3, 1)))
    fine = replace(ORDER, free_distances_m=(30.0, 55.0, 80.0, 115.0, 150.0))
    speeds = aimed_speeds(scene, replace(fine, cars=(1,)), (ByCategory(),))[0].speed_m_s[0]
    errors = 0.5 * (speeds[[0, 2]] + speeds[[2, 4]]) - speeds[[1, 3]]
    assert max(errors.max(), 0.0) == pytest.approx(above, abs=0.002)
    assert max(-errors.min(), 0.0) == pytest.approx(below, abs=0.002)


def test_same_cuts_same_table(scene: AimScene, made: tuple[AimedSpeeds, ...]) -> None:
    again = aimed_speeds(scene, ORDER, KNOWLEDGES)
    for one, other in zip(made, again, strict=True):
        assert one.speed_m_s.tobytes() == other.speed_m_s.tobytes()
        assert one.overspeed.tobytes() == other.overspeed.tobytes()


def test_a_track_too_steep_has_no_command(steep: AimScene) -> None:
    order = replace(ORDER, category=HEAVY, cars=(1,), free_distances_m=(20.0, 300.0))
    table = aimed_speeds(steep, order, (ByCategory(),))[0]
    assert np.isnan(table.speed_m_s[0, 1])
    assert np.isnan(table.overspeed[0, 1])
    assert table.cuts[0, 1] == 0


def test_cars_that_stand_beyond_the_track_are_refused(scene: AimScene) -> None:
    with pytest.raises(PlantError, match="free_distances_m holds 900"):
        aimed_speeds(scene, replace(ORDER, free_distances_m=(900.0,)), (ByCategory(),))


def test_a_share_outside_its_range_is_refused() -> None:
    with pytest.raises(PlantError, match="p_overspeed is 1"):
        replace(ORDER, requirement=Requirement(1.0, (0.5, 7.0)))
