"""Lines between two targets are taken only of tables of one family, which differ in nothing but target and lines."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from scripts.studies.in_the_loop.agreement import choices_of
from scripts.studies.in_the_loop.controller_process import COMMAND, held_record, held_words, places, sealed, sources_of
from tests.controller_code.conftest import Built, ToChange
from tests.controller_code.sample_book import estimator_of, table_of, with_approach, with_slopes
from tests.effort import sized
from tuning_tables import ControllerTable, Decisions, Status, ValidRange
from tuning_tables.book_classes import families_of
from tuning_tables.self_test_size import SMALL
from tuning_tables.table_book import TableBook

OWN = {"family_no", "target_m_s", "coefficient", "slope"}
"""The number of the family, and the members in which two of its tables may differ."""

FAMILY = re.compile(r"(\d+), /\* family_no \*/")
CRC32 = re.compile(r"0x([0-9a-f]{8})u /\* crc32 \*/")
FAMILIES = re.compile(r"FamilyNoOf : ARRAY\[\S+ OF INT := \[(.*?)\];", re.DOTALL)


def wrong_family(case: str) -> tuple[int, int]:
    """The number of the faster table of a case, and a family that makes a pair of no pair, and no pair of a pair."""
    slower = 2 * list(CASES).index(case)
    return slower + 1, slower if case in UNLIKE else slower + 1


def test_the_families_of_all_cases() -> None:
    due = [number for place, case in enumerate(CASES)
           for number in (2 * place, 2 * place + (case in UNLIKE))]  # fmt: skip
    assert [*pairs().families] == due


@pytest.mark.requirement("CHOICE-04")
def test_python_takes_lines_between_like_tables_only() -> None:
    found = {name: pairs().choose("Л", axles_of(name), BETWEEN_M_S).status for name in CASES}
    assert found == dict.fromkeys(LIKE, Status.BETWEEN) | dict.fromkeys(UNLIKE, Status.SLOWER)


def test_a_family_is_that_of_its_first_table_in_whatever_order_they_stand() -> None:
    last = len(pairs().tables) - 1
    due = [min(last - each for each, of_family in enumerate(pairs().families) if of_family == family)
           for family in pairs().families[::-1]]  # fmt: skip
    assert [*families_of(pairs().tables[::-1])] == due


@pytest.mark.parametrize(("change", "family"), [("mass", 1), ("float32 of the mass", 0), ("axles", 1), ("category", 1)])
def test_tables_for_another_cut_are_no_family(change: str, family: int) -> None:
    one = pairs().tables[0]
    mass, offsets = one.cut.mass_t, one.cut.axle_offsets_m
    cuts = {
        "mass": replace(one.cut, mass_t=mass + 1.0),
        "float32 of the mass": replace(one.cut, mass_t=mass * (1.0 + 1e-9)),
        "axles": replace(one.cut, axle_offsets_m=(*offsets, offsets[-1] + 1.5)),
        "category": replace(one.cut, category="С"),
    }
    assert families_of((one, replace(one, cut=cuts[change]))) == (0, family)


@pytest.mark.requirement("CHOICE-04")
def test_c_does_in_every_case(built: Built) -> None:
    controller = built(pairs())
    commands = np.array([(LIGHT, axles_of(name), BETWEEN_M_S) for name in CASES], COMMAND)
    found, words = controller.select(commands)
    own, own_words = choices_of(pairs(), commands)
    assert np.array_equal(found, own)
    assert np.array_equal(words, own_words)
    assert controller.self_test() == "fault 0 at 0"


def test_the_self_test_in_c_finds_every_wrong_family_whose_checksum_is_right(
    to_change: ToChange, tmp_path: Path
) -> None:
    export, where = to_change([sources_of(pairs(), SMALL)], "retarder_table.c"), places(pairs())
    for case in list(CASES)[:: sized(4, 1)]:
        number, family = wrong_family(case)
        words = held_words(pairs(), number)[:-1].copy()
        words[where["family_no"]] = family
        text = another(export.content, FAMILY, number, str(family))
        text = another(text, CRC32, number, f"{sealed(words)[-1]:08x}")
        (said,) = export.self_tests_of(text, tmp_path)
        assert said.stdout.startswith("fault 3 at "), case


def another(text: str, pattern: re.Pattern[str], number: int, value: str) -> str:
    """The text with the number of table `number` another one."""
    found = list(pattern.finditer(text))[number]
    assert found[1] != value
    return text[: found.start(1)] + value + text[found.end(1) :]


def test_the_pairs_are_what_they_say() -> None:
    """A member that may not differ does so in some pair, and in those of one family none does; a book has one clock."""
    record, where, book = held_record(pairs()), places(pairs()), pairs()
    seen = set()
    for place, name in enumerate(CASES):
        one, other = (held_words(book, 2 * place + index) for index in (0, 1))
        apart = {member for member, words in where.items() if (one[words] != other[words]).any()} - OWN
        assert name in UNLIKE or not apart
        seen |= apart
    assert seen == {*record.members} - OWN - {"category", "axles", "mass_t", "sample_period_s", "computing_delay_s"}


SLOWER_M_S, BETWEEN_M_S, FASTER_M_S = 2.0, 2.5, 3.0
LIGHT = 1
"""Number of the category Л."""

Change = Callable[[ControllerTable], ControllerTable]
TIMED = Decisions.AT_ANY_TIME


def at_rest(table: ControllerTable) -> ControllerTable:
    """The table without slopes that decides at rest."""
    stages = (replace(each, lower_slope_m_s_per_kpa=None, upper_slope_m_s_per_kpa=None) for each in table.stages)
    return replace(table, stages=tuple(stages), decisions=Decisions.AT_REST)


def last_bit(value: float) -> float:
    """The next float32 number above."""
    return float(np.nextafter(np.float32(value), np.float32(np.inf)))


def estimating(**changes: Any) -> Change:
    """The table with an estimator that differs from the usual one in this."""
    return lambda table: replace(table, estimator=replace(estimator_of(4, 37.45), **changes))


def in_last_bit(key: str, place: int | None = None) -> Change:
    """The usual estimator with the last bit of a number changed."""
    usual = getattr(estimator_of(4, 37.45), key)
    if place is None:
        return estimating(**{key: last_bit(usual)})
    return estimating(**{key: (*usual[:place], last_bit(usual[place]), *usual[place + 1 :])})


def pressed(kpa: float) -> Change:
    """The table with another pressure of its second stage."""

    def changed(table: ControllerTable) -> ControllerTable:
        first, second, *others = table.stages
        return replace(table, stages=(first, replace(second, pressure_kpa=kpa), *others))

    return changed


def valid(low: float, high: float) -> Change:
    """The table for another path."""
    return lambda table: replace(table, valid=ValidRange((low, high), table.valid.v_m_s))


def same(table: ControllerTable) -> ControllerTable:
    """The table itself."""
    return table


def unlined(table: ControllerTable) -> ControllerTable:
    """The table without the lower line of its second stage."""
    first, second, *others = table.stages
    return replace(table, stages=(first, replace(second, lower=None), *others))


def of_shape(stages: int, degree: int) -> Change:
    """A table of another shape for the same cut."""
    return lambda table: table_of(
        table.id, table.cut.category, table.cut.mass_t, table.cut.axle_offsets_m, table.target_speed_m_s, stages, degree
    )


def timed(table: ControllerTable) -> ControllerTable:
    """The table without a gauge that decides at any time."""
    return replace(table, decisions=TIMED)


def sloped(table: ControllerTable) -> ControllerTable:
    """The table with slopes."""
    return with_slopes(table, -0.001, -0.0012)


def approached(length_m: float, stage: int) -> Change:
    """The table with an approach."""
    return lambda table: with_approach(table, length_m, stage)


NEAR, USUAL = approached(4.0, 1), estimating()
LIKE: dict[str, tuple[Change, Change]] = {
    "equal": (same, same),
    "equal approaches": (NEAR, approached(4.0 + 1e-9, 1)),
    "equal estimators": (USUAL, estimating(touch_pressure_kpa=50.0 * (1.0 + 1e-9))),
    "the same 2 sigma^2 l": (USUAL, estimating(path_std=0.05, correlation_length_m=8.0)),
    "other slopes": (sloped, lambda table: with_slopes(table, -0.0015, -0.001)),
    "pressures less than a float32 apart": (sloped, lambda table: pressed(150.0 + 1e-7)(sloped(table))),
    "pressures that nobody looks at": (timed, lambda table: pressed(160.0)(timed(table))),
}
UNLIKE: dict[str, tuple[Change, Change]] = {
    "stages": (same, of_shape(4, 2)),
    "powers": (same, of_shape(5, 1)),
    "has_line": (same, unlined),
    "at_any_time": (same, timed),
    "at_any_time the other way": (timed, same),
    "path_min_m": (valid(-1.0, 37.45), valid(-1.0 - 2.0**-23, 37.45)),
    "path_min_m the other way": (valid(-1.0 - 2.0**-23, 37.45), valid(-1.0, 37.45)),
    "path_max_m": (valid(0.0, 37.45), valid(0.0, last_bit(37.45))),
    "entrance_stage": (NEAR, approached(4.0, 2)),
    "approach_m": (approached(4.0, 4), valid(-4.0, 37.45)),
    "breaks": (USUAL, lambda table: replace(table, estimator=estimator_of(5, 37.45))),
    "no estimator": (USUAL, same),
    "touch_kpa": (USUAL, in_last_bit("touch_pressure_kpa")),
    "speed_variance, leap_m_s": (USUAL, in_last_bit("speed_noise_m_s")),
    "factor_variance": (USUAL, in_last_bit("friction_cv")),
    "path_variance": (USUAL, in_last_bit("path_std")),
    "excess_variance": (USUAL, in_last_bit("resistance_std_m_s2")),
    "frozen": (USUAL, estimating(frozen_readings=7)),
    "doubted": (USUAL, estimating(doubted_readings=21)),
    "lost_variance, caution": (USUAL, in_last_bit("lost_speed_std_m_s")),
    "unlikely": (USUAL, in_last_bit("unlikely_deviation")),
    "place_m": (USUAL, in_last_bit("s_m", 1)),
    "drive": (USUAL, in_last_bit("drive_m2_s2", 3)),
    "brake": (USUAL, in_last_bit("brake_m2_s2_per_kpa", 3)),
    "has_gauge": (sloped, timed),
    "gauge and time": (sloped, same),
    "pressure_kpa": (sloped, lambda table: pressed(last_bit(150.0))(sloped(table))),
    "less pressure_kpa": (sloped, lambda table: pressed(140.0)(sloped(table))),
}
"""By the members of a table in which the two differ."""

CASES = {**LIKE, **UNLIKE}


def axles_of(case: str) -> int:
    """The number of axles that stands for `case`."""
    return 4 + list(CASES).index(case)


@cache
def pairs() -> TableBook:
    """A class of two targets for each case; the number of axles stands for the case."""
    tables = []
    for name, changes in CASES.items():
        offsets = tuple(1.5 * axle for axle in range(axles_of(name)))
        for target, changed in zip((SLOWER_M_S, FASTER_M_S), changes, strict=True):
            tables.append(changed(table_of(f"{name} {target}", "Л", 23.0, offsets, target, 5, 2)))
    return TableBook(tuple(tables))
