"""What the self-tests reach of the exported C by branches and MC/DC: all but what is declared, with the reason.

Every place that is not reached is declared, and what is declared is not reached in some export.
"""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Mapping
from functools import cache
from pathlib import Path

import pytest

from scripts.studies.in_the_loop.code_coverage import Coverage, coverage_of, mcdc_release
from tests.controller_code.sample_book import FOUR_AXLES, estimating_book, sample_book, surface_book, table_of
from tests.controller_code.unlike_pairs import pairs
from tuning_tables import from_json
from tuning_tables.c_source import c_files
from tuning_tables.table_book import TableBook

DEFAULT = Path(__file__).parents[1] / "tuning_tables" / "st" / "default_book"


def default_book() -> TableBook:
    """The built-in book: neither estimators nor approaches nor gauges."""
    return TableBook(tuple(from_json(path.read_bytes()) for path in sorted(DEFAULT.glob("*.json"))))


def smallest_book() -> TableBook:
    """Two stages, constant lines, one table."""
    return TableBook((table_of("constant", "СТ", 66.0, FOUR_AXLES, 3.0, stages=2, degree=0),))


EXPORTS: Mapping[str, Callable[[], Mapping[str, bytes]]] = {
    "smallest": lambda: c_files(smallest_book()),
    "default": lambda: c_files(default_book()),
    "measured": lambda: c_files(sample_book()),
    "estimated": lambda: c_files(estimating_book()),
    "surfaces": lambda: c_files(surface_book()),
    "pairs": lambda: c_files(pairs()),
}

RESTS: Mapping[str, tuple[str, ...]] = {
    "The other order of bytes is that of other processors; it is shown under the emulation of a PowerPC.": (
        "*(const unsigned char *)&probe",
    ),
    "The choice goes through the tables of the book, and no class of this one has such masses and targets.": (
        ".mass_t >", "slower < 0", "target > slower_m_s", "faster < 0", "target < faster_m_s", "`faster >= 0`",
        "status == RETARDER_BETWEEN",
    ),
    "The choice asks for what lies between two tables only where the speed lies between their targets.": (
        "table->target_m_s < commanded_m_s", "commanded_m_s < faster->target_m_s", "table->family == faster->family &&",
    ),
    "All neighbours in this book are of one family.": (
        "`table->family == faster->family` is never false", "`is_between`", "`blend(",
    ),
    "All lines of this book are constants.": ("`power > 0`",),
    "With two stages no command can turn.": ("(answer + before) == 0",),
}  # fmt: skip
"""Why an export may not reach places, and what these hold; all else every export reaches."""


@cache
def measured(name: str) -> Coverage | None:
    """What the self-test of an export reaches; None without a compiler that tells."""
    release = mcdc_release()
    if release is None:
        return None
    with tempfile.TemporaryDirectory() as folder:
        return coverage_of(EXPORTS[name](), Path(folder), release)


@pytest.mark.parametrize("name", EXPORTS)
def test_what_is_not_reached_is_declared(name: str) -> None:
    found = measured(name)
    if found is None:
        pytest.skip("no clang from 18 on that measures MC/DC is installed")
    declared = [part for parts in RESTS.values() for part in parts]
    assert [each for each in found.rest if not any(part in each for part in declared)] == [], str(found)


def test_what_is_declared_is_not_reached_somewhere() -> None:
    found = [measured(name) for name in EXPORTS]
    rest = [each for coverage in found if coverage is not None for each in coverage.rest]
    if None in found:
        pytest.skip("no clang from 18 on that measures MC/DC is installed")
    assert [part for parts in RESTS.values() for part in parts if not any(part in each for each in rest)] == []
