"""The study of rare over-speeds: methods that contradict one another are told, and each cell says what it knows."""

from __future__ import annotations

from dataclasses import replace

from synth.studies.rare_events.findings import (
    DENSITY,
    IMPORTANCE,
    PLAIN,
    CaseRow,
    HeavyTail,
    MethodTails,
    RareEvents,
    shown,
)
from synth.studies.rare_events.tail_probability import TailProbability

MARGINS = (0.2, 0.5)
TAIL = HeavyTail(1e-3, 0.4, 0.9, 0.03, 400.0, 0.1, 0.5)


def found(*tails: tuple[float, float, float]) -> RareEvents:
    """One case; the second margin of every method is the same."""
    methods = tuple(
        MethodTails(name, 1000, 1.0, (tail, (1e-4, 9e-5, 1.1e-4)))
        for name, tail in zip((PLAIN, IMPORTANCE), tails, strict=True)
    )
    row = CaseRow("case", 100, (1.0, 0.01), methods, 0.04, (0.03, 0.05), 0.04, (0.03, 0.05), 10.0, TAIL)
    return RareEvents("0", {"plain": 1}, MARGINS, MARGINS, 0.2, 20_000, (row,))


def test_methods_that_differ_beyond_chance_contradict() -> None:
    near = found((1.0e-3, 0.9e-3, 1.1e-3), (1.3e-3, 1.2e-3, 1.4e-3))  # 1.5 half widths apart
    assert near.faults() == ()
    far = found((1.0e-3, 0.9e-3, 1.1e-3), (1.4e-3, 1.3e-3, 1.5e-3))  # 2.0
    assert far.faults() == ("case, over 0.2 m/s: plain simulation and importance sampling differ, gap 2.00",)


def test_a_cell_tells_interval_limit_or_bound() -> None:
    tail = TailProbability(0.2, 8.75e-4, 8.18e-4, 9.35e-4, PLAIN, 10**6)
    assert shown(tail) == "8.75e-04 [8.18e-04, 9.35e-04]"
    assert shown(replace(tail, probability=0.0, low=0.0, high=3.7e-6)) == "< 3.7e-06"
    assert shown(replace(tail, method=DENSITY, probability=8.666e-4, high=8.736e-4)) == "8.666e-04 ± 7e-06"


def test_every_margin_has_its_row() -> None:
    rows = found((1.0e-3, 0.9e-3, 1.1e-3), (1.3e-3, 1.2e-3, 1.4e-3)).tables()["tails"].rows
    assert [row[:2] for row in rows] == [("case", "0.2"), ("case", "0.5")]
    assert rows[1][2] == rows[1][3] == "1.00e-04 [9.00e-05, 1.10e-04]"
