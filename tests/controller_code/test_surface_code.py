"""Tables that decide at any time, in C: lines over the pressure, lines between two tables, wrong code that is found."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from tuning_tables.table_block import LAYOUT, block_of, block_size

from scripts.studies.in_the_loop.agreement import ask, choices_of, differences, follow
from scripts.studies.in_the_loop.controller_process import (
    COMMAND,
    CONTRACT,
    READING,
    build_controller,
    compile_with,
    sources_of,
)
from tests.controller_code.conftest import Built, ToChange, Tool
from tests.controller_code.sample_book import approaching_book, sample_book, surface_book, table_of, with_slopes
from tuning_tables import ControllerTable, Decisions, Status, ValidRange
from tuning_tables.c_source import c_files
from tuning_tables.self_test_size import FULL, SMALL
from tuning_tables.table_book import TableBook

LIGHT = 1
"""Number of the category Л."""

SLOWER_M_S, BETWEEN_M_S, FASTER_M_S = 2.0, 2.5, 3.0


def at_rest(table: ControllerTable) -> ControllerTable:
    """The table without slopes that decides at rest."""
    stages = (replace(each, lower_slope_m_s_per_kpa=None, upper_slope_m_s_per_kpa=None) for each in table.stages)
    return replace(table, stages=tuple(stages), decisions=Decisions.AT_REST)


def pressed(table: ControllerTable, kpa: float) -> ControllerTable:
    """The table with another pressure of its second stage."""
    first, second, *others = table.stages
    return replace(table, stages=(first, replace(second, pressure_kpa=kpa), *others))


OTHERS: dict[str, Callable[[ControllerTable], ControllerTable]] = {
    "other slopes": lambda table: with_slopes(table, -0.0015, -0.001),
    "less than a float32 apart": lambda table: pressed(table, 150.0 + 1e-7),
    "a float32 apart": lambda table: pressed(table, float(np.nextafter(np.float32(150.0), np.float32(0.0)))),
    "more pressure": lambda table: pressed(table, 160.0),
    "no gauge": lambda table: replace(at_rest(table), decisions=Decisions.AT_ANY_TIME),
    "at rest": at_rest,
}
"""What a faster table may be beside one with slopes."""

WITHOUT: dict[str, Callable[[ControllerTable], ControllerTable]] = {
    "both at any time": lambda table: pressed(replace(table, decisions=Decisions.AT_ANY_TIME), 160.0),
    "one at rest": lambda table: table,
}
"""And beside one that decides at any time without a gauge."""


@cache
def pairs() -> TableBook:
    """A class of two targets for each case; the number of axles stands for the case."""
    tables = []
    for place, (name, changed) in enumerate((OTHERS | WITHOUT).items()):
        offsets = tuple(1.5 * axle for axle in range(4 + place))
        slower, faster = (table_of(f"{name} {v}", "Л", 23.0, offsets, v) for v in (SLOWER_M_S, FASTER_M_S))
        if name in OTHERS:
            slower, faster = (with_slopes(each, -0.001, -0.0012) for each in (slower, faster))
        else:
            slower = replace(slower, decisions=Decisions.AT_ANY_TIME)
        tables += [slower, changed(faster)]
    return TableBook(tuple(tables))


def test_c_takes_lines_between_tables_of_equal_times_and_pressures_only(built: Built) -> None:
    book, names = pairs(), [*OTHERS, *WITHOUT]
    statuses = {name: book.choose("Л", 4 + place, BETWEEN_M_S).status for place, name in enumerate(names)}
    like = dict.fromkeys(("other slopes", "less than a float32 apart", "both at any time"), Status.BETWEEN)
    assert statuses == dict.fromkeys(names, Status.SLOWER) | like
    controller = built(book)
    commands = np.array([(LAYOUT, LIGHT, 4 + place, BETWEEN_M_S) for place in range(len(names))], COMMAND)
    found, words = controller.select(commands)
    own, own_words = choices_of(book, commands)
    assert np.array_equal(found, own)
    assert np.array_equal(words, own_words)
    size = block_size(book)
    slopes = words[0, size.pressures].view(np.float32)[1 + size.stages :]
    assert np.allclose(slopes[2:4], (-0.00125, -0.0011))  # half way
    assert controller.self_test() == "fault 0 at 0"


@pytest.mark.parametrize("of", [sample_book, lambda: approaching_book(False)], ids=["measured", "approached"])
def test_surfaces_of_other_books_decide_as_python(of: Callable[[], TableBook], built: Built) -> None:
    book = surface_book(of())
    questions = ask(book, 200_000, 5_000, 14)
    silent = questions.readings.copy()
    silent["pressure_kpa"] = np.nan
    controller = built(book)
    assert np.count_nonzero(controller.decide(silent) != questions.decisions) > 20_000  # the pressure matters
    assert differences(controller, questions, follow(book, 1_000, 15)).none


def test_at_any_time_without_a_gauge_is_the_rule_of_before(tmp_path: Path, tool: Tool) -> None:
    tool("gcc")
    book = TableBook(
        tuple(
            replace(table, decisions=Decisions.AT_ANY_TIME) if table.target_speed_m_s < 4.0 else table
            for table in approaching_book().tables
        )
    )
    header = c_files(book)["retarder_table.h"].decode("ascii")
    assert "RETARDER_AT_ANY_TIME 1u" in header
    assert "GAUGE" not in header
    assert "pressures" not in header
    controller = build_controller(book, tmp_path)
    assert differences(controller, ask(book, 100_000, 5_000, 16), follow(book, 1_000, 17)).none
    assert controller.at_any_time() == [table.target_speed_m_s < 4.0 for table in book.tables]
    for name in ("retarder_table.c", "retarder_self_test.c"):
        for compiler in ("gcc", "clang"):
            flags = [*CONTRACT, "-Wconversion", "-Wundef", "-Wfloat-equal", "-Wmissing-prototypes"]
            compile_with([tool(compiler), *flags, "-c", str(tmp_path / name), "-o", str(tmp_path / "o")])


def test_books_at_rest_say_nothing_of_it() -> None:
    for name, content in c_files(approaching_book()).items():
        text = content.decode("utf-8").lower()
        assert not any(word in text for word in ("any_time", "any time", "gauge", "slopes")), name


def test_the_words_come_last_and_only_where_they_are_needed() -> None:
    book = TableBook(surface_book().tables[:1])
    plain = TableBook(tuple(map(at_rest, book.tables)))
    timed = TableBook(tuple(replace(table, decisions=Decisions.AT_ANY_TIME) for table in plain.tables))
    words, before, between = (block_of(each, 0).words for each in (book, plain, timed))
    assert np.array_equal(words[: len(before) - 1], before[:-1])
    assert between[:-1].tolist() == [*before[:-1].tolist(), 1]
    stages = len(book.tables[0].stages)
    more = words[len(before) - 1 : -1]
    numbers = more[1:].view(np.float32)
    assert more[0] == 1
    assert numbers[0] == 450.0
    assert numbers[1 : 1 + stages].tolist() == [0.0, 150.0, 300.0, 450.0, 600.0]
    low, high = np.float32(-0.001), np.float32(-0.0012)
    slopes = [[0.0, high], [low, high], [low, high], [low, 0.0], [low, 0.0]]
    assert np.array_equal(numbers[1 + stages :].reshape(stages, 2), np.array(slopes, np.float32))


def test_every_changed_word_is_refused(built: Built) -> None:
    book = surface_book()
    controller = built(book)
    for number in range(len(book.tables)):
        words = block_of(book, number).words
        damaged = np.repeat(words[None, :], 32 * len(words), axis=0)
        place, bit = np.divmod(np.arange(32 * len(words)), 32)
        damaged[np.arange(32 * len(words)), place] ^= (1 << bit).astype(np.uint32)
        assert controller.intact(words[None, :]).all()
        assert not controller.intact(damaged).any()


def test_pressures_at_and_beyond_their_bounds_are_clamped(built: Built) -> None:
    table = with_slopes(table_of("one", "Л", 23.0, (0.0,), 2.0, degree=0), -0.0078125, -0.0078125)
    line = np.float32(3.9)  # upper at stage 1, 150 kPa; raised to stage 3 at most, 450 kPa
    asked = {0.0: 1.171875, -1.0: 1.171875, -3e38: 1.171875, 150.0: 0.0, 450.0: -2.34375,
             451.0: -2.34375, 3e38: -2.34375, np.inf: 0.0, -np.inf: 0.0, np.nan: 0.0}  # fmt: skip
    assert table.stages[1].upper == (float(line),)
    controller = built(TableBook((replace(table, valid=ValidRange((0.0, 9.0), (0.3, 9.0))),)))
    for kpa, rise in asked.items():
        tie = np.float32(line + np.float32(rise))
        speeds = [tie, np.nextafter(tie, np.float32(9.0)), np.nextafter(tie, np.float32(0.0))]
        readings = np.array([(0, 1, 4.0, v, kpa) for v in speeds], READING)
        assert controller.decide(readings).tolist() == [1, 2, 1], kpa


MUTANTS = [
    ("kpa = table->pressures[0];", "kpa = *pressure_kpa;", 3),  # not clamped from below
    ("kpa = table->highest_kpa;", "kpa = *pressure_kpa;", 3),  # nor from above
    ("kpa < table->pressures[0]", "kpa > table->pressures[0]", 3),
    ("kpa > table->highest_kpa", "kpa < table->highest_kpa", 3),
    ("*pressure_kpa >= -FLT_MAX && ", "", 3),  # an infinite pressure of either sign counts as a bound
    ("&& *pressure_kpa <= FLT_MAX", "", 3),
    ("!(*pressure_kpa >= -FLT_MAX && *pressure_kpa <= FLT_MAX)", "0", 3),  # NaN is taken for a pressure
    ("        return 0.0f;\n    }\n    kpa", "        return 0.125f;\n    }\n    kpa", 3),
    ("rounded(kpa - table->pressures[stage])", "rounded(table->pressures[stage] - kpa)", 3),  # turned round
    ("rounded(kpa - table->pressures[stage])", "kpa", 3),
    ("rounded(kpa - table->pressures[stage])", "rounded(kpa - table->pressures[0])", 3),
    ("table->slopes[stage][line] * rounded", "table->slopes[stage][0] * rounded", 3),
    ("table->slopes[stage][line] * rounded", "table->slopes[stage][1u - line] * rounded", 3),
    ("table->slopes[stage][line] * rounded", "table->slopes[0][line] * rounded", 3),
    ("table->slopes[stage][line] * rounded", "1.0000001f * table->slopes[stage][line] * rounded", 3),
    ("speed + pressure_rise(", "speed - pressure_rise(", 3),
    ("rounded(speed + pressure_rise(table, stage, line, pressure_kpa))", "speed", 3),
    ("surface_speed(table, stage, 0u,", "surface_speed(table, stage, 1u,", 3),
    ("surface_speed(table, stage, 1u,", "surface_speed(table, stage, 0u,", 3),
    ("decide(table, stage, s_m, v_m_s, &pressure_kpa)", "decide(table, stage, s_m, v_m_s, 0)", 3),
    ("decide(table, stage, s_m, v_m_s, 0)", "decide(table, stage, s_m, v_m_s, &table->highest_kpa)", 3),
    ("table->at_any_time == 1u", "table->at_any_time == 0u", 2),
    ("0u, /* decides at rest */", "1u, /* decides at rest */", 2),
    ("0x1.c2p+8f, /* highest pressure", "0x1.c20002p+8f, /* highest pressure", 2),
    ("0x1.2cp+7f, /* of stage 1, 150 kPa */", "0x1.2c0002p+7f, /* of stage 1, 150 kPa */", 2),
    ("-0x1.0624dep-10f", "-0x1.0624ep-10f", 2),
    (" && is_same_gauge(slower, faster)", "", 4),
    ("&& slower->at_any_time == faster->at_any_time", "", 4),
    ("slower->pressures[stage] < faster->pressures[stage]", "0", 4),
    ("slower->pressures[stage] > faster->pressures[stage]", "0", 4),
    ("rounded(faster->slopes[stage][line] - slower->slopes[stage][line])", "faster->slopes[stage][line]", 4),
    ("rounded(weight * rounded(faster->slopes", "rounded(rounded(faster->slopes", 4),
    ("= rounded(slower->slopes[stage][line]", "= rounded(faster->slopes[stage][line]", 4),
    ("chosen->slopes[stage][line] = ", "chosen->slopes[stage][line] += ", 4),
]
"""A part of the text, what stands there instead, and the fault that the self-test is to tell."""


@cache
def mutants() -> TableBook:
    """Tables that show every mutant: slopes of either line, and neighbours of other times or pressures either way."""
    tables = [table for table in surface_book(approaching_book(False)).tables if table.id.startswith(("light", "odd"))]
    paired = {name: pairs().tables[2 * place : 2 * place + 2] for place, name in enumerate(OTHERS | WITHOUT)}
    chosen = ("a float32 apart", "more pressure", "one at rest")
    return TableBook((*tables, *(table for name in chosen for table in paired[name])))


@pytest.mark.parametrize(("before", "after", "fault"), MUTANTS)
def test_the_self_test_finds_wrong_surfaces(
    before: str, after: str, fault: int, tmp_path: Path, to_change: ToChange
) -> None:
    export = to_change([sources_of(mutants(), size) for size in (FULL, SMALL)], "retarder_table.c")
    assert [said.returncode for said in export.self_tests(before, after, tmp_path)] == [fault, fault]
