"""Aimed braking: claims that fail are told, and the kept result shows what the page says of S1."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from scripts.studies.aimed_braking.findings import AimedBraking
from scripts.studies.documents import result_of

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def kept() -> AimedBraking:
    found = result_of(ROOT, "aimed-braking").findings
    assert isinstance(found, AimedBraking)
    return found


def test_the_kept_result_holds_every_claim(kept: AimedBraking) -> None:
    assert kept.faults() == ()
    norms = {norm.name: norm.metres for norm in kept.norms}
    light, heavy, eight = (norms[name] for name in ("L, 1 car, category", "T, 1 car, category", "L, 8 cars, category"))
    assert light is not None
    assert heavy is not None
    assert 390.0 < light.ci95[0] < light.ci95[1] < 440.0
    assert heavy.ci95[0] > light.ci95[1] + 20.0
    assert eight is None or eight.ci95[0] > 700.0


def test_a_share_that_falls_is_told(kept: AimedBraking) -> None:
    first = kept.over_speeds[0]
    falling = replace(first, rows=first.rows[::-1])
    told = replace(kept, over_speeds=(falling, *kept.over_speeds[1:])).faults()
    assert told == (f"{first.category}, {first.metres:g} m: over-speed over gap is not monotone",)


def test_help_that_is_none_and_help_of_what_should_not_help_are_told(kept: AimedBraking) -> None:
    category, *_, best = kept.refined
    useless = replace(kept, refined=(category, replace(category, name="three control points")))
    far = sum(metres >= 500.0 for metres in category.metres)
    assert len(useless.faults()) == far
    assert useless.faults()[0].startswith("three control points, 500 m:")
    weight = replace(kept, refined=(category, replace(best, name="exact weight")))
    assert [told.split(",")[0] for told in weight.faults()] == ["exact weight"] * far


def test_the_first_row_of_the_sensitivity_is_the_distance_and_all_others_differences(kept: AimedBraking) -> None:
    rows = kept.tables()["sensitivity"].rows
    assert rows[0][3].startswith("414")
    assert all(row[3] == "0" or row[3][0] in "+-" for row in rows[1:])
    moved = {row[0] + row[2]: row[3] for row in rows}
    assert moved["exit of the position, m from the crest356"].startswith("+20")
    assert moved["Erlang order of bends1"] == "0"
