"""The verdict on aim tables: cells that surely miss are named, chance alone is not called a miss."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy import stats

from synth.aim.aim_acceptance import CHANCE, judge_aims
from synth.aim.aim_book import MadeAim, aim_book
from synth.aim.configuration.aim_file import parse_aim_file
from synth.aim.resolved_aim import resolve_aim

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
def made() -> MadeAim:
    """A table of four cells."""
    (table,) = aim_book(resolve_aim(parse_aim_file(SMALL, "aim.toml")), "2026-01-01T00:00:00Z", print).tables
    return table


def with_hits(made: MadeAim, hits: list[list[int]], cuts: list[list[int]]) -> MadeAim:
    """The table with planted over-speeds; no speed where there are no cuts."""
    n = np.array(cuts)
    shares = np.where(n > 0, np.array(hits) / np.maximum(n, 1), np.nan)
    speeds = replace(
        made.speeds, overspeed=shares, overspeed_low95=shares, overspeed_high95=shares, cuts=n,
        speed_m_s=np.where(n > 0, made.speeds.speed_m_s, np.nan),
    )  # fmt: skip
    return replace(made, speeds=speeds)


def test_a_cell_misses_where_chance_cannot_explain_its_over_speeds(made: MadeAim) -> None:
    n, limit, cells = 1000, 0.11, 4
    tail = stats.binom(n, limit)
    last = int(tail.isf(CHANCE / cells))  # P(more than this) is at most the chance
    assert tail.sf(last - 1) > CHANCE / cells >= tail.sf(last)
    kept = judge_aims([with_hits(made, [[100, last], [90, 100]], [[n, n], [n, n]])], 0.01)
    assert kept.accepted
    missed = judge_aims([with_hits(made, [[100, last + 1], [90, 100]], [[n, n], [n, n]])], 0.01)
    assert not missed.accepted
    (table,) = missed.tables
    assert table.missed == (f"1 car at 150 m: {(last + 1) / 10:.1f} % of 1000",)
    assert table.missed[0] in missed.sentence
    assert made.table.id in missed.sentence
    for verdict in (kept, missed):  # the worst cell is told as it is judged, as one of many
        worst = verdict.tables[0].worst
        assert worst is not None
        assert worst.value * n == (last if verdict.accepted else last + 1)
        assert (worst.low95 > 0.11) == (not verdict.accepted)


def test_cells_without_speed_do_not_count_but_are_told(made: MadeAim) -> None:
    verdict = judge_aims([with_hits(made, [[0, 100], [90, 0]], [[0, 1000], [1000, 0]])], 0.01)
    assert verdict.accepted
    assert (verdict.tables[0].told, verdict.tables[0].without, verdict.tables[0].cells) == (2, 2, 4)
    assert "no exit speed keeps it, for the track falls more" in verdict.sentence
    nothing = judge_aims([with_hits(made, [[0, 0], [0, 0]], [[0, 0], [0, 0]])], 0.01)
    assert not nothing.accepted
    assert nothing.sentence.startswith("no exit speed keeps the required probability anywhere")


def test_tables_that_keep_their_limit_are_rarely_called_missing(made: MadeAim) -> None:
    """Of 2000 tables whose cells are all exactly at the limit, at most about CHANCE are refused."""
    rng = np.random.default_rng(3)
    hits = rng.binomial(400, 0.11, (2000, 2, 2))
    refused = sum(
        not judge_aims([with_hits(made, each.tolist(), [[400, 400], [400, 400]])], 0.01).accepted for each in hits
    )
    assert 0 < refused <= 2000 * CHANCE + 3.0 * np.sqrt(2000 * CHANCE)


def test_the_figures_of_all_cuts_are_those_of_the_cells_where_only_the_category_is_known(made: MadeAim) -> None:
    speeds = made.speeds
    np.testing.assert_array_equal(speeds.of_all.overspeed, speeds.overspeed)
    np.testing.assert_array_equal(speeds.of_all.overspeed_low95, speeds.overspeed_low95)
    np.testing.assert_allclose(speeds.of_all.gap_m, speeds.gap_per_car_m * np.array([[1], [2]]))
    assert (speeds.of_all.without == 0.0).all()
