"""docs/reference/table-format.md, decisions at any time: its example, its answers and its text are right."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings

from tests.effort import sized
from tests.tuning_tables.random_tables import tables
from tests.tuning_tables.test_recursion_of_the_page import at_least, at_most
from tuning_tables import ControllerTable, decide_for, from_json, to_json
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


@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        ("pressure_kpa[0]", "pressure_kpa[1]"),
        ("pressure_kpa[h]", "pressure_kpa[-1]"),
        ("pressure_kpa[k]", "pressure_kpa[0]"),
        ("p - pressure", "p + pressure"),
        ("slope * above", "slope / above"),
        ("line + rise", "line - rise"),
        ("rise = 0", "rise = slope"),
        ("at_least(P", "at_most(P"),
        ("at_most(p", "at_least(p"),
    ],
)
def test_no_line_of_the_page_could_be_another(surface_table: ControllerTable, right: str, wrong: str) -> None:
    text = block("python")
    assert text.count(right) == 1
    with np.errstate(all="ignore"):
        assert not all(agreements(surface_table, text.replace(right, wrong)))
