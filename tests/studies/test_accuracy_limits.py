"""The rules of the accuracy grid: each limit is met at its edge and missed just beyond it."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from synth.studies.accuracy_grid.figures import Errors, Figures, GridCase
from synth.studies.accuracy_grid.findings import Grid
from synth.studies.accuracy_grid.limits import limits


def errors(rms: float, switchings: float = 1.0, spread: float = 0.01) -> Errors:
    return Errors(rms, (rms * (1.0 - spread), rms * (1.0 + spread)), switchings)


RMS = 0.0625
"""m/s; three times as much is exact."""

GOOD = Figures(
    table=errors(RMS),
    estimated=errors(RMS),
    baselines={"worse": errors(4.0 * RMS, 9.0), "best": errors(3.0 * RMS)},
    told=errors(RMS),
    told_estimated=errors(RMS),
    predicted_rms_m_s=RMS,
    estimated_predicted_rms_m_s=RMS,
    ratio=0.8,
    ratio_ci95=(0.7, 0.9),
    table_s=1.0,
    estimated_s=1.0,
)


def case(figures: Figures | None = GOOD, cv: float = 0.15) -> GridCase:
    return GridCase("case", cv, 2.0, figures is not None, 0.05, figures)


def missed(*cases: GridCase, minutes: float = 15.0) -> list[str]:
    return [each.asked for each in limits(cases, minutes) if not each.met]


def test_what_is_good_enough_misses_nothing() -> None:
    assert missed(case(), case(None)) == []
    assert len(limits([case()], 1.0)) == 14


@pytest.mark.parametrize(
    ("change", "asked"),
    [
        ({"told": errors(RMS / 1.21)}, ["regret: median"]),
        ({"told": errors(RMS / 1.19)}, []),
        ({"told": errors(RMS / 0.989)}, ["regret: median"]),
        ({"told": errors(RMS / 0.991)}, []),
        ({"told_estimated": errors(RMS / 1.11)}, ["regret, with estimator"]),
        ({"told_estimated": errors(RMS / 1.09)}, []),
        ({"predicted_rms_m_s": RMS * 1.1 * 1.011}, ["predicted / simulated:"]),
        ({"predicted_rms_m_s": RMS * 0.9 * 0.989}, ["predicted / simulated:"]),
        ({"predicted_rms_m_s": RMS * 1.1 * 1.009}, []),
        ({"predicted_rms_m_s": RMS * 0.9 * 0.991}, []),
        ({"estimated_predicted_rms_m_s": RMS * 1.2}, ["predicted / simulated, with"]),
        ({"baselines": {"best": errors(2.99 * RMS)}}, ["rms of the best baseline / table"] * 2),
        ({"table": errors(RMS, 1.001)}, ["switchings not more"]),
        ({"estimated": errors(RMS, 1.001)}, ["switchings, with estimator not more"]),
        ({"ratio_ci95": (1.0001, 1.1)}, ["with the estimator no case worse"]),
        ({"ratio_ci95": (1.0, 1.1)}, []),
        ({"table_s": 1.01}, ["one table: "]),
        ({"estimated_s": 1.01}, ["one table, with estimator: "]),
    ],
)
def test_a_limit_is_missed_just_beyond_its_edge(change: dict[str, Any], asked: list[str]) -> None:
    found = missed(case(replace(GOOD, **change)))
    assert [each.startswith(word) for each, word in zip(found, asked, strict=True)] == [True] * len(asked)


def test_the_worst_case_counts_as_well_as_the_median() -> None:
    bad = replace(GOOD, told=errors(RMS / 1.61), told_estimated=errors(RMS / 1.31))
    assert missed(case(), case(), case(bad)) == [
        "regret: median ≤ 1.2, worst ≤ 1.6, least ≥ 0.99",
        "regret, with estimator: median ≤ 1.1, worst ≤ 1.3, least ≥ 0.99",
    ]  # fmt: skip
    # the other figures stay in proportion, so that only the rms is beyond its limit
    scaled = replace(
        GOOD, table=errors(0.101), told=errors(0.09), predicted_rms_m_s=0.101,
        baselines={"best": errors(0.31)},
    )  # fmt: skip
    assert missed(case(), case(), case(scaled)) == ["rms at CV 0.15: median ≤ 0.07, worst ≤ 0.1 m/s"]
    assert missed(case(), case(), case(scaled, cv=0.25)) == []


def test_time_and_an_empty_grid_are_told() -> None:
    assert missed(case(), minutes=15.1) == ["the whole grid on two cores: ≤ 15 min"]
    assert missed(case(None)) == ["a case that is served"]


def test_what_is_not_met_is_bold_and_a_fault() -> None:
    grid = Grid(1, 200, 20.0, (case(), case(None)))
    assert [row for row in grid.tables()["limits"].rows if "not met" in row[1]] == [
        ("the whole grid on two cores: ≤ 15 min", "**20.0 min: not met**")
    ]
    assert grid.faults() == ("not met: the whole grid on two cores: ≤ 15 min; found 20.0 min",)
    assert grid.sentences()[0].startswith("1 of 2 cases")
