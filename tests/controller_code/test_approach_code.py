"""Tables that act before the entrance, in C: the gate, lines between two of them, and wrong code that is found."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from tuning_tables.table_block import LAYOUT, block_of, block_size

from scripts.studies.in_the_loop.agreement import ask, choices_of, differences, follow
from scripts.studies.in_the_loop.controller_process import COMMAND, sources_of
from tests.controller_code.conftest import Built, ToChange
from tests.controller_code.sample_book import approaching_book, table_of, with_approach
from tuning_tables import Approach, Status
from tuning_tables.c_source import c_files
from tuning_tables.self_test_size import FULL, SMALL
from tuning_tables.table_book import TableBook

LIGHT = 1
"""Number of the category Л."""

SLOWER_M_S, BETWEEN_M_S, FASTER_M_S = 2.0, 2.5, 3.0
OTHERS = {
    "equal": (4.0, 1), "less than a float32 apart": (4.0 + 1e-9, 1), "stage": (4.0, 2), "none": (0.0, 0),
    "length": (float(np.nextafter(np.float32(4), np.float32(5))), 1),
}  # fmt: skip
"""Approach of the faster table beside one of 4 m and stage 1."""


def axles_of(case: str) -> int:
    """The number of axles that stands for `case`."""
    return 4 + list(OTHERS).index(case)


@pytest.fixture(scope="module")
def pairs() -> TableBook:
    """A class of two targets for each case; "none" has the path range of the approach all the same."""
    tables = []
    for name, (length_m, stage) in OTHERS.items():
        offsets = tuple(1.5 * axle for axle in range(axles_of(name)))
        slower, faster = (table_of(f"{name} {v}", "Л", 23.0, offsets, v, 4, 1) for v in (SLOWER_M_S, FASTER_M_S))
        other = replace(with_approach(faster, 4.0, 1), approach=None)
        tables += [with_approach(slower, 4.0, 1), with_approach(faster, length_m, stage) if length_m else other]
    return TableBook(tuple(tables))


def test_c_takes_lines_between_equal_approaches_only(pairs: TableBook, built: Built) -> None:
    statuses = {name: pairs.choose("Л", axles_of(name), BETWEEN_M_S).status for name in OTHERS}
    like = dict.fromkeys(("equal", "less than a float32 apart"), Status.BETWEEN)
    assert statuses == dict.fromkeys(OTHERS, Status.SLOWER) | like
    controller = built(pairs)
    commands = np.array([(LAYOUT, LIGHT, axles_of(name), BETWEEN_M_S) for name in OTHERS], COMMAND)
    found, words = controller.select(commands)
    own, own_words = choices_of(pairs, commands)
    assert np.array_equal(found, own)
    assert np.array_equal(words, own_words)
    assert controller.self_test() == "fault 0 at 0"


def test_approaches_without_estimators_decide_as_python(built: Built) -> None:
    book = approaching_book(estimators=False)
    questions = ask(book, 200_000, 5_000, 14)
    before = (questions.readings["s_m"] < 0.0) & (questions.readings["s_m"] > -10.0)
    far = (questions.decisions - questions.readings["stage"])[before]
    assert min(np.count_nonzero(far < 0), np.count_nonzero(far == 0), np.count_nonzero(far > 0)) > 2_000
    assert differences(built(book), questions, follow(book, 1_000, 15)).none


def test_the_controller_tells_approach_and_entrance_stage(built: Built) -> None:
    book = approaching_book()
    told = built(book).approaches()
    assert told[0] == (4.0, 1)
    assert told[10] == (float(np.float32(1e-3)), 0)
    assert told[5] == (0.0, 4)  # without approach: the highest stage of the table


def test_the_words_of_an_approach_come_last_and_only_where_there_is_one() -> None:
    plain, approached = (TableBook(approaching_book().tables[:n]) for n in (2, 1))
    without = TableBook(tuple(replace(table, approach=None) for table in plain.tables))
    assert block_size(plain).words == block_size(without).words + 2
    words = block_of(approached, 0).words
    assert words[-3:-1].tolist() == [int(np.float32(4.0).view(np.uint32)), 1]
    assert np.array_equal(block_of(without, 0).words[:-1], words[:-3])


@pytest.mark.parametrize(
    ("before", "after", "fault"),
    [
        ("s_m >= 0.0f ||", "s_m > 0.0f ||", 3),  # a gate at the entrance, too
        ("s_m >= 0.0f ||", "s_m <= 0.0f ||", 3),  # turned round
        ("s_m >= 0.0f ||", "s_m >= -0.5f ||", 3),
        ("may_raise(table, stage, s_m)", "1", 3),  # no gate
        ("may_raise(table, stage, s_m)", "may_raise(table, stage + 1, s_m)", 3),
        ("(uint32_t)stage < table->entrance_stage", "(uint32_t)stage <= table->entrance_stage", 3),
        ("(uint32_t)stage < table->entrance_stage", "(uint32_t)stage + 1u < table->entrance_stage", 3),
        ("(uint32_t)stage < table->entrance_stage", "0", 3),  # nothing is raised
        ("(lines & 1u) != 0u && v_m_s <", "(lines & 1u) != 0u && s_m >= 0.0f && v_m_s <", 3),  # nothing is lowered
        ("1u, /* highest stage before the entrance */", "2u, /* highest stage before the entrance */", 2),
        ("0x1p+2f, /* approach, 4 m */", "0x1p+1f, /* approach, 4 m */", 2),
        ("&& is_same_approach(slower, faster)", "", 4),
        ("&& slower->entrance_stage == faster->entrance_stage", "", 4),
    ],
)
def test_the_self_test_finds_a_wrong_gate(
    before: str, after: str, fault: int, tmp_path: Path, to_change: ToChange
) -> None:
    book = approaching_book(estimators=False)
    export = to_change([sources_of(book, size) for size in (FULL, SMALL)], "retarder_table.c")
    assert [said.returncode for said in export.self_tests(before, after, tmp_path)] == [fault, fault]


def test_the_interlock_stands_in_the_header(tmp_path: Path) -> None:
    header = c_files(approaching_book())["retarder_table.h"].decode("ascii")
    assert "only when the cut ahead has left the position" in header
    assert "#define RETARDER_APPROACH 1u" in header
    table = with_approach(table_of("one", "Л", 23.0, (0.0,), 2.0), 4.0, 1)
    assert "#define RETARDER_APPROACH 0u" in c_files(TableBook((replace(table, approach=None),)))[
        "retarder_table.h"
    ].decode("ascii")
    assert table.approach == Approach(4.0, 1)
