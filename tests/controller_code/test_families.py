"""Lines between two targets are taken only of tables of one family: they differ in nothing but target and lines.

Every pair of `unlike_pairs` is asked of Python, of C and of the checker; a family that is wrong in an export is found.
"""

from __future__ import annotations

import re
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from scripts.studies.in_the_loop.agreement import choices_of
from scripts.studies.in_the_loop.controller_process import COMMAND, sources_of
from scripts.studies.in_the_loop.held_words import held_record, held_words, places, sealed
from synth.checker.code_export import c_differences, st_differences
from synth.checker.code_file import LINES
from synth.checker.line_numbers import due_of_lines, held_of
from synth.checker.table_reading import Table, read_table
from tests.controller_code.conftest import Built, ToChange
from tests.controller_code.unlike_pairs import BETWEEN_M_S, CASES, LIGHT, LIKE, UNLIKE, axles_of, pairs
from tests.effort import sized
from tests.st_files import st_files
from tuning_tables import Status, to_json
from tuning_tables.book_families import families_of
from tuning_tables.c_source import c_files
from tuning_tables.self_test_size import SMALL
from tuning_tables.st_source import TABLE_FILE

OWN = {"family_no", "target_m_s", "coefficient", "slope"}
"""The number of the family, and the members in which two of its tables may differ."""

FAMILY = re.compile(r"(\d+), /\* family_no \*/")
CRC32 = re.compile(r"0x([0-9a-f]{8})u /\* crc32 \*/")
FAMILIES = re.compile(r"FamilyNoOf : ARRAY\[\S+ OF INT := \[(.*?)\];", re.DOTALL)


@cache
def read_pairs() -> tuple[Table, ...]:
    """The pairs as the checker reads them."""
    return tuple(read_table(to_json(table)) for table in pairs().tables)


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


@pytest.mark.long
def test_the_checker_finds_the_same_families_and_every_wrong_one() -> None:
    tables, files = read_pairs(), {**c_files(pairs(), self_test=SMALL), **st_files(pairs(), self_test=SMALL)}
    assert [family for each in held_of(tables) for family in each["familyno"]] == [*pairs().families]
    source, header, text = (files[name].decode() for name in ("retarder_table.c", "retarder_table.h", TABLE_FILE))
    (column,) = FAMILIES.finditer(text)
    for case in list(CASES)[:: sized(4, 1)]:
        number, family = wrong_family(case)
        families = column[1].split(",")
        families[number] = str(family)
        st = text[: column.start(1)] + ",".join(families) + text[column.end(1) :]
        c = another(source, FAMILY, number, str(family))
        told = f"familyno of table {number} is {family}, but the table says {float(pairs().families[number])}"
        assert [each for _, each in st_differences(st, "RETARDER", LINES, due_of_lines(tables))] == [told], case
        assert told in [each for _, each in c_differences(c, header, "RETARDER", LINES, due_of_lines(tables))], case


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
