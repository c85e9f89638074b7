"""Lines between two targets are taken only of equal estimators: pairs that differ in one number alone, in C and ST."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tuning_tables.table_block import LAYOUT

from scripts.studies.in_the_loop.agreement import choices_of
from scripts.studies.in_the_loop.controller_process import COMMAND, build_controller
from tests.controller_code.conftest import Tool
from tests.controller_code.sample_book import estimator_of, table_of
from tuning_tables import Estimator, Status
from tuning_tables.st_source import TABLE_FILE, st_files
from tuning_tables.table_book import TableBook

LIGHT = 1
"""Number of the category Л."""

SLOWER_M_S, BETWEEN_M_S, FASTER_M_S = 2.0, 2.5, 3.0
USUAL = estimator_of(4, 37.45)


def last_bit(value: float) -> float:
    """The next float32 number above."""
    return float(np.nextafter(np.float32(value), np.float32(np.inf)))


def with_entry(key: str, place: int, value: float) -> Estimator:
    """The usual estimator with one entry of a row changed."""
    row = list(getattr(USUAL, key))
    row[place] = value
    changes: dict[str, Any] = {key: tuple(row)}  # which field, `key` alone tells
    return replace(USUAL, **changes)


UNLIKE: dict[str, Estimator | None] = {
    "speed_noise_m_s": replace(USUAL, speed_noise_m_s=last_bit(USUAL.speed_noise_m_s)),
    "friction_cv": replace(USUAL, friction_cv=last_bit(USUAL.friction_cv)),
    "path_std": replace(USUAL, path_std=last_bit(USUAL.path_std)),
    "correlation_length_m": replace(USUAL, correlation_length_m=last_bit(USUAL.correlation_length_m)),
    "touch_pressure_kpa": replace(USUAL, touch_pressure_kpa=last_bit(USUAL.touch_pressure_kpa)),
    "touch pressure 0": replace(USUAL, touch_pressure_kpa=0.0),
    **{
        f"{key}[{place}]": with_entry(key, place, last_bit(getattr(USUAL, key)[place]))
        for key in ("s_m", "drive_m2_s2", "brake_m2_s2_per_kpa")
        for place in (1, 3)
    },
    "breaks": estimator_of(5, 37.45),
    "none": None,
}
LIKE: dict[str, Estimator | None] = {
    "equal": USUAL,
    "less than a float32 apart": replace(USUAL, touch_pressure_kpa=USUAL.touch_pressure_kpa * (1.0 + 1e-9)),
    "the same 2 sigma^2 l": replace(USUAL, path_std=0.5 * USUAL.path_std, correlation_length_m=8.0),
}
"""What a controller holds of these is the same."""

CASES = {**UNLIKE, **LIKE}


def axles_of(case: str) -> int:
    """The number of axles that stands for `case`."""
    return 4 + list(CASES).index(case)


@pytest.fixture(scope="module")
def pairs() -> TableBook:
    """A class of two targets for each case, told apart by the number of axles."""
    tables = []
    for name, other in CASES.items():
        offsets = tuple(1.5 * axle for axle in range(axles_of(name)))
        slower, faster = (table_of(f"{name} {v}", "Л", 23.0, offsets, v, 3, 1) for v in (SLOWER_M_S, FASTER_M_S))
        tables += [replace(slower, estimator=USUAL), replace(faster, estimator=other)]
    return TableBook(tuple(tables))


def test_python_takes_lines_between_of_equal_estimators_only(pairs: TableBook) -> None:
    found = {name: pairs.choose("Л", axles_of(name), BETWEEN_M_S).status for name in CASES}
    assert found == dict.fromkeys(UNLIKE, Status.SLOWER) | dict.fromkeys(LIKE, Status.BETWEEN)


def test_c_agrees_in_every_case(pairs: TableBook, tmp_path: Path, tool: Tool) -> None:
    controller = build_controller(pairs, tmp_path, tool("gcc"))
    commands = np.array([(LAYOUT, LIGHT, axles_of(name), BETWEEN_M_S) for name in CASES], COMMAND)
    statuses, words = controller.select(commands)
    own_statuses, own_words = choices_of(pairs, commands)
    assert np.array_equal(statuses, own_statuses)
    assert np.array_equal(words, own_words)
    assert controller.self_test() == "fault 0 at 0"


def test_structured_text_agrees_in_every_case(pairs: TableBook) -> None:
    evaluator = pytest.importorskip("tests.tuning_tables.st.evaluator")
    program = evaluator.Program(st_files(pairs)[TABLE_FILE])
    for name in CASES:
        selector, table = program.new("RETARDER_SELECT"), program.new("RETARDER_TABLE")
        program.call("RETARDER_SELECT", selector, Layout=LAYOUT, Category=LIGHT, Axles=axles_of(name),
                     Commanded_m_s=np.float32(BETWEEN_M_S), Table=table)  # fmt: skip
        choice = pairs.choose("Л", axles_of(name), BETWEEN_M_S)
        assert selector["STATUS"].value == choice.status, name
        assert choice.table is not None
        estimator = choice.table.estimator
        assert estimator is not None
        assert table["TOUCH_KPA"].value == np.float32(estimator.touch_pressure_kpa)
