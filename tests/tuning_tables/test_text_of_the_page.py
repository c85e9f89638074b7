"""docs/reference/table-format.md states surfaces and the estimator: its example and its texts, run as they stand,
are right.

Nothing here knows the estimator of this project: the filter is what the page says, the numbers are those of the JSON
file, the tracks those of the exported CSV file.
"""

from __future__ import annotations

import csv
import io
import json
import re
from collections.abc import Iterator
from dataclasses import replace
from itertools import groupby
from pathlib import Path
from random import Random
from types import CodeType
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings

from tests.checker.test_estimator import random_estimator
from tests.controller_code.sample_book import approaching_book, estimating_book
from tests.effort import sized
from tests.tuning_tables.random_tables import tables
from tuning_tables import ControllerTable, TableBook, decide_for, from_json, to_json
from tuning_tables.exports import c_files
from tuning_tables.golden_vectors import golden_vectors, line_speeds
from tuning_tables.rule import rises_at

PAGE = (Path(__file__).parents[2] / "docs" / "reference" / "table-format.md").read_text(encoding="utf-8")
SECTION = PAGE.partition("\n## Decisions at any time")[2].partition("\n## ")[0]
ANSWERS = {"lower": -1, "hold": 0, "raise": 1}


def block(language: str) -> str:
    """The one block of code in `language` of the section."""
    (found,) = re.findall(rf"^```{language}\n(.*?)^```$", SECTION, re.MULTILINE | re.DOTALL)
    return str(found)


def test_the_example_is_a_table() -> None:
    example = from_json(block("json").encode("utf-8"), source="the page")
    assert to_json(example) == block("json").encode("utf-8")
    assert example.has_gauge


def test_the_worked_answers_are_those_of_the_rule() -> None:
    example = from_json(block("json").encode("utf-8"), source="the page")
    rows = [row.split(" | ") for row in re.findall(r"^\| (\d.*) \|$", SECTION, re.MULTILINE)]
    assert len(rows) == 11
    assert {row[-1] for row in rows} == set(ANSWERS)
    for stage, s, v, pressure, lower, upper, answer in rows:
        kpa = float("nan") if pressure == "silent" else float(pressure)
        assert decide_for(example, int(stage), float(s), float(v), kpa) == int(stage) + ANSWERS[answer]
        rise = rises_at(example, int(stage), np.array(kpa))
        for side, told in enumerate((lower, upper)):
            assert (told == "–") == (not example.has_line[int(stage), side])
            if told != "–":
                line = line_speeds(example.coefficients[int(stage), side], np.array([s], np.float32))
                assert float(line[0] + rise[side]) == float(told)


def surface_of_the_page(
    text: Any, table: ControllerTable, stage: int, side: int, s: np.float32, kpa: np.float32
) -> np.float32:
    """The surface as the page computes it from a line, with what the JSON of the table says."""
    slope = table.stages[stage].slopes[side]
    names: dict[str, Any] = {
        "P": kpa,
        "pressure_kpa": [np.float32(each.pressure_kpa) for each in table.stages],
        "h": min(each.k for each in table.stages if each.upper is None),
        "k": stage,
        "slope": np.float32(slope),
        "line": line_speeds(table.coefficients[stage, side], np.array([s], np.float32))[0],
        "at_least": at_least,
        "at_most": at_most,
        "isfinite": np.isfinite,
    }
    exec(text, names)
    return np.float32(names["surface"])


def agreements(table: ControllerTable, text: str) -> Iterator[bool]:
    """Whether the text gives the answer of each golden vector at a stage with slopes, on a credible path and speed."""
    golden, compiled = golden_vectors(table), compile(text, "page", "exec")
    chosen = np.random.default_rng(0).permutation(len(golden))[:800]
    for k, s, v, kpa, answer in zip(
        *(each[chosen] for each in (golden.stage, golden.s_m, golden.v_m_s, golden.pressure_kpa, golden.answer)),
        strict=True,
    ):
        if not (0 <= k < len(table.stages) and np.isfinite(s) and np.isfinite(v) and v >= 0):
            continue
        path = min(max(s, table.valid_range[0]), table.valid_range[1])
        due = 0
        if table.has_line[k, 1] and not (path < 0 and k >= table.entrance_stage):
            due = int(v > surface_of_the_page(compiled, table, k, 1, path, kpa))
        if table.has_line[k, 0] and v < surface_of_the_page(compiled, table, k, 0, path, kpa):
            due = -1
        yield k + due == answer


def test_the_text_of_the_page_gives_the_golden_answers(surface_table: ControllerTable) -> None:
    for table in (surface_table, from_json(block("json").encode("utf-8"))):
        found = list(agreements(table, block("python")))
        assert len(found) > 250
        assert all(found)


@given(tables().filter(lambda table: table.has_gauge and table.target_speed_m_s < 1e6))
@settings(derandomize=True, max_examples=sized(5, 10), deadline=None, suppress_health_check=list(HealthCheck))
def test_the_text_of_the_page_holds_for_tables_of_every_shape(table: ControllerTable) -> None:
    assert all(agreements(table, block("python")))


FORMAT_PAGE = Path(__file__).parents[2] / "docs" / "reference" / "table-format.md"
STATE = (
    "begun", "s", "v", "xi", "x", "P11", "P12", "P13", "P22", "P23", "P33", "unseen", "reading", "repeated", "count",
    "doubted",
)  # fmt: skip
READINGS = {"path": "s_m_bits", "speed": "v_m_s_bits", "overpressure": "overpressure_kpa_bits"}

Row = dict[str, str]


def blocks_of_the_page() -> tuple[str, str]:
    """The text of one sample, and that of D and W at a place."""
    section = FORMAT_PAGE.read_text("utf-8").split("### The recursion\n")[1].split("\n### ")[0]
    sample, place = re.findall(r"```python\n(.*?)```", section, re.DOTALL)
    return sample, place


def at_least(x: Any, m: Any) -> Any:
    """As the page defines it."""
    return m if x < m else x


def at_most(x: Any, m: Any) -> Any:
    """As the page defines it."""
    return m if x > m else x


class Filter:
    """The recursion of the page for one table; `sample` and `place` are its compiled blocks."""

    def __init__(self, estimator: dict[str, Any], sample: CodeType, place: CodeType) -> None:
        self._sample, self._place = sample, place
        noise, cv, std = (estimator[key] for key in ("speed_noise_m_s", "friction_cv", "path_std"))
        numbers = {"R": noise * noise, "X": cv * cv, "Y": 2.0 * (std * std) * estimator["correlation_length_m"]}
        excess, lost = estimator["resistance_std_m_s2"], estimator["lost_speed_std_m_s"]
        numbers |= {"Z": excess * excess, "L": 5.0 * 2.0**0.5 * noise, "lost": lost * lost, "caution": 0.5 / lost}
        numbers |= {"frozen": estimator["frozen_readings"], "long": estimator["doubted_readings"]}
        numbers |= {"unlikely": estimator["unlikely_deviation"]}
        self._s_m = np.array(estimator["s_m"], np.float32)
        self._names: dict[str, Any] = {name: np.float32(value) for name, value in numbers.items()}
        self._names |= {"s_m": self._s_m, "last": len(self._s_m) - 1, "at_least": at_least, "at_most": at_most}
        for name, key in (("D", "drive_m2_s2"), ("W", "brake_m2_s2_per_kpa")):
            self._names[name] = self._work(np.array(estimator[key], np.float32))
        self.begin()

    def _work(self, row: Any) -> Any:
        def at(place: Any) -> Any:
            names = {**self._names, "row": row, "place": place}
            exec(self._place, names)
            return names["value"]

        return at

    def begin(self) -> None:
        """A new cut."""
        self._names |= {name: np.float32(0.0) for name in STATE}

    def observe(self, readings: dict[str, np.float32]) -> tuple[np.float32, int, int]:
        """The answer, for how many samples no reading was believed, and the alarm word."""
        self._names |= readings
        exec(self._sample, self._names)
        return np.float32(self._names["answer"]), int(self._names["unseen"]), int(self._names["alarms"])


def number_of(bits: str) -> np.float32:
    """The float32 number of these bits."""
    return np.float32(np.array([int(bits, 16)], np.uint32).view(np.float32)[0])


def tracks_of(book: TableBook) -> Iterator[tuple[int, list[Row]]]:
    """(number of the table, samples) of every golden track of a table with an estimator."""
    text = c_files(book)["golden_tracks.csv"].decode("utf-8")
    for (_, table), rows in groupby(csv.DictReader(io.StringIO(text, newline="")), lambda r: (r["track"], r["table"])):
        if book.tables[int(table)].estimator is not None:
            yield int(table), list(rows)


def agreeing_tracks(book: TableBook, tracks: list[tuple[int, list[Row]]], sample: str, place: str) -> Iterator[bool]:
    """Whether the page gives answer and count of each sample of the golden tracks of `book`, to the bit."""
    compiled = compile(sample, "page", "exec"), compile(place, "page", "exec")
    for number, rows in tracks:
        filtered = Filter(json.loads(to_json(book.tables[number]))["estimator"], *compiled)
        for row in rows:
            with np.errstate(all="ignore"):
                readings = {name: number_of(row[column]) for name, column in READINGS.items()}
                answer, unseen, alarms = filtered.observe(readings)
            due = number_of(row["estimate_m_s_bits"])
            same = answer.tobytes() == due.tobytes() or bool(np.isnan(answer) and np.isnan(due))
            yield same and (unseen, alarms) == (int(row["unseen_samples"]), int(row["alarms"]))


def odd_book() -> TableBook:
    """Two dozen estimators: steep, flat, absurd work, breaks a millimetre to metres apart, noise over decades."""
    base, chance = estimating_book().tables[0], Random(12)
    return TableBook(
        tuple(
            replace(base, id=f"{n}", target_speed_m_s=2.0 + 0.01 * n, estimator=random_estimator(chance))
            for n in range(24)
        )
    )


@pytest.mark.requirement("EST-01")
@pytest.mark.parametrize("book", [estimating_book, approaching_book, odd_book])
def test_the_page_gives_every_bit_of_the_golden_tracks(book: Any) -> None:
    made = book()
    found = list(agreeing_tracks(made, list(tracks_of(made)), *blocks_of_the_page()))
    assert len(found) > 1000
    assert all(found)
