"""Figures of trains: computed, shown, and told first.

Intervals of figures: how often they cover the truth where cuts of a train are alike, and exact special cases.
What is shown of humped trains tells every figure with its interval, and every count where there is one.
What is told of trains first: the verdict with its reasons, tiles, what brakes cannot do, where it is tight.
"""

from __future__ import annotations

from dataclasses import asdict

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy import stats

from synth.frame.exhibits import Column, Row, Sentence, Table, Tiles
from synth.frame.interval import Interval
from synth.frame.told import plain
from synth.hump.configuration.sections import CouplingLimits
from synth.hump.configuration.trial_file import parse_trial_file
from synth.hump.control.cut_record import CutRecord
from synth.hump.rolling.hump_routes import HumpRoutes, Mark
from synth.hump.rolling.outcomes import TrainOutcomes, outcomes
from synth.hump.rolling.train_cuts import TrainCuts
from synth.hump.rolling.train_memory import TrainMemory
from synth.hump.trains.humped_trial import HumpedTrial, trial_limits
from synth.hump.trains.shown.figures import MEANS, SHARES, element_rows, mean_row, share_row, titles_of
from synth.hump.trains.shown.first_screen import first_screen, one_in
from synth.hump.trains.shown.positions import positions
from synth.hump.trains.traced_train import chosen_trains
from synth.hump.trains.train_figures import TrainFigure, interval_of, ratio, share, strengths, train_figures, weak
from synth.hump.trial.made_trial import made_trial
from synth.hump.trial.resolved_trial import resolve_trial
from synth.hump.trial.trial_parameters import list_warnings
from tests.synth.hump.trains.humped_trains import humped_trains
from tests.synth.hump.trains.made_trials import Day

Floats = NDArray[np.float64]
CUTS, SETS = 40, 400


def hits(p: float, correlation: float, trains: int) -> Floats:
    """Hits of each train (sets, trains): binomial, or beta-binomial with this correlation of two cuts of a train."""
    random, shape = np.random.default_rng(1), (SETS, trains)
    if correlation == 0.0:
        return random.binomial(CUTS, p, shape).astype(float)
    wide = (1.0 - correlation) / correlation
    return random.binomial(CUTS, random.beta(p * wide, (1.0 - p) * wide, shape)).astype(float)


@pytest.mark.parametrize(
    ("p", "trains", "correlation", "least"),
    [
        (0.001, 20, 0.0, 0.97),
        (0.001, 100, 0.0, 0.93),
        (0.001, 1000, 0.0, 0.94),
        (0.01, 20, 0.0, 0.94),
        (0.1, 20, 0.0, 0.94),
        (0.1, 20, 0.1, 0.92),
        (0.1, 100, 0.1, 0.92),
        (0.01, 1000, 0.1, 0.92),
        (0.01, 100, 0.1, 0.90),
        (0.01, 20, 0.1, 0.77),  # 8 hits in 3 trains or so
        (0.001, 100, 0.1, 0.73),
    ],
)
def test_shares_are_covered_as_told(p: float, trains: int, correlation: float, least: float) -> None:
    base = np.full(trains, float(CUTS))
    found = np.array([share(each, base)[1:3] for each in hits(p, correlation, trains)])
    covered = ((found[:, 0] <= p) & (p <= found[:, 1])).mean()
    assert least < covered
    if correlation > 0.0 and p * trains < 0.5:
        assert covered < 0.9, "better than told: tell it"


@pytest.mark.parametrize(("p", "trains", "correlation"), [(0.1, 20, 0.0), (0.1, 100, 0.1), (0.01, 1000, 0.1)])
def test_ratios_are_covered_as_told(p: float, trains: int, correlation: float) -> None:
    base = np.full(trains, float(CUTS))
    found = np.array([ratio(each, base)[1:] for each in hits(p, correlation, trains)])
    covered = ((found[:, 0] <= p) & (p <= found[:, 1])).mean()
    assert 0.91 < covered < 0.98


def test_without_any_hit_the_interval_is_that_of_independent_cuts() -> None:
    """Clopper and Pearson, but for Student's quantile: 1 − 0.025^(1/n) of n cuts worth (t999/t49)² of 2000."""
    found = share(np.zeros(50), np.full(50, 40.0))
    worth = 2000 * (stats.t.ppf(0.975, 1999) / stats.t.ppf(0.975, 49)) ** 2
    assert found[:2] == (0.0, 0.0)
    assert found[2] == pytest.approx(1.0 - 0.025 ** (1.0 / worth), rel=1e-9)


@pytest.mark.parametrize("mirrored", [False, True])
@pytest.mark.parametrize(
    ("hits", "ends"), [((3.0, 4.0), (0.0, 0.8868)), ((6.0, 26.0), (0.0, 1.0)), ((20.0, 20.0), (0.0118, 0.9882))]
)
def test_two_trains_tell_no_end_that_is_next_to_nothing(
    hits: tuple[float, float], ends: tuple[float, float], mirrored: bool
) -> None:
    """The exact ends are 1.3e-10 of all cuts, 2.9e-43 and 1 less nothing; those of 20 hits a train are told."""
    base, few = np.full(2, 40.0), np.array(hits)
    found = share(base - few if mirrored else few, base)[1:3]
    assert found == pytest.approx((1.0 - ends[1], 1.0 - ends[0]) if mirrored else ends, abs=1e-4)
    for told, expected in zip(found, (0.0, 1.0), strict=True):
        assert told == expected or abs(told - expected) > 1e-3
    one = np.eye(1, 20)[0]
    assert 0.0 < share(one, np.full(20, 40.0))[1] < 1e-4, "a single hit of many trains tells that there are some"


def test_trains_of_unequal_cuts_weigh_by_them() -> None:
    value, low, high = ratio(np.array([1.0, 6.0, 2.0]), np.array([10.0, 40.0, 10.0]))
    assert value == pytest.approx(0.15)
    residual = (np.array([1.0, 6.0, 2.0]) - 0.15 * np.array([10.0, 40.0, 10.0])) / 20.0
    half = stats.t.ppf(0.975, 2) * residual.std(ddof=1) / np.sqrt(3)
    assert [low, high] == pytest.approx([0.15 - half, 0.15 + half])


def test_nothing_is_told_of_nothing_and_no_interval_of_one_train() -> None:
    assert np.isnan(share(np.zeros(3), np.zeros(3))).all()
    assert np.isnan(ratio(np.zeros(3), np.zeros(3))).all()
    assert ratio(np.array([3.0]), np.array([4.0]))[0] == 0.75
    assert np.isnan(ratio(np.array([3.0]), np.array([4.0]))[1:]).all()


def test_figures_are_those_of_the_counts() -> None:
    found = Day(cuts=10, steps_m_s=(3.0, 3.4)).on().batch(0, 40)
    told = {figure.name: figure for figure in train_figures(found, 0.01)}
    assert told["hump_speed"].value == pytest.approx(found.span_m.sum() / found.span_s.sum())
    assert told["cars_per_hour"].value == pytest.approx(3600.0 * found.span_cars.sum() / found.span_s.sum())
    assert told["catch_ups"].value == found.caught.sum() / 400 > 0.0
    assert told["catch_ups"].n == 400
    assert told["overspeed"].n == found.judged.sum()
    classes = sum(told[f"overspeed_{name}"].value for name in ("slight", "rough", "harmful"))
    assert told["overspeed"].value == pytest.approx(classes)
    assert told["gap_per_cut"].value == pytest.approx(found.gap_m.sum() / found.judged.sum())
    p, effect = told["catch_ups"].value, share(found.caught.astype(float), found.cuts.astype(float))[3]
    assert told["catch_ups"].enough_n == pytest.approx(1.959964**2 * p * (1.0 - p) / 0.01**2 * effect)
    for figure in told.values():
        assert figure.low95 <= figure.value <= figure.high95


@pytest.fixture(scope="module")
def found() -> TrainOutcomes:
    humped = humped_trains()
    return outcomes(humped.hump.routes, humped.trains, humped.memory)


def numbers_in(columns: tuple[Column, ...], key: str, row: Row) -> list[float]:
    """The numbers that people read in the cell `key` of a row."""
    (column,) = (each for each in columns if each.key == key)
    return [float(word.strip("[],").replace(",", "")) for word in column.text(row).split()]


def test_every_figure_has_a_row_with_its_interval(found: TrainOutcomes) -> None:
    figures, titles = train_figures(found), titles_of(CouplingLimits())
    assert {figure.is_share for figure in figures} == {True, False}
    for figure in figures:
        columns, key, scale = (SHARES, "share", 100.0) if figure.is_share else (MEANS, "mean", 1.0)
        row = share_row(figure, titles) if figure.is_share else mean_row(figure, titles)
        assert (row["title"], row["name"], row["n"]) == (titles[figure.name], figure.name, figure.n)
        wanted = [scale * each for each in (figure.value, figure.low95, figure.high95)]
        assert numbers_in(columns, key, row) == pytest.approx(wanted, rel=0.006)
        assert plain(row[key]) == asdict(Interval(figure.value, figure.low95, figure.high95, figure.n))


def test_a_figure_without_interval_shows_none() -> None:
    """One train has no interval, and no cuts have no share: neither is taken for a sure 0."""
    nan = float("nan")
    row = mean_row(TrainFigure("gap_per_cut", "m", 1234.5, nan, nan, 1), titles_of(CouplingLimits()))
    assert (row["title"], numbers_in(MEANS, "mean", row), row["unit"]) == ("gap a cut", [1234.0], "m")
    assert plain(row["mean"]) == 1234.5
    assert plain(interval_of(nan, nan, nan, 0)) is None


def test_elements_have_the_counts_of_all_trains(found: TrainOutcomes) -> None:
    routes = humped_trains().hump.routes
    rows = element_rows(routes, found)
    for key in ("misrouted", "contact", "unseparated", "foul"):
        assert sum(row[key] for row in rows) == getattr(found, key).sum()
    counts = found.misrouted.sum(axis=0)
    worst = int(np.argmax(counts))
    assert next(row for row in rows if row["number"] == routes.numbers[worst])["misrouted"] == counts[worst] > 0
    assert 0 < len(rows) < len(routes.numbers)


TRAINS = 20
FULL = 'hump = "dumper"\n[trains]\ncuts = 12\nmost_cars = 1\ncategory_shares = { T = 1 }\n[aim]\ndesign_cuts = 200\n'


def humped(text: str) -> tuple[HumpedTrial, TrainCuts, TrainMemory]:
    """What trains come to, and all that happened to them."""
    config = resolve_trial(parse_trial_file(text, "trial.toml"))
    trial = made_trial(config, 1)
    trains, _, memory = trial.humped(0, TRAINS)
    able = trial.able(trains, memory.route.ravel())
    return HumpedTrial(config, trial, outcomes(trial.routes, trains, memory, able)), trains, memory


@pytest.fixture(scope="module")
def full() -> tuple[HumpedTrial, TrainCuts, TrainMemory]:
    """Full cars behind brakes that are for empty ones."""
    return humped(FULL)


def test_a_brake_that_is_too_weak_is_told_everywhere(full: tuple[HumpedTrial, TrainCuts, TrainMemory]) -> None:
    result, _, memory = full
    (brake,) = strengths(result.found)
    far = memory.exit_m_s - memory.command_m_s > 6.0 * 0.15  # no error of the regulator is so large
    assert weak(brake)
    assert np.nansum(far) <= result.found.short.sum() <= (memory.exit_m_s > memory.command_m_s).sum()
    assert np.nansum(far) > 0.5 * brake.n
    limits = {limit.sentence.partition(":")[0]: limit for limit in trial_limits(result)}
    assert limits["couplings above 1.39 m/s"].kept is False
    assert "position 1 let" in limits["couplings above 1.39 m/s"].sentence
    table, warning, *_ = positions(result)
    assert isinstance(table, Table)
    assert isinstance(warning, Sentence)
    assert table.bad(table.rows[0])
    assert warning.brief
    assert "the hump is for cars of the weight category L, and trains have Т (T)" in " ".join(result.config.warnings)


def test_where_nothing_aims_the_verdict_says_so() -> None:
    result, _, _ = humped(f'{FULL}[[position]]\nnumber = 1\nrole = "spacing"\n')
    limits = [limit for limit in trial_limits(result) if limit.kept is False]
    assert any("on tracks 1 to 8 no position aims at the standing cars" in limit.sentence for limit in limits)
    judged = humped(f"{FULL}[acceptance]\ncatch_ups = 1\noverspeed = 1\n")[0]
    assert not list(trial_limits(judged))


def closest(routes: HumpRoutes, memory: TrainMemory, train: int) -> float:
    """The least interval of a train, cut by cut and element by element."""
    least = np.inf
    for cut in range(1, memory.route.shape[1]):
        ahead, own = memory.route[train, cut - 1], memory.route[train, cut]
        for column in range(routes.elements):
            if routes.vertex[own, column] < 0 or routes.vertex[own, column] != routes.vertex[ahead, column]:
                break
            if column >= min(memory.contact_at[train, cut - 1], memory.contact_at[train, cut]):
                break
            comes = memory.time_s[train, cut, column, Mark.FIRST_IN]
            leaves = memory.time_s[train, cut - 1, column, Mark.LAST_OUT]
            throw = routes.throw_s[own, column] if routes.points[own, column] != routes.points[ahead, column] else 0.0
            if np.isfinite(comes) and np.isfinite(leaves):
                least = min(least, comes - leaves - throw)
    return float(least)


def test_the_closest_cuts_are_those_of_a_plain_search(full: tuple[HumpedTrial, TrainCuts, TrainMemory]) -> None:
    result, trains, memory = full
    routes = result.config.routes
    plain = [closest(routes, memory, train) for train in range(TRAINS)]
    assert np.isfinite(plain).all()
    np.testing.assert_allclose(result.found.tightest_s, plain)
    assert (result.found.tightest_at >= 0).all()
    assert set(result.found.tightest_ahead) == set(trains.category)


def test_tiles_promise_no_more_than_the_figures(full: tuple[HumpedTrial, TrainCuts, TrainMemory]) -> None:
    for told in np.random.default_rng(1).uniform(1e-6, 1.0, 300) ** 2:
        assert float(one_in(told).replace(",", "")) <= 1.0 / told * (1.0 + 1e-12)
    result, _, _ = full
    tiles, *_, exits = first_screen(result)
    assert isinstance(tiles, Tiles)
    assert isinstance(exits, Table)
    caught = result.found.caught.sum() / result.found.cuts.sum()
    assert tiles.tiles[1].figure == f"one cut in {one_in(caught)}"
    over = result.found.overspeed.sum() / result.found.judged.sum()  # of cuts, whether they coupled or left a gap
    assert tiles.tiles[2].figure == f"{100.0 * over:.3g} %"
    assert tiles.tiles[2].of.startswith("of the cuts couple faster than 1.39 m/s")
    (row,) = exits.rows
    assert row["L_m_s"] is None
    assert row["T_m_s"].value == pytest.approx(result.found.commands_m_s.sum() / result.found.passes.sum())


def test_the_worst_train_is_shown_first_and_none_twice(full: tuple[HumpedTrial, TrainCuts, TrainMemory]) -> None:
    found: TrainOutcomes = full[0].found
    worst, *others = (each.number for each in chosen_trains(found))
    assert found.caught[worst] == found.caught.max()
    assert 0 in (worst, *others)
    assert len({worst, *others}) == 1 + len(others) <= 3


def test_a_category_that_contradicts_the_mass_is_told(full: tuple[HumpedTrial, TrainCuts, TrainMemory]) -> None:
    categories = full[0].config.categories
    for mass_t, told in ((85.0, 1), (23.0, 0)):
        cuts = [CutRecord(1, 1, 4, mass_t, categories.named("L").number, 3, 13.92)]
        assert len(list(list_warnings(cuts, categories))) == told
