"""Two positions have names of their own; classes added, removed, reordered: the others keep numbers and choices."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import replace

import pytest

from synth.retarder.configuration.config_file import parse_config
from tests.controller_code.sample_book import FOUR_AXLES, estimating_book, park_book, sample_book, table_of
from tests.st_files import st_files
from tuning_tables import ControllerTable
from tuning_tables.category_number import category_names
from tuning_tables.export_names import RETARDER, ExportPrefix
from tuning_tables.exports import c_files, line_export
from tuning_tables.golden_choices import golden_choices
from tuning_tables.language.st_layout import unit_files
from tuning_tables.table_book import TableBook

POSITIONS = {"bunch": estimating_book(), "park": park_book()}


def split_files(book: TableBook, prefix: ExportPrefix = RETARDER) -> Mapping[str, bytes]:
    """Structured Text with a file each unit."""
    return unit_files(line_export(book, prefix))


@pytest.mark.parametrize("export", [c_files, st_files, split_files])
def test_the_default_prefix_changes_no_byte(export: Callable[..., Mapping[str, bytes]]) -> None:
    for book in POSITIONS.values():
        assert export(book, ExportPrefix("retarder")) == export(book)


@pytest.mark.parametrize("export", [c_files, st_files, split_files])
def test_every_name_has_the_prefix_and_no_comment_loses_an_id(export: Callable[..., Mapping[str, bytes]]) -> None:
    book = sample_book()
    odd = replace(book.tables[0], id="RETARDER_LOAD retarder_x")
    plain, named = (export(TableBook((odd, *book.tables[1:])), prefix) for prefix in (ExportPrefix(), PARK))
    assert list(named) == [name.replace("retarder_", "park_2_").replace("RETARDER_", "PARK_2_")
                           .replace("golden_", "park_2_golden_") for name in plain]  # fmt: skip
    for before, after in zip(plain.values(), named.values(), strict=True):
        assert b"RETARDER<U+005F>LOAD retarder<U+005F>x" in before or b"0: RETARDER" not in before
        if before != after:  # tables as CSV have no names
            assert not re.search(rb"(?i)\bretarder_", after)
            back = re.sub(rb"\bPARK_2_", b"RETARDER_", re.sub(rb"\bpark_2_", b"retarder_", after))
            assert back == before


PARK = ExportPrefix("Park_2")


@pytest.mark.parametrize("text", ["", "1A", "A B", "_A", "A_", "A__B", "ПАРК", "A-B", "ABCDEFGHIJK", "A\n"])
def test_what_is_no_identifier_is_refused(text: str) -> None:
    with pytest.raises(ValueError, match=r"the prefix is .* such as BUNCH"):
        ExportPrefix(text)


MASSES = {"Л": 23.0, "ЛС": 36.0, "С": 52.0, "СТ": 66.0, "Т": 85.0}
FIXED = {"Л": 1, "ЛС": 2, "С": 3, "СТ": 4, "Т": 5, "own": 16}


def tables(category: str) -> tuple[ControllerTable, ...]:
    """Two targets of one class; the lines differ from class to class."""
    mass_t = MASSES.get(category, 40.0)
    made = []
    for target in (2.0 + mass_t / 1000.0, 3.0 + mass_t / 1000.0):
        table = table_of(f"{category} to {target}", category, mass_t, FOUR_AXLES, target)
        number = None if category in MASSES else 16
        made.append(replace(table, cut=replace(table.cut, category_number=number)))
    return tuple(made)


def book(*categories: str) -> TableBook:
    return TableBook(tuple(table for category in categories for table in tables(category)))


BEFORE = ("Л", "С", "Т")
AFTER = [
    ("Т", "С", "Л"),
    ("С", "Т", "Л"),
    ("Л", "ЛС", "С", "СТ", "Т"),
    ("own", "СТ", "Т", "ЛС", "С", "Л"),
    ("Т",),
    ("Т", "Л"),
]
"""Reordered, with classes added before, between and behind, with classes removed."""


def choices_by_class(of: TableBook) -> dict[int, list[tuple[object, ...]]]:
    """By number of the category the golden choices with a table: command, status, target speed and coefficients."""
    found: dict[int, list[tuple[object, ...]]] = {}
    for choice in golden_choices(of):
        if choice.table is not None:
            chosen = choice.table.target_speed_m_s, choice.table.coefficients.tobytes()
            found.setdefault(choice.category, []).append((choice.commanded_m_s, choice.status, *chosen))
    return found


@pytest.mark.parametrize("after", AFTER, ids="-".join)
def test_numbers_and_golden_choices_stay(after: tuple[str, ...]) -> None:
    first, second = book(*BEFORE), book(*after)
    assert dict(second.category_numbers) == {category: FIXED[category] for category in after}
    assert {*category_names(first.exported_numbers())} <= {*category_names(second.exported_numbers())}
    before, now = choices_by_class(first), choices_by_class(second)
    assert set(now) == {FIXED[category] for category in after}
    for category in {*BEFORE} & {*after}:
        assert before[FIXED[category]] == now[FIXED[category]]
        assert len(now[FIXED[category]]) > 5


CUT = """
[[cut]]
car = "gondola-4"
mass_t = {}
"""


@pytest.mark.parametrize("order", [(22, 85), (85, 22), (85, 52, 22), (36, 85, 22)])
def test_the_order_of_a_configuration_does_not_count(order: tuple[int, ...]) -> None:
    config = parse_config("".join(map(CUT.format, order)), "my.toml")
    numbers = {22: 1, 36: 2, 52: 3, 85: 5}
    assert [each.cut.category_number for each in config.cuts] == [numbers[mass_t] for mass_t in order]
    # It is no physics: what was computed before stays valid.
    assert all("category_number" not in each.canonical() for each in config.cuts)
