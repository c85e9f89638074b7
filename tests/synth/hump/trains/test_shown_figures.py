"""What is shown of humped trains tells every figure with its interval, and every count where there is one."""

from __future__ import annotations

from dataclasses import asdict

import numpy as np
import pytest

from synth.frame.exhibits import Column, Row
from synth.frame.interval import Interval
from synth.frame.summary import plain
from synth.hump.configuration.coupling_limits import CouplingLimits
from synth.hump.trains.outcomes import TrainOutcomes, outcomes
from synth.hump.trains.shown.figures import MEANS, SHARES, mean_row, share_row, titles_of
from synth.hump.trains.shown.places import element_rows
from synth.hump.trains.train_figures import TrainFigure, interval_of, train_figures
from tests.synth.hump.trains.humped_trains import humped_trains


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
