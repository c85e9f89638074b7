"""docs/reference/table-format.md, decisions at sensor passages: its example, its steps and its text are right."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from scripts.format_page import updated
from tests.effort import sized
from tests.tuning_tables.passages.true_passes import LIMITS, tracking
from tuning_tables import PassageTable, from_json, to_json
from tuning_tables.passages.held_passages import held_by
from tuning_tables.programs.at_pulse import at_pulse
from tuning_tables.programs.passage_table import NONE
from tuning_tables.programs.tracker import begin_cut, believed_passage
from tuning_tables.table_kinds import KINDS

PAGE = (Path(__file__).parents[3] / "docs" / "reference" / "table-format.md").read_text(encoding="utf-8")
SECTION = PAGE.partition("## Decisions at sensor passages")[2].partition("## HDF5 book")[0]


def block(language: str) -> str:
    """The one block of code in `language` of the section."""
    (found,) = re.findall(rf"^```{language}\n(.*?)^```$", SECTION, re.MULTILINE | re.DOTALL)
    return str(found)


def example() -> PassageTable:
    return from_json(block("json").encode("utf-8"), PassageTable, source="the page")


def test_the_example_is_a_table_and_the_members_are_those_declared() -> None:
    assert to_json(example()) == block("json").encode("utf-8")
    assert PAGE.count("<!-- members: ") == len(KINDS)
    assert updated(PAGE) == PAGE


def test_the_worked_steps_are_those_of_the_code() -> None:
    table, state = example(), np.zeros(6, np.float32)
    begin_cut(state)
    held = held_by(table)
    steps = [row.split(" | ") for row in re.findall(r"^\| (\d.*\d) \|$", SECTION, re.MULTILINE)]
    assert len(steps) == 7
    for since, sensor, over, speed, heard, passage, stage, wanted in steps:
        v = float(np.float32(0.2) / np.float32(float(over)))
        assert f"{v:.3f}" == speed
        copy = state.copy()
        found = believed_passage(held, copy, int(sensor), float(since), v)
        assert found == (NONE if heard == "none" else int(heard))
        decided = NONE if found == NONE else int(held.deciding[found])
        assert decided == (NONE if passage == "none" else int(passage))
        assert at_pulse(held, state, int(sensor), float(since), float(over), int(stage), True) == int(wanted)


@given(st.floats(0.0, 20.0), st.floats(0.4, 14.9), st.floats(0.4, 14.9), st.floats(0.0, 60.0))
@settings(derandomize=True, max_examples=sized(75, 300), deadline=None)
def test_what_follows_is_what_the_page_computes(elapsed: float, before: float, now: float, way: float) -> None:
    a, d, e, f = (np.float32(limit) for limit in LIMITS[2:])
    # Written numbers are float32 numbers; numpy keeps them so beside float32 operands.
    names: dict[str, Any] = {"u": np.float32(before), "v": np.float32(now), "T": np.float32(elapsed)}
    names |= {"a": a, "d": d, "e": e, "f": f, "s_p": np.float32(way), "s_h": np.float32(0.0)}
    exec(block("python"), names)
    state = np.array([0.0, before, elapsed, NONE, 0.0, 0.0], np.float32)
    found = believed_passage(tracking(np.array([0.0, way]), np.array([0, 1])), state, 1, 0.0, now)
    assert (found == 1) == bool(names["follows"])
