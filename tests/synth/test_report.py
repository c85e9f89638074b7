"""The report: one balanced HTML page that loads nothing, says what is assumed, and escapes what it is given."""

from __future__ import annotations

import re
import subprocess
import sys
from collections.abc import Mapping
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path

import pytest

from plant_models.library import SourcedValue
from synth.frame.command import Verdict
from synth.frame.exhibits import Chart, Sentence, Table, exhibits_of
from synth.frame.page.markup import VOID
from synth.frame.page.told_page import page_of
from synth.frame.picture.picture import Picture
from synth.frame.told import Told
from synth.retarder.acceptance import FoundBook, judged
from synth.retarder.case_result import CaseResult
from synth.retarder.comparison.limit_cycle import hunting_report
from synth.retarder.configuration.config_file import parse_config
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.retarder.configured import head_of
from synth.retarder.failed_case import FailedCase
from synth.retarder.off_nominal_trials import CONDITIONS
from synth.retarder.shown.checks import checks
from synth.retarder.tune import Book
from synth.retarder.tune_command import COMMAND
from tests.frame.test_page_parts import SVG
from tests.synth.case_factory import make_case
from tuning_tables import Estimator

ESTIMATOR = Estimator(0.05, 0.15, 0.006, 0.1, 2.0, 7, 20, 0.2, 0.5, 50.0, (0.0, 37.45), (0.0, 2.4), (0.0, 0.1))

ROOT = Path(__file__).parents[2]


class Page(HTMLParser):
    """Reads a page: whether the tags balance, what it would load, its text and identifiers."""

    def __init__(self, html: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.loaded: list[str] = []
        self.identifiers: list[str] = []
        self.targets: list[str] = []
        self.drawings = self.named_drawings = 0
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
        if tag == "svg":
            self.drawings += 1
            self.named_drawings += bool(given.get("role") == "img" and given.get("aria-label"))
        if identifier := given.get("id"):
            self.identifiers.append(identifier)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        self.words.append(data)

    @property
    def text(self) -> str:
        return "".join(self.words)


CONFIG = replace(
    parse_config("", "the built-in one"),
    title="Две позиции <КНП-5>",
    parameters=(
        SourcedValue("friction.common_cv", 0.15, "1", (0.1, 0.25), "engineering judgement: usual", "L"),
        SourcedValue("retarder.zones_m", ((0.0, 12.475), (14.475, 26.95)), "m", (0.0, 40.0), "<7> & [hump-norm]", "H"),
        SourcedValue("entry.high_m_s", 9.0, "m/s", (4.5, 7.0), "configuration", ""),
    ),
)
CASES = (
    make_case("gondola-22t", 2.0, stages=3),
    make_case("gondola-85t", 2.0, stages=5, feasible=False),
    make_case("gondola-85t", 4.0, stages=5, spread=0.15),
)
FAILED = FailedCase("gondola-85t", 1.5, "the grid is too coarse")
HASHES = {"tables/a&b.json": "ef" * 32}


def found_book(cases: tuple[CaseResult, ...] = CASES, config: ResolvedConfig = CONFIG) -> FoundBook[CaseResult]:
    """These cases as a tune has them, and one without a table."""
    book = Book(config, "2026-11-20T22:46:00Z", cases, (FAILED,))
    return FoundBook(book, judged(cases, config.acceptance), ())


def told_of(found: FoundBook[CaseResult]) -> Told:
    """The run that ended so."""
    verdict = Verdict(tuple(COMMAND.limits(found)))
    head = head_of(found.book.config)
    return Told("tune", head, found.book.created, verdict, tuple(COMMAND.show(found)), COMMAND.limits_of_use)


def html_of(found: FoundBook[CaseResult], hashes: Mapping[str, str] = HASHES) -> str:
    """Its page; every chart is the same empty picture."""
    told, drawing = told_of(found), SVG
    charts = (each for each in exhibits_of(told.chapters) if isinstance(each, Chart))
    return page_of(
        told, {each.name: Picture(each.name, "", each.title, each.caption, drawing) for each in charts}, hashes
    )


def table_of(found: FoundBook[CaseResult], name: str) -> Table:
    """One of its tables."""
    (table,) = (each for each in exhibits_of(told_of(found).chapters) if isinstance(each, Table) and each.name == name)
    return table


@pytest.fixture(scope="module")
def page() -> Page:
    """The page of three cases, one of them infeasible; one parameter assumed, one out of its range."""
    return Page(html_of(found_book()))


def test_the_page_is_balanced_and_loads_nothing(page: Page) -> None:
    assert page.open == []
    assert all(address.startswith("#") for address in page.loaded)  # a drawing points to a part of itself
    assert page.tags.isdisjoint({"script", "link", "iframe", "object", "b", "img"})
    assert page.drawings == page.named_drawings == len(CASES) + 2


def test_the_style_loads_nothing() -> None:
    style = re.search(r"<style>(.*?)</style>", html_of(found_book()), re.DOTALL)
    assert style is not None
    assert not re.search(r"url\(|@import|http", style[1])


def test_links_lead_to_sections_of_the_page(page: Page) -> None:
    assert len(set(page.identifiers)) == len(page.identifiers)
    assert {target.removeprefix("#") for target in page.targets} <= set(page.identifiers)
    assert page.targets


def test_cited_sources_are_told_in_full_and_a_point_is_called_fixed(page: Page) -> None:
    text = page.text
    place = text.index("[hump-norm] Railway administration of the USSR")
    assert text.index("<7> & [hump-norm]") < place < text.index("Limits of use", place)
    assert "geum.ru" in text
    assert "[hump-grades] " not in text
    fixed = SourcedValue("cut 'a'.length_m", 13.92, "m", (13.92, 13.92), "engineering judgement", "H")
    said = Page(html_of(found_book(config=replace(CONFIG, parameters=(fixed,))))).text
    assert "13.92 to 13.92" not in said
    assert "fixed" in said
    assert "Sources" not in said


def test_the_verdict_comes_first_and_names_the_infeasible_case(page: Page) -> None:
    text = page.text
    assert text.index("Not accepted") < text.index("Results")
    assert "missed: there is no table for 1 of 4 cases (gondola-85t to 1.5 m/s: the grid is too coarse)" in text
    assert "missed: gondola-85t, target 4 m/s: rms 0.14" in text
    assert (
        "Infeasible and outside the verdict: gondola-85t, target 2 m/s, brake saturated: no entry speed can be "
        "served of the 5 to 6.5 m/s asked for"
    ) in text
    assert all(case.label in text for case in CASES)


def test_assumed_and_exceeded_parameters_are_marked(page: Page) -> None:
    rows = re.findall(r"<tr[^>]*>.*?</tr>", html_of(found_book()))
    (assumed,) = [row for row in rows if ">assumed</td>" in row]
    assert "friction.common_cv" in assumed
    assert "3 parameters, 1 of them assumed" in page.text
    assert "(0, 12.475), (14.475, 26.95)" in page.text
    assert "4.5 to 7: exceeded" in page.text


def test_where_a_prediction_comes_from_is_told(page: Page) -> None:
    """One table with an estimator, two without: a sentence for each kind."""
    predicted = replace(CASES[0].table.predicted, passes=10_000)
    with_it = replace(CASES[0].table, estimator=ESTIMATOR, predicted=predicted)
    text = Page(html_of(found_book((replace(CASES[0], table=with_it), *CASES[1:])))).text
    assert "With an estimator the prediction is itself simulated" in text
    assert "two independent computations of one quantity. Predicted / simulated rms is" in text
    assert "prediction is itself simulated" not in page.text


def test_doubts_of_a_case_are_told(page: Page) -> None:
    assert "Warning for" not in page.text
    case = CASES[0]
    doubtful = replace(
        case,
        polish=replace(case.polish, converged=False, status="Iteration limit reached"),
        predicted=replace(case.predicted, escaped=2e-4),
    )
    found = found_book((doubtful, *CASES[1:]))
    told = Page(html_of(found)).text
    assert "the polish ended before it converged (Iteration limit reached)" in told
    assert "a probability of 2.0e-04 left the top of the speed grid" in told
    assert [row["converged"] for row in table_of(found, "designs").rows] == [False, True, True]


def test_every_condition_off_nominal_has_a_row(page: Page) -> None:
    keys = [row["key"] for row in table_of(found_book(), "off_nominal").rows]
    assert keys == [each.key for each in CONDITIONS] * len(CASES)
    assert "0.1800 ±0.00901.20 ±0.061.2 % ±0.3 %below 0.1 %" in page.text
    assert 'title="0.1800 [0.1710, 0.1890]"' in html_of(found_book())
    assert "cut: mass_t is too much" in page.text


def test_what_is_given_is_escaped() -> None:
    evil = "<script>alert('x')</script>"
    failed = replace(found_book(config=replace(CONFIG, title=evil)))
    html = html_of(failed, {evil: evil})
    assert "<script" not in html
    assert html.count("&lt;script&gt;") >= 4
    assert Page(html).open == []


def test_the_same_book_gives_the_same_bytes() -> None:
    assert html_of(found_book()) == html_of(found_book())


def test_a_case_without_a_table_has_a_row(page: Page) -> None:
    assert "gondola-85t1.5no table–" in page.text


def test_what_is_shown_is_made_without_matplotlib() -> None:
    command = (
        "import sys; from tests.synth.test_report import found_book, told_of; told_of(found_book()); "
        "raise SystemExit('matplotlib' in sys.modules)"
    )
    assert subprocess.run([sys.executable, "-c", command], cwd=ROOT, timeout=60, check=False).returncode == 0


def test_limit_cycles_are_told_where_there_are_some() -> None:
    case = make_case()
    shown = list(checks((case,)))
    assert any(isinstance(each, Table) and each.name == "hunting" for each in shown) == bool(
        hunting_report(case.plant, case.table_lines)
    )
    assert any(isinstance(each, Sentence) and "does not hunt" in each.text for each in shown)


def test_the_first_screen_has_tiles_and_steps_once(page: Page) -> None:
    text = page.text
    assert text.index("Not accepted") < text.index("What to do first") < text.index("keep all limits")
    assert text.index("keep all limits") < text.index("Results")
    assert text.count("Check the tables with the independent program") == 1
    assert "1 of 4tables (cut class and exit speed) keep all limits" in text
    assert "for gondola-85t to 2 m/s no controller keeps the limit" in text
    assert "1 of 3 parameters are assumed" in text
