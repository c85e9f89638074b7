"""What the self-test reaches of retarder_table.c by branches and MC/DC, and every place of the rest is declared."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from scripts.studies.in_the_loop.code_coverage import coverage_of, mcdc_release
from tests.controller_code.sample_book import FOUR_AXLES, estimating_book, sample_book, surface_book, table_of
from tests.controller_code.unlike_pairs import pairs
from tuning_tables import from_json
from tuning_tables.table_book import TableBook

DEFAULT = Path(__file__).parents[1] / "tuning_tables" / "st" / "default_book"


def default_book() -> TableBook:
    """The built-in book: neither estimators nor approaches nor gauges."""
    return TableBook(tuple(from_json(path.read_bytes()) for path in sorted(DEFAULT.glob("*.json"))))


def smallest_book() -> TableBook:
    """Two stages, constant lines, one table."""
    return TableBook((table_of("constant", "СТ", 66.0, FOUR_AXLES, 3.0, stages=2, degree=0),))


LEAST: dict[str, tuple[Callable[[], TableBook], int, int]] = {
    "smallest": (smallest_book, 50, 32),
    "default": (default_book, 77, 38),
    "measured": (sample_book, 86, 61),
    "estimated": (estimating_book, 88, 68),
    "surfaces": (surface_book, 88, 69),
    "pairs": (pairs, 93, 80),
}
"""Per cent of branches and of conditions (MC/DC) that are reached at least."""

DECLARED = (
    "same", "is_equal", "alike", "one >= other", "one <= other",  # only two tables that differ there show it
    "*(const unsigned char *)&probe",  # the other order of bytes: shown under the PowerPC emulation
    "slower >= 0 && 0.0f < commanded_m_s", "0.0f < commanded_m_s",  # no table aims at 0 or less
    "<= table->", "table->stages <=", "table->powers <=", "table->breaks <=", "0 <= stage &&", "2 <= table->breaks",
    "answer == 0 ||", "after < 0", "after >=", "(answer + before)",  # damaged tables
    "table_crc32(table) == table->crc32", "table != 0 &&",
    "table->at_any_time == 1", "table->has_gauge == 1", "table->has_line", "answer == 0 && table->has_line",
    "s >= 0.0f", "stage < table->entrance_stage",  # no table of the book is of this kind
    "retarder_tables[number].mass_t", "slower < 0 ||", "target > slower_m_s", "faster < 0 ||", "target < faster_m_s",
    "status == RETARDER_BETWEEN", "faster >= 0", "slower->", "v < lower", "v > upper", "slower_m_s >=", "slower >= 0",
    "power > 0", "target <= commanded_m_s",
)  # fmt: skip
"""How the places begin, or what they hold, that a book may not reach; all else every book does."""


@pytest.mark.parametrize("name", LEAST)
def test_what_is_not_reached_is_declared(name: str, tmp_path: Path) -> None:
    release = mcdc_release()
    if release is None:
        pytest.skip("no clang from 18 on that measures MC/DC is installed")
    make, branches, conditions = LEAST[name]
    found = coverage_of(make(), tmp_path, release)
    assert [each for each in found.rest if not any(part in each for part in DECLARED)] == []
    assert 100 * found.branches[0] >= branches * found.branches[1], str(found)
    assert 100 * found.conditions[0] >= conditions * found.conditions[1], str(found)
