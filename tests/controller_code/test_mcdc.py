"""What the self-tests reach of the exported C by branches and MC/DC: all but what is declared, with the reason.

Every place that is not reached is declared, and every place that is declared is not reached.
"""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Mapping
from functools import cache
from pathlib import Path
from typing import NamedTuple

import pytest

from scripts.studies.in_the_loop.code_coverage import Coverage, coverage_of, mcdc_release
from tests.controller_code.passage_tables import every_axle_book, passage_book, passage_table
from tests.controller_code.sample_book import FOUR_AXLES, estimating_book, sample_book, surface_book, table_of
from tests.controller_code.unlike_pairs import pairs
from tests.tuning_tables.aim.hard_questions import sample_set
from tests.tuning_tables.aim.made_tables import category_table
from tuning_tables import from_json
from tuning_tables.aim import AimTables
from tuning_tables.aim.c_source import aim_c_files
from tuning_tables.c_correction import correction_c_files
from tuning_tables.c_source import c_files
from tuning_tables.correction import Correction
from tuning_tables.passages.c_source import passage_c_files
from tuning_tables.passages.passage_book import PassageBook
from tuning_tables.table_book import TableBook

PAGE = Path(__file__).parents[2] / "docs" / "reference" / "code-checks.md"
DEFAULT = Path(__file__).parents[1] / "tuning_tables" / "st" / "default_book"


def default_book() -> TableBook:
    """The built-in book: neither estimators nor approaches nor gauges."""
    return TableBook(tuple(from_json(path.read_bytes()) for path in sorted(DEFAULT.glob("*.json"))))


def smallest_book() -> TableBook:
    """Two stages, constant lines, one table."""
    return TableBook((table_of("constant", "СТ", 66.0, FOUR_AXLES, 3.0, stages=2, degree=0),))


def one_sensor_book() -> PassageBook:
    """Two stages, two axles over one sensor."""
    return PassageBook((passage_table(stages=2, places_m=(-4.0,), axles=(0.0, 1.85)),))


EXPORTS: Mapping[str, Callable[[], Mapping[str, bytes]]] = {
    "smallest": lambda: c_files(smallest_book()),
    "default": lambda: c_files(default_book()),
    "measured": lambda: c_files(sample_book()),
    "estimated": lambda: c_files(estimating_book()),
    "surfaces": lambda: c_files(surface_book()),
    "pairs": lambda: c_files(pairs()),
    "passages": lambda: passage_c_files(passage_book()),
    "every axle": lambda: passage_c_files(every_axle_book()),
    "one sensor": lambda: passage_c_files(one_sensor_book()),
    "aims": lambda: aim_c_files(sample_set()),
    "aims by category": lambda: aim_c_files(AimTables((category_table(),))),
    "correction": lambda: correction_c_files(Correction(0.12, 0.06)),
}


class Rest(NamedTuple):
    """Why places are not reached in some exports, and what each of these places holds."""

    why: str
    exports: tuple[str, ...]
    places: tuple[str, ...]


LINES = ("smallest", "default", "measured", "estimated", "surfaces", "pairs")
ONE_TABLE = ("smallest", "every axle", "one sensor")
RESTS = (
    Rest("The other order of bytes is that of other processors; it is shown under the emulation of a PowerPC.",
         tuple(EXPORTS), ("*(const unsigned char *)&probe",)),
    Rest("No class of this book has two targets.", ONE_TABLE,
         (".mass_t > heaviest` is never false", ".mass_t >= heaviest`", "slower < 0", "faster < 0", "faster >= 0",
          "target > slower_m_s", "target < faster_m_s", "status == RETARDER_BETWEEN")),
    Rest("In this book the tables of a class stand by rising target.", ("default", "pairs", "passages"),
         ("slower < 0 || target > slower_m_s", "`target > slower_m_s` is never false",
          "faster < 0 || target < faster_m_s", "`target < faster_m_s` is never true")),
    Rest("No table of this book has a lighter one of its class behind it.", ("default", "pairs"),
         (".mass_t >= heaviest` is never false",)),
    Rest("The choice asks for what lies between two tables only where the speed lies between their targets.", LINES[1:],
         ("table->family_no == faster->family_no &&", "`table->target_m_s < commanded_m_s` is never false",
          "`commanded_m_s < faster->target_m_s` is never false")),
    Rest("All neighbours in this book are of one family.", ("default",),
         ("`table->family_no == faster->family_no` is never false", "`is_between` is never false", "`blend(")),
    Rest("All lines of this book are constants.", ("smallest",), ("`power > 0` is never true",)),
    Rest("With two stages no command can turn.", ("smallest",), ("(answer + before) == 0",)),
    Rest("Two passages, both over one sensor: there is none before or behind to be taken instead.", ("one sensor",),
         ("found == -1", "table->sensor[met] == sensor")),
    Rest("By category there is one resistance.", ("aims by category",),
         ("node < table->resistances", "resistance >= table->resistance_n_per_kn[node]",
          "lower < (table->resistances - 1)", "resistance > table->resistance_n_per_kn[lower]")),
)  # fmt: skip
"""All that the self-tests do not reach."""


@cache
def measured(name: str) -> Coverage | None:
    """What the self-test of an export reaches; None without a compiler that tells."""
    release = mcdc_release()
    if release is None:
        return None
    with tempfile.TemporaryDirectory() as folder:
        return coverage_of(EXPORTS[name](), Path(folder), release)


@pytest.mark.long
@pytest.mark.parametrize("name", EXPORTS)
def test_what_is_not_reached_is_declared_and_what_is_declared_is_not_reached(name: str) -> None:
    found = measured(name)
    if found is None:
        pytest.skip("no clang from 18 on that measures MC/DC is installed")
    places = [place for rest in RESTS if name in rest.exports for place in rest.places]
    assert [each for each in found.rest if not any(place in each for place in places)] == [], str(found)
    assert [place for place in places if not any(place in each for each in found.rest)] == [], str(found)


def test_the_page_tells_every_reason() -> None:
    page = " ".join(PAGE.read_text("utf-8").split())
    assert [rest.why for rest in RESTS if rest.why not in page] == []
