"""The report of humped trains tells every figure with its interval, every picture and origin, and loads nothing."""

from __future__ import annotations

import re
from dataclasses import replace
from html.parser import HTMLParser

import pytest

from synth.frame.page.markup import Cell
from synth.present.plots.humping.humping_pictures import outcome_pictures
from synth.present.report.figure_table import TITLES, cells, printed
from synth.present.report.humping_report import HumpingReport, humping_page
from synth.yard.humping.outcomes import outcomes
from synth.yard.humping.train_figures import TrainFigure, train_figures
from tests.synth.yard.humping.humped_trains import humped_trains


class Tables(HTMLParser):
    """The texts of the rows of every table, by its caption; all attributes that could load something."""

    def __init__(self) -> None:
        super().__init__()
        self.rows: dict[str, list[list[str]]] = {}
        self.loads: list[str] = []
        self.caption, self.inside = "", ""

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        self.inside = tag
        if tag == "tr" and self.caption:
            self.rows[self.caption].append([])
        if tag in ("th", "td"):
            self.rows[self.caption][-1].append("")
        self.loads += [value or "" for name, value in attributes if name in ("src", "href")]

    def handle_data(self, data: str) -> None:
        if self.inside == "caption":
            self.caption = data
            self.rows[data] = []
        elif self.inside in ("th", "td"):
            self.rows[self.caption][-1][-1] += data


@pytest.fixture(scope="module")
def report() -> HumpingReport:
    humped = humped_trains()
    found = outcomes(humped.hump.routes, humped.trains, humped.memory)
    return HumpingReport(
        title="Trains <over> & under",
        created="2026-01-01T00:00:00Z",
        config_sha256="ab" * 32,
        verdict="8 trains.",
        accepted=None,
        figures=train_figures(found),
        pictures=tuple(outcome_pictures(humped.entry, humped.hump.routes, found)),
        parameters=humped.entry.provenance[:20],
        aims=(),
        tracks=tuple(route.track for route in humped.hump.routes.routes),
        player="hump.html",
        log="events.csv",
        otherwise=0,
        file_hashes={"figures.csv": "0" * 64},
    )


def read(report: HumpingReport) -> tuple[str, Tables]:
    """The page, and what is in it."""
    page, tables = humping_page(report), Tables()
    tables.feed(page)
    return page, tables


def test_every_figure_has_a_row_with_its_interval(report: HumpingReport) -> None:
    _, tables = read(report)
    head, *rows = tables.rows["Figures"]
    assert head[:4] == ["figure", "value", "95 % interval", "unit"]
    assert len(rows) == len(report.figures)
    for row, figure in zip(rows, report.figures, strict=True):
        assert row[0] == TITLES[figure.name]
        scale = 100.0 if row[3] == "%" else 1.0
        assert float(row[1]) == pytest.approx(scale * figure.value, rel=0.005)
        low, high = (float(number) for number in row[2].strip("[]").split(", "))
        assert (low, high) == pytest.approx((scale * figure.low95, scale * figure.high95), rel=0.005)
        assert int(row[4]) == figure.n


def test_a_figure_without_interval_shows_none() -> None:
    nan = float("nan")
    row = cells(TrainFigure("new_figure", "m", 1234.5, nan, nan, 1))
    assert [cell.text if isinstance(cell, Cell) else cell for cell in row] == [
        "new figure", "1234", "–", "m", "1", "trains", "–",
    ]  # fmt: skip
    assert [printed(number) for number in (0.0, nan, 0.012345, 2.7182, 99999.4)] == [
        "0",
        "–",
        "0.0123",
        "2.72",
        "99999",
    ]


def test_the_page_holds_pictures_parameters_and_files(report: HumpingReport) -> None:
    page, tables = read(report)
    assert page.count("<img ") == len(report.pictures)
    assert len(tables.rows["Parameters"]) == 21
    assert [text.strip() for text in tables.rows["Hashes of files"][1]] == ["figures.csv", "0" * 64]
    assert "Trains &lt;over&gt; &amp; under" in page
    assert "<over>" not in page


def test_the_page_loads_nothing(report: HumpingReport) -> None:
    page, tables = read(report)
    outside = [each for each in tables.loads if not each.startswith(("data:", "#"))]
    assert outside == ["hump.html", "events.csv"]
    assert re.findall(r"url\(|@import|<script", page) == []


@pytest.mark.parametrize(
    ("accepted", "style"), [(True, "verdict accepted"), (False, "verdict refused"), (None, "verdict")]
)
def test_the_box_tells_whether_limits_are_kept(report: HumpingReport, accepted: bool | None, style: str) -> None:
    page = humping_page(replace(report, accepted=accepted, player=""))
    assert f'<div class="{style}">' in page
    assert "Play a train" not in page
    assert "lay otherwise" not in page
    assert "lay otherwise than cuts went 2 times" in humping_page(replace(report, otherwise=2))
