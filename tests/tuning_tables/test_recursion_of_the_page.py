"""docs/reference/table-format.md states the estimator: its text, run as it stands, gives every bit of the golden
tracks.

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

from tests.checker.test_estimator import random_estimator
from tests.controller_code.sample_book import approaching_book, estimating_book
from tuning_tables import TableBook, to_json
from tuning_tables.c_source import c_files

PAGE = Path(__file__).parents[2] / "docs" / "reference" / "table-format.md"
STATE = (
    "begun", "s", "v", "xi", "x", "P11", "P12", "P13", "P22", "P23", "P33", "unseen", "reading", "repeated", "count",
    "doubted",
)  # fmt: skip
READINGS = {"path": "s_m_bits", "speed": "v_m_s_bits", "overpressure": "overpressure_kpa_bits"}

Row = dict[str, str]


def blocks_of_the_page() -> tuple[str, str]:
    """The text of one sample, and that of D and W at a place."""
    section = PAGE.read_text("utf-8").split("### The recursion\n")[1].split("\n### ")[0]
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


def agreements(book: TableBook, tracks: list[tuple[int, list[Row]]], sample: str, place: str) -> Iterator[bool]:
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
    found = list(agreements(made, list(tracks_of(made)), *blocks_of_the_page()))
    assert len(found) > 1000
    assert all(found)


def test_no_line_of_the_page_could_be_left_out_or_turned_round() -> None:
    """Each operator and each limit changed in its turn gives other bits somewhere: the tracks would show a misprint.

    But for variances >= 0, which no track reaches: without rounding none can fall below.
    """
    book = estimating_book()
    tracks = list(tracks_of(book))
    sample, place = blocks_of_the_page()
    swapped = {"+": "-", "-": "+", "*": "/", "/": "*"}
    changes = [
        (match.start(), sample[: match.start(1)] + swapped[match[1]] + sample[match.end(1) :])
        for match in re.finditer(r" ([-+*/]) ", sample)
        if "#" not in sample[sample.rfind("\n", 0, match.start()) : match.start()]
    ]
    limits = {"0.2)": "0.3)", "0.001": "0.01", "0.3)": "0.4)", "1.9": "1.8", "+ 20": "+ 19", "<= 40": "< 40"}
    for right, wrong in {**limits, "<= 2000": "< 2000"}.items():
        changes.append((sample.index(right), sample.replace(right, wrong, 1)))
    missed = [sample[at - 20 : at + 20] for at, changed in changes if all(agreements(book, tracks, changed, place))]
    assert len(changes) > 40
    assert missed == []
