"""One column and one line tell what permissions would give: figures below their names, and what bounds them."""

from __future__ import annotations

from dataclasses import replace
from statistics import median

import pytest

from synth.book.case_result import CaseResult
from synth.book.permissions.case_document import results_document
from synth.book.permissions.overview import HINT, SHORT, Overview, overview_of
from synth.book.permissions.permission import Permission
from synth.book.tune import Book
from synth.cli import case_columns
from synth.cli.book_table import columns_of
from synth.configuration.config_file import parse_config
from synth.present.report.permissions_section import column_cell, column_head, permissions_section
from tests.synth.case_factory import make_case, make_permissions

LIGHT = (Permission.ANY_TIME, Permission.WITHOUT_GAUGE, Permission.APPROACH)
HEAVY = (Permission.ANY_TIME, Permission.ESTIMATOR, Permission.NO_ESTIMATOR, Permission.NO_APPROACH)


@pytest.fixture(scope="module")
def cases() -> tuple[CaseResult, ...]:
    """Two cases that other permissions are asked for: only one of them has an approach."""
    light, heavy = make_case("gondola-22t", 2.0), make_case("gondola-85t", 4.0)
    return (
        replace(light, permissions=make_permissions(light, *LIGHT)),
        replace(heavy, permissions=make_permissions(heavy, *HEAVY)),
    )


@pytest.fixture(scope="module")
def overview(cases: tuple[CaseResult, ...]) -> Overview:
    found = overview_of(case.permissions for case in cases)
    assert found is not None
    return found


def test_every_permission_has_a_column_of_its_figures(overview: Overview) -> None:
    assert set(overview.in_column) == set(SHORT) == {*LIGHT, *HEAVY} - {Permission.WITHOUT_GAUGE}
    for permission in overview.in_column:
        column = case_columns.permission_column(permission)
        assert column.heading.replace("\u00a0", " ") == f"rms × if {SHORT[permission]}"
        for case in overview.cases:
            found, told = case.of(permission), column.cell({"permissions": results_document(case)})
            assert told == (None if found is None else f"{found.ratio:.2f}")
        assert column.cell({"permissions": None}) is column.cell({}) is None
    for case in overview.cases:
        ratios = [case.of(each) for each in overview.in_column]
        assert column_cell(case, overview).text == " ".join(
            "–" if each is None else f"{each.ratio:.2f}" for each in ratios
        )
    assert column_head(overview).count(",") == len(overview.in_column) - 1


def test_the_line_tells_medians_and_bounds_every_interval(overview: Overview) -> None:
    results = [each for case in overview.cases for each in case.results]
    halves = [abs(end - each.ratio) for each in results for end in each.ratio_ci95]
    assert overview.widest - 0.01 < max(halves) <= overview.widest
    assert f"no 95 % interval wider than ±{overview.widest:.2f}" in overview.line
    assert f"on the same {overview.cases[0].table.passes} passes" in overview.line
    any_time = [each.ratio for each in results if each.permission is Permission.ANY_TIME]
    assert f"Medians: commands at any time {median(any_time):.2f}, commands at any time, no" in overview.line


def test_a_book_in_which_no_permission_can_be_told_says_so(overview: Overview) -> None:
    none = Overview(tuple(replace(case, results=()) for case in overview.cases))
    assert none.line == "rms × if permitted: none can be told."
    assert none.widest == 0.0


def test_who_asks_sees_their_columns_before_others(overview: Overview) -> None:
    columns = columns_of([], overview)
    asked = [column for column in columns if column.heading.startswith("rms × if")]
    assert len(asked) == len(overview.in_column)
    assert {column.spare for column in asked} == {case_columns.OUT_OF_BRAKE.spare + 1}
    assert min(column.spare for column in columns if column not in asked and column.spare > 1) > asked[0].spare
    assert not any(column.heading.startswith("rms × if") for column in columns_of([], None))


def test_the_report_tells_every_interval(overview: Overview) -> None:
    page = permissions_section(overview)
    for each in (result for case in overview.cases for result in case.results):
        low, high = each.ratio_ci95
        assert f">{each.ratio:.2f} [{low:.2f}, {high:.2f}]</td>" in page
        assert f">{each.permission.value}</th>" in page


def test_a_book_tells_how_to_ask_where_nobody_did_and_it_would_not_be_refused(cases: tuple[CaseResult, ...]) -> None:
    plain, at_any_time = parse_config("", "c"), parse_config('[regulator]\ncommands = "any_time"\n', "c")
    assert Book(plain, "", (make_case(),), ()).permissions_line == HINT
    assert Book(at_any_time, "", (make_case(),), ()).permissions_line == ""
    told = Book(plain, "", cases, ())
    assert told.permissions is not None
    assert told.permissions_line == told.permissions.line
