"""The study of a sweep's speed: rates by hand, the sweep it asks for, and what it calls a fault."""

from __future__ import annotations

from dataclasses import replace

import pytest

from synth.studies.sweep_speed.binding import Binding
from synth.studies.sweep_speed.findings import SweepSpeed, UnitRow
from synth.studies.sweep_speed.study import text_of
from synth.studies.timing.machine import this_machine
from synth.sweep.sweep_file import parse_sweep

UNITS = (UnitRow("22 t", 22.0, 16, 3.0, 200.0, 400.0, 3.0), UnitRow("84 t", 84.0, 16, 5.0, 300.0, 400.0, 5.0))
FOUND = SweepSpeed(this_machine(), 2, 16, 2000, 8.0, 0, UNITS, Binding(10_000, 5.0, 2.0, 12.0, 50.0, 170.0))


def test_rates_are_those_of_the_whole_time() -> None:
    """32 tables in 8 s: 240 a minute; 10 000 in 2500 s; 8 worker-seconds of 16."""
    assert FOUND.made == 32
    assert FOUND.busy == 0.5
    assert FOUND.minutes_for_many == pytest.approx(2500.0 / 60.0)
    told = {row[0]: row[1] for row in FOUND.tables()["sweep"].rows}
    assert told["rate"] == "240 tables a minute; 10000 would take 42 minutes"
    assert told["memory of a worker"] == "300 MiB at most; 0.50 to 0.75 of the estimate"


def test_failures_and_an_estimate_that_is_too_low_are_faults() -> None:
    assert FOUND.faults() == ()
    assert replace(FOUND, failed=2).faults() == ("2 classes failed",)
    greedy = replace(UNITS[1], peak_mib=401.0)
    assert replace(FOUND, units=(UNITS[0], greedy)).faults() == ("84 t takes more memory than is estimated",)


def test_the_sweep_has_so_many_classes_and_speeds() -> None:
    (condition,) = parse_sweep(text_of(3, 2), "test").conditions
    assert [cut.cut.mass_t for cut in condition.config.cuts] == [22.0, 53.0, 84.0]
    assert condition.config.targets_m_s == (1.25, 5.0)
