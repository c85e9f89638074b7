"""Aim tables: thresholds, limits, the tables of them, and their verdict.

The command by a sorted list of thresholds is the one that a search over commands finds.
A roll backwards tells what a roll forwards does: the two know nothing of each other's result.
Tables of exit speeds: the share that they promise, their interpolation, and their faults of input.
The verdict on aim tables: cells that surely miss are named, chance alone is not called a miss.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy import stats

from plant_models import PlantError
from synth.aim.aim_book import CHANCE, MadeAim, aim_book, judge_aims
from synth.aim.aim_table import AimedSpeeds, AimOrder, aimed_speeds, errors_between, table_cuts
from synth.aim.configuration.aim_file import parse_aim_file
from synth.aim.knowledge import ByCategory, ByReading, Requirement, ResistanceByTwoSpeeds, thresholds_of
from synth.aim.position_models import NormalPosition, couplings
from synth.aim.resolved_aim import resolve_aim
from synth.aim.scene import AimScene
from tests.synth.aim.conftest import HEAVY, LIGHT

BOUNDS = (0.5, 6.0)
GRID = np.arange(0.5, 6.0, 0.001)


@pytest.mark.parametrize("p", [0.02, 0.1, 0.5])
def test_the_limit_is_the_highest_command_of_a_search(p: float) -> None:
    thresholds = np.random.default_rng(1).normal(2.5, 0.6, (997, 3)) + np.array([0.0, 0.4, 0.8])
    limits = thresholds_of(thresholds).limit_speeds(p, BOUNDS)
    for k, limit in enumerate(limits):
        kept = GRID[(thresholds[:, k] < GRID[:, None]).mean(axis=1) <= p]
        assert kept[-1] <= limit < kept[-1] + 0.001


def test_weighted_limits_count_each_cut_by_its_weight() -> None:
    rng = np.random.default_rng(2)
    thresholds, weights = rng.normal(2.5, 0.6, (200, 2)), rng.integers(0, 5, 200)
    repeated = np.repeat(thresholds, weights, axis=0)
    weighted = thresholds_of(thresholds).weighted_limit_speeds(weights.astype(float), 0.1, BOUNDS)
    assert weighted == pytest.approx(thresholds_of(repeated).limit_speeds(0.1, BOUNDS))


def test_overspeed_is_the_share_of_lower_thresholds() -> None:
    thresholds = np.array([[1.0, 5.0], [2.0, 6.0], [3.0, 7.0], [4.0, 8.0]])
    listed = thresholds_of(thresholds)
    assert listed.overspeed(np.array([2.5, 4.0])).tolist() == [0.5, 0.0]
    assert listed.overspeed(np.array([2.0, 9.0])).tolist() == [0.25, 1.0]  # at its own threshold no cut is too fast


def test_no_command_where_the_lowest_is_too_fast_and_never_above_the_upper_bound() -> None:
    thresholds = np.stack([np.linspace(0.0, 1.0, 100), np.linspace(8.0, 9.0, 100)], axis=1)
    limits = thresholds_of(thresholds).limit_speeds(0.1, BOUNDS)
    assert np.isnan(limits[0])
    assert limits[1] == 6.0


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


SMALL = """\
[cuts]
categories = ["S"]
cars = [1, 2]
[aim]
free_distances_m = [50.0, 150.0]
knowledge = ["category"]
[simulation]
passes = 1000
"""


@pytest.fixture(scope="module")
def judged_table() -> MadeAim:
    """A table of four cells."""
    (table,) = aim_book(resolve_aim(parse_aim_file(SMALL, "aim.toml")), "2026-01-01T00:00:00Z", print).tables
    return table


def with_hits(judged_table: MadeAim, hits: list[list[int]], cuts: list[list[int]]) -> MadeAim:
    """The table with planted over-speeds; no speed where there are no cuts."""
    n = np.array(cuts)
    shares = np.where(n > 0, np.array(hits) / np.maximum(n, 1), np.nan)
    speeds = replace(
        judged_table.speeds, overspeed=shares, overspeed_low95=shares, overspeed_high95=shares, cuts=n,
        speed_m_s=np.where(n > 0, judged_table.speeds.speed_m_s, np.nan),
    )  # fmt: skip
    return replace(judged_table, speeds=speeds)


def test_a_cell_misses_where_chance_cannot_explain_its_over_speeds(judged_table: MadeAim) -> None:
    n, limit, cells = 1000, 0.11, 4
    tail = stats.binom(n, limit)
    last = int(tail.isf(CHANCE / cells))  # P(more than this) is at most the chance
    assert tail.sf(last - 1) > CHANCE / cells >= tail.sf(last)
    kept = judge_aims([with_hits(judged_table, [[100, last], [90, 100]], [[n, n], [n, n]])], 0.01)
    assert kept.accepted
    missed = judge_aims([with_hits(judged_table, [[100, last + 1], [90, 100]], [[n, n], [n, n]])], 0.01)
    assert not missed.accepted
    (table,) = missed.tables
    assert table.missed == (f"1 car at 150 m: {(last + 1) / 10:.1f} % of 1000",)
    assert table.missed[0] in missed.sentence
    assert judged_table.table.id in missed.sentence
    for verdict in (kept, missed):  # the worst cell is told as it is judged, as one of many
        worst = verdict.tables[0].worst
        assert worst is not None
        assert worst.value * n == (last if verdict.accepted else last + 1)
        assert (worst.low95 > 0.11) == (not verdict.accepted)


def test_cells_without_speed_do_not_count_but_are_told(judged_table: MadeAim) -> None:
    verdict = judge_aims([with_hits(judged_table, [[0, 100], [90, 0]], [[0, 1000], [1000, 0]])], 0.01)
    assert verdict.accepted
    assert (verdict.tables[0].told, verdict.tables[0].without, verdict.tables[0].cells) == (2, 2, 4)
    assert "no exit speed keeps it, for the track falls more" in verdict.sentence
    nothing = judge_aims([with_hits(judged_table, [[0, 0], [0, 0]], [[0, 0], [0, 0]])], 0.01)
    assert not nothing.accepted
    assert nothing.sentence.startswith("no exit speed keeps the required probability anywhere")


def test_tables_that_keep_their_limit_are_rarely_called_missing(judged_table: MadeAim) -> None:
    """Of 2000 tables whose cells are all exactly at the limit, at most about CHANCE are refused."""
    rng = np.random.default_rng(3)
    hits = rng.binomial(400, 0.11, (2000, 2, 2))
    refused = sum(
        not judge_aims([with_hits(judged_table, each.tolist(), [[400, 400], [400, 400]])], 0.01).accepted
        for each in hits
    )
    assert 0 < refused <= 2000 * CHANCE + 3.0 * np.sqrt(2000 * CHANCE)


def test_the_figures_of_all_cuts_are_those_of_the_cells_where_only_the_category_is_known(judged_table: MadeAim) -> None:
    speeds = judged_table.speeds
    np.testing.assert_array_equal(speeds.of_all.overspeed, speeds.overspeed)
    np.testing.assert_array_equal(speeds.of_all.overspeed_low95, speeds.overspeed_low95)
    np.testing.assert_allclose(speeds.of_all.gap_m, speeds.gap_per_car_m * np.array([[1], [2]]))
    assert (speeds.of_all.without == 0.0).all()
