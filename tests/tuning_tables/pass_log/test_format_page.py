"""docs/reference/pass-log.md names every column, unit and attribute, and its examples read as it says."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from tuning_tables.pass_log.csv_log import FIRST_LINE, read_csv_log
from tuning_tables.pass_log.hdf5_columns import FORMAT
from tuning_tables.pass_log.log_columns import COLUMNS
from tuning_tables.pass_log.log_mapping import PATHS, UNITS, LogMapping, read_mapping

PAGE = (Path(__file__).parents[3] / "docs" / "reference" / "pass-log.md").read_text(encoding="utf-8")


def block(language: str) -> str:
    """The only block of the page in `language`."""
    (found,) = re.findall(rf"```{language}\n(.*?)```", PAGE, re.DOTALL)
    return str(found)


def test_every_column_is_named_with_what_it_is() -> None:
    section = PAGE.split("## Columns\n")[1].split("\n## ")[0]
    assert tuple(re.findall(r"^\| `(\w+)` \|", section, re.MULTILINE)) == COLUMNS
    stored = PAGE.split("## HDF5\n")[1].split("\n## ")[0]
    assert {*COLUMNS, "first_row", FORMAT} <= set(re.findall(r"`([\w-]+)`", stored))
    assert f"`{FIRST_LINE}independent`" in PAGE


def test_every_unit_is_named() -> None:
    mapping = block("toml")
    for units in UNITS.values():
        assert ", ".join(units) in mapping
    for word in PATHS:
        assert f'"{word}"' in mapping


def test_the_examples_are_read(tmp_path: Path) -> None:
    (tmp_path / "log.csv").write_text(block("text"), encoding="utf-8")
    columns = read_csv_log(tmp_path / "log.csv", LogMapping())
    assert (columns.rows, columns.cut_id.value, columns.category.value) == (3, ("2026-03-02/117",), ("СТ",))
    assert np.array_equal(columns.numbers["speed_m_s"], [5.31, 5.32, np.nan], equal_nan=True)
    (tmp_path / "mapping.toml").write_text(block("toml"), encoding="utf-8")
    foreign = "Nr;t [ms];Weg;v;Stufe;Gewicht\n117;1500,0;-10,0;36,0;1;66000\n"
    (tmp_path / "foreign.csv").write_text(foreign, encoding="utf-8")
    read = read_csv_log(tmp_path / "foreign.csv", read_mapping(tmp_path / "mapping.toml"))
    values = {name: float(column[0]) for name, column in read.numbers.items()}
    expected = {"time_s": 1.5, "path_m": -3.048, "speed_m_s": 10.0, "stage": 1.0, "mass_t": 66.0, "axles": 4.0}
    assert {name: round(values[name], 9) for name in expected} == expected
    assert (read.category.value, read.path_is_independent) == (("Т",), False)
