"""Classes added, removed, reordered: numbers and choices of the others stay, in C and in Structured Text."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from scripts.studies.in_the_loop.controller_process import COMMAND, build_controller
from synth.retarder.configuration.config_file import parse_config
from tests.controller_code.conftest import Tool
from tests.controller_code.sample_book import FOUR_AXLES, table_of
from tuning_tables import ControllerTable
from tuning_tables.category_names import category_names
from tuning_tables.golden_choices import golden_choices
from tuning_tables.programs.line_table import LINE_TABLE
from tuning_tables.table_book import TableBook

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


@pytest.mark.long
@pytest.mark.parametrize("after", AFTER, ids="-".join)
def test_the_same_commands_choose_the_same_tables_in_c(after: tuple[str, ...], tmp_path: Path, tool: Tool) -> None:
    tool("gcc")
    answers = []
    for name, categories in (("before", BEFORE), ("after", after)):
        folder = tmp_path / name
        folder.mkdir()
        answers.append(build_controller(book(*categories), folder).select(commands()))
        assert set(answers[-1][0][answers[-1][1][:, 0] > 0].tolist()) == {0, 1, 2}
    numbers = commands()["category"]
    (status, chosen), (status_now, chosen_now) = answers
    stayed = np.isin(numbers, [FIXED[each] for each in {*BEFORE} & {*after}])
    assert np.array_equal(status[stayed], status_now[stayed])
    # The family is a number of the book, as its tables stand in it; the checksum at the end covers it.
    same = [each for each in range(chosen.shape[1] - 1) if each != family_word()]
    assert np.array_equal(chosen[stayed][:, same], chosen_now[stayed][:, same])
    # What a class that is not there was asked for is refused, and never given another one's table.
    assert (status_now[~np.isin(numbers, [FIXED[each] for each in after])] == -1).all()
    for words in (chosen, chosen_now):
        assert np.isin(words[:, 0], [0, *FIXED.values()]).all()
        assert (words[words[:, 0] > 0, 0] == numbers[words[:, 0] > 0]).all()


def family_word() -> int:
    """The word of a table that holds the number of its family: members before it are numbers."""
    return list(LINE_TABLE.members).index("family_no")


def commands() -> np.ndarray:
    """Every number from 0 to 17 at speeds around all targets."""
    speeds = np.linspace(1.9, 3.3, 141, dtype=np.float32).tolist()
    exact = [table.target_speed_m_s for category in FIXED for table in tables(category)]
    rows = [(number, 4, speed) for number in range(18) for speed in (*speeds, *exact)]
    return np.array(rows, COMMAND)


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
