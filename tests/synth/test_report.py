"""The report: one balanced HTML page that loads nothing, says what is assumed, and escapes what it is given."""

from __future__ import annotations

import re
import subprocess
import sys
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path

import pytest

from plant_models.library import SourcedValue
from synth.book.comparison.limit_cycle import hunting_report
from synth.book.failed_case import FailedCase
from synth.book.off_nominal.condition import CONDITIONS
from synth.book.permissions.permission import Permission
from synth.frame.page.markup import VOID, Markup, element
from synth.frame.picture.picture import Drawing, Picture
from synth.frame.printed_numbers import counted, percent, quotient, span
from synth.present.report import BookReport, report_page
from synth.present.report.checks_section import checks_section
from synth.present.report.verdict import verdict
from tests.synth.case_factory import make_case, make_permissions
from tuning_tables import Estimator

ESTIMATOR = Estimator(0.05, 0.15, 0.006, 0.1, 2.0, 7, 20, 0.2, 0.5, 50.0, (0.0, 37.45), (0.0, 2.4), (0.0, 0.1))

ROOT = Path(__file__).parents[2]
SVG = b'<svg xmlns="http://www.w3.org/2000/svg" width="10" height="10"></svg>'


class Page(HTMLParser):
    """Reads a page: whether the tags balance, what it would load, its text and identifiers."""

    def __init__(self, html: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.loaded: list[str] = []
        self.identifiers: list[str] = []
        self.targets: list[str] = []
        self.without_alt = 0
        self.words: list[str] = []
        self.tags: set[str] = set()
        self.feed(html)
        self.close()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = dict(attrs)
        self.tags.add(tag)
        if tag not in VOID:
            self.open.append(tag)
        if tag == "a":
            self.targets.append(given.get("href") or "")
        else:
            self.loaded += [given[name] or "" for name in ("src", "href", "srcset", "data") if name in given]
        if tag == "img" and not given.get("alt"):
            self.without_alt += 1
        if identifier := given.get("id"):
            self.identifiers.append(identifier)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        self.words.append(data)

    @property
    def text(self) -> str:
        return "".join(self.words)


@pytest.fixture(scope="module")
def book() -> BookReport:
    """Three cases, one of them infeasible; one parameter assumed, one out of its range."""
    return BookReport(
        title="Две позиции <КНП-5>",
        tool_version="0.1.0",
        config_sha256="cd" * 32,
        created="2026-11-20T22:46:00Z",
        cases=(
            make_case("gondola-22t", 2.0, stages=3),
            make_case("gondola-85t", 2.0, stages=5, feasible=False),
            make_case("gondola-85t", 4.0, stages=5, spread=0.09),
        ),
        failed=(FailedCase("gondola-85t", 1.5, "the grid is too coarse"),),
        parameters=(
            SourcedValue("friction.common_cv", 0.15, "1", (0.1, 0.25), "engineering judgement: usual", "L"),
            SourcedValue(
                "retarder.zones_m", ((0.0, 12.475), (14.475, 26.95)), "m", (0.0, 40.0), "<7> & [hump-norm]", "H"
            ),
            SourcedValue("entry.high_m_s", 9.0, "m/s", (4.5, 7.0), "configuration", ""),
        ),
        accepted=False,
        verdict="1 of 2 feasible cases exceeds its limit",
        acceptance_rms_m_s=0.1,
        permissions_line="",
        file_hashes={"tables/a&b.json": "ef" * 32},
        pictures=(
            Picture("one", "Accuracy", "Title one", 'Caption "one" <b>', Drawing(b"png", SVG)),
            Picture("two", "Passes", "Title two", "Caption two", Drawing(b"png", SVG)),
            Picture("three", "Accuracy", "Title three", "Caption three", Drawing(b"png", SVG)),
        ),
    )


@pytest.fixture(scope="module")
def page(book: BookReport) -> Page:
    """The page, read."""
    return Page(report_page(book))


def test_the_page_is_balanced_and_loads_nothing(page: Page) -> None:
    assert page.open == []
    assert page.loaded
    assert all(address.startswith("data:image/svg+xml;base64,") for address in page.loaded)
    assert page.tags.isdisjoint({"script", "link", "iframe", "object", "b"})
    assert page.without_alt == 0


def test_the_style_loads_nothing(book: BookReport) -> None:
    style = re.search(r"<style>(.*?)</style>", report_page(book), re.DOTALL)
    assert style is not None
    assert not re.search(r"url\(|@import|http", style[1])


def test_links_lead_to_sections_of_the_page(page: Page) -> None:
    assert len(set(page.identifiers)) == len(page.identifiers)
    assert {target.removeprefix("#") for target in page.targets} <= set(page.identifiers)
    assert page.targets


def test_cited_sources_are_told_in_full_and_a_point_is_called_fixed(page: Page, book: BookReport) -> None:
    text = page.text
    place = text.index("[hump-norm] Railway administration of the USSR")
    assert text.index("<7> & [hump-norm]") < place < text.index("Limits of use", place)
    assert "geum.ru" in text
    assert "[hump-grades] " not in text
    fixed = SourcedValue("cut 'a'.length_m", 13.92, "m", (13.92, 13.92), "engineering judgement", "H")
    assert "13.92 to 13.92" not in (said := Page(report_page(replace(book, parameters=(fixed,)))).text)
    assert "fixed" in said
    assert "Sources" not in said


def test_the_verdict_comes_first_and_names_the_infeasible_case(page: Page, book: BookReport) -> None:
    text = page.text
    assert text.index("Not accepted") < text.index("Results")
    assert "gondola-85t, target 2 m/s: out of brake power" in text
    assert "at entry speeds of 5 to 6.5 m/s; no entry speed can be served" in text
    assert "Worst of the 2 feasible cases: gondola-85t, target 4 m/s" in text
    assert all(case.label in text for case in book.cases)


def test_assumed_and_exceeded_parameters_are_marked(page: Page, book: BookReport) -> None:
    html = report_page(book)
    rows = re.findall(r"<tr[^>]*>.*?</tr>", html)
    assumed = [row for row in rows if ">assumed</td>" in row]
    assert len(assumed) == 1
    assert "friction.common_cv" in assumed[0]
    assert "3 parameters, 1 of them assumed" in page.text
    assert "(0, 12.475), (14.475, 26.95)" in page.text
    assert "4.5 to 7: exceeded" in page.text


def test_where_a_prediction_comes_from_is_told(book: BookReport) -> None:
    """One table with an estimator, two without: a sentence for each kind."""
    with_it = replace(
        book.cases[0].table,
        estimator=ESTIMATOR,
        predicted=replace(book.cases[0].table.predicted, passes=10_000),
    )
    mixed = replace(book, cases=(replace(book.cases[0], table=with_it), *book.cases[1:]))
    text = Page(report_page(mixed)).text
    assert "With an estimator the prediction is itself simulated" in text
    assert "two independent computations of one quantity. Predicted / simulated rms is" in text
    assert "prediction is itself simulated" not in Page(report_page(book)).text


def test_doubts_of_a_case_are_told(page: Page, book: BookReport) -> None:
    assert f"{len(book.cases)} of {len(book.cases)} polishes converged" in page.text
    assert "Warning for" not in page.text
    case = book.cases[0]
    doubtful = replace(
        case,
        polish=replace(case.polish, converged=False, status="Iteration limit reached"),
        predicted=replace(case.predicted, escaped=2e-4),
    )
    told = Page(report_page(replace(book, cases=(doubtful, *book.cases[1:])))).text
    assert "the polish ended before it converged (Iteration limit reached)" in told
    assert "a probability of 2.0e-04 left the top of the speed grid" in told


def test_off_nominal_figures_stand_behind_a_fold(page: Page, book: BookReport) -> None:
    html = report_page(book)
    (fold,) = re.findall(r"<details>(.*?)</details>", html, re.DOTALL)
    assert fold.startswith("<summary>Off nominal: the same tables on other plants (4000 passes each)</summary>")
    rows = re.findall(r"<tr[^>]*>.*?</tr>", fold)
    assert len(rows) == 1 + len(book.cases)
    for condition in CONDITIONS:
        assert f'<th scope="col">{condition.name}</th>' in rows[0]
    found = book.cases[2].off_nominal[0].outcome
    assert found is not None
    assert "0.1080 [0.1026, 0.1134] × 1.20 [1.14, 1.26]; too fast 1.2 %, stopped 0 %" in rows[3]
    assert 'title="friction × 0.7; too fast [1, 1.5] %, stopped [0, 0.1] %"' in rows[3]
    assert 'title="cut: mass_t is too much">–</td>' in rows[3]
    without = replace(book, cases=tuple(replace(case, off_nominal=()) for case in book.cases))
    assert "<details>" not in report_page(without)
    assert "Off nominal" in page.text


def test_pictures_of_a_section_stand_together(page: Page) -> None:
    captions = [page.text.index(word) for word in ('Caption "one" <b>', "Caption three", "Caption two")]
    assert captions == sorted(captions)


def test_what_is_given_is_escaped(book: BookReport) -> None:
    evil = "<script>alert('x')</script>"
    html = report_page(replace(book, title=evil, verdict=evil, tool_version=evil, file_hashes={evil: evil}))
    assert "<script" not in html
    assert html.count("&lt;script&gt;") == 6
    assert Page(html).open == []


def test_the_same_book_gives_the_same_bytes(book: BookReport) -> None:
    assert report_page(book) == report_page(book)


def test_a_book_without_feasible_case_and_one_without_infeasible(book: BookReport) -> None:
    only = replace(book, cases=book.cases[1:2], pictures=())
    assert "Worst of" not in Page(report_page(only)).text
    assert "Every case with a table is feasible." in verdict(replace(book, cases=book.cases[:1]))
    assert "Every case is feasible." in verdict(replace(book, cases=book.cases[:1], failed=()))


def test_a_case_without_a_table_has_a_row(page: Page) -> None:
    assert "gondola-85t–1.5no table: see the verdict–" in page.text


def test_the_report_is_written_without_matplotlib() -> None:
    command = "import synth.present.report, sys; raise SystemExit('matplotlib' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", command], cwd=ROOT, timeout=60, check=False).returncode == 0


def test_permissions_are_told_in_a_column_and_a_section(book: BookReport) -> None:
    cases = tuple(
        replace(case, permissions=make_permissions(case, Permission.ANY_TIME, Permission.ESTIMATOR))
        for case in book.cases
    )
    page = Page(report_page(replace(book, cases=cases, permissions_line="The line.")))
    assert page.open == []
    assert "rms × if permitted" in page.text
    assert "any\u00a0time, estimator" in page.text
    assert "The line." in page.text
    assert {"#permissions"} <= set(page.targets)
    assert "permissions" not in Page(report_page(book)).identifiers


def test_markup() -> None:
    assert element("p", "a<b", Markup("<br>"), class_='x"y') == '<p class="x&quot;y">a&lt;b<br></p>'
    assert element("img", alt="", src="s") == '<img src="s">'


def test_figures() -> None:
    assert [percent(share) for share in (0.0, 0.00012, 0.05, 0.25)] == ["0", "0.012", "5", "25.0"]
    assert quotient(float("nan")) == "–"
    assert [span(values) for values in ([1.0, 2.0], [1.0, 1.001])] == ["from 1.00 to 2.00", "1.00"]
    assert [counted(n, "case") for n in (1, 3)] == ["1 case", "3 cases"]


def test_the_page_tells_limit_cycles_and_escaped_probability(book: BookReport) -> None:
    case = make_case()
    leaky = replace(case, predicted=replace(case.predicted, escaped=2.5e-3))
    section = str(checks_section(replace(book, cases=(leaky,))))
    assert "at most 2.5e-03" in section
    assert "does not hunt" in section
    assert ("Predicted limit cycles" in section) == bool(hunting_report(case.plant, case.study.table_lines))
