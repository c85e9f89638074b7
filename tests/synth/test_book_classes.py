"""The book that a file names: refused in one sentence where it is of another position or fits no class."""

from __future__ import annotations

from pathlib import Path

import pytest

from synth.frame.input_error import InputError
from synth.retarder.book_classes import book_classes
from synth.simulation.controllers import TableController
from tests.synth.hump.trains.coarse_book import PARK, coarse_classes
from tuning_tables import ControllerTable, write_book


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two tables of one class, one alone, and the configuration of all."""
    made, (single, pair) = tmp_path_factory.mktemp("book"), coarse_classes()
    (made / "coarse.toml").write_text(PARK, encoding="utf-8")
    for name, of_class, count in (("two.h5", single, 2), ("one.h5", pair, 1)):
        tables = [c.table for c in of_class.controllers[:count] if isinstance(c, TableController)]
        write_book([table for table in tables if isinstance(table, ControllerTable)], made / name)
    return made


def test_a_book_is_read_with_its_configuration(folder: Path) -> None:
    (single,) = book_classes("h.toml: book", folder / "two.h5", folder / "coarse.toml", "rnz-2m-park")
    assert single.targets_m_s == (1.5, 2.0)
    assert single.plant.cut.mass_t == 25.0
    assert single.loops[0].plant is single.plant


def test_a_book_that_does_not_fit_is_refused(folder: Path) -> None:
    other = "two.h5, whose table .* is for the position rnz-2m-park, but position is knp-5-bunch; give a book of that"
    with pytest.raises(InputError, match=f"h.toml: retarder 401: book names .*{other}"):
        book_classes("h.toml: retarder 401: book", folder / "two.h5", folder / "coarse.toml", "knp-5-bunch", "position")
    with pytest.raises(InputError, match=r"h.toml: book names .*one.h5, which does not fit: .* 1 targets"):
        book_classes("h.toml: book", folder / "one.h5", folder / "coarse.toml", "rnz-2m-park")
    with pytest.raises(InputError, match="no cut class fits the table"):
        book_classes("h.toml: book", folder / "two.h5", None, "rnz-2m-park")
