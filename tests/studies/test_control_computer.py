"""The study of the control computer: what it calls a fault, what it keeps for the command, and how it humps."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from scripts.studies.control_computer.findings import ControlComputer
from scripts.studies.control_computer.published_speeds import published_speeds
from scripts.studies.documents import result_of
from synth.computer.economics.hump_rates import RATES, HumpRates

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def kept() -> ControlComputer:
    found = result_of(ROOT, "control-computer").findings
    assert isinstance(found, ControlComputer)
    return found


def test_the_kept_study_has_no_fault_and_every_planted_one_is_told(kept: ControlComputer) -> None:
    assert kept.faults() == ()
    law = replace(kept.published.speeds.laws[0], long_share=0.01)
    row = replace(kept.controllers.rows[0], in_time=False)
    planted = replace(
        kept,
        published=replace(
            kept.published,
            speeds=replace(kept.published.speeds, laws=(law, *kept.published.speeds.laws[1:])),
        ),
        controllers=replace(kept.controllers, rows=(row, *kept.controllers.rows[1:])),
    )
    faults = planted.faults()
    assert len(faults) == 2
    assert faults[0].startswith("published claims")
    assert faults[1].startswith("PLC")


def test_the_rates_that_the_command_takes_are_there_and_changes_are_their_differences(kept: ControlComputer) -> None:
    variants, beside = kept.benefit.variants, kept.benefit.beside_today
    assert list(variants) == ["today", "asked", "new", "tables"]
    names = list(RATES)
    for name in ("today", "new"):
        HumpRates(**{field: variants[name].rates[field].value for field in names})
    for name in ("asked", "new"):
        assert variants[name].trains == variants["today"].trains
        for field in names:
            found = beside[name].change[field]
            difference = variants[name].rates[field].value - variants["today"].rates[field].value
            assert found.value == pytest.approx(difference, abs=1e-9), field
            assert found.low95 <= found.value <= found.high95


def test_constant_service_keeps_both_claims_and_the_fewest_stages_do() -> None:
    found = published_speeds()
    assert {law.law: law.kept for law in found.laws}["constant"] == (True, True)
    assert found.faults() == ()
    # an Erlang law of so many stages lies between constant and exponential service
    constant, exponential = found.laws[0].long_share, found.laws[2].long_share
    assert constant < 0.001 < exponential
    assert found.erlang_stages > 2
