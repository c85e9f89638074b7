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
    "smallest": (smallest_book, 58, 49),
    "default": (default_book, 83, 52),
    "measured": (sample_book, 91, 75),
    "estimated": (estimating_book, 91, 77),
    "surfaces": (surface_book, 90, 75),
    "pairs": (pairs, 96, 90),
}
"""Per cent of branches and of conditions (MC/DC) that are reached at least."""

DECLARED = (
    "same",
    "is_equal",
    "slower->",
    "alike(",
    "one >= other",
    "one <= other",  # two tables that differ there show it
    "*(const unsigned char *)&probe",  # the other order of bytes: shown under the emulation of a PowerPC
    "retarder_tables[number].",
    "slower < 0",
    "target > slower_m_s",
    "faster < 0",
    "target < faster_m_s",
    "status == RETARDER_BETWEEN",
    "faster >= 0",
    "`stage < ",
    "`side < ",
    "`power < ",
    "`i < ",
    "`j < ",  # classes of one target or one mass
    "(answer + before) == 0",  # two stages cannot turn
    "power > 0",
    "table->has_gauge == 1",  # constant lines; all tables between which there are others have a gauge
)
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
