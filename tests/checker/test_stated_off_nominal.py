"""What a summary says of tables off nominal is read strictly: shape, intervals, numbers of passes."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from synth.book.off_nominal.condition import CONDITIONS
from synth.checker.stated_off_nominal import KEYS, off_nominal_faults
from synth.checker.verdict import verify

Case = dict[str, Any]


@pytest.fixture
def case(tuned_once: Path) -> Case:
    """One case of a tune's summary."""
    found: Case = json.loads((tuned_once / "summary.json").read_text(encoding="utf-8"))["cases"][0]
    return found


def test_the_conditions_of_the_tune_are_those_that_the_checker_asks_for(case: Case) -> None:
    assert tuple(each.key for each in CONDITIONS) == KEYS
    assert set(case["off_nominal"]) == set(KEYS)
    assert not list(off_nominal_faults(case))


def of(key: str, **changes: Any) -> Callable[[Case], None]:
    def forge(case: Case) -> None:
        case["off_nominal"][key].update(changes)

    return forge


def without(name: str) -> Callable[[Case], None]:
    def forge(case: Case) -> None:
        del case["off_nominal"]["slow_valves"][name]

    return forge


FORGED: list[tuple[Callable[[Case], Any], str]] = [
    (lambda case: case.pop("off_nominal"), "must tell of low_friction"),
    (lambda case: case["off_nominal"].pop("wrong_weight"), "must tell of low_friction"),
    (lambda case: case["off_nominal"].update(sunshine={}), "must tell of low_friction"),
    (lambda case: case["off_nominal"].update(low_friction=[]), "low_friction: the document is [], but"),
    (without("rms_m_s"), "slow_valves: the document is"),
    (of("slow_valves", more=1), "slow_valves: the document is"),
    (of("slow_valves", rms_m_s="0.1"), "slow_valves: rms_m_s is"),
    (of("slow_valves", rms_m_s=9.0), "slow_valves: rms_m_s is 9.0, which is outside its interval"),
    (of("slow_valves", stalled=0.5), "slow_valves: stalled is 0.5, which is outside"),
    (of("slow_valves", overspeed=1.2, overspeed_ci95=[1.1, 1.3]), "slow_valves: a share above 1"),
    (of("slow_valves", rms_ci95_m_s=[0.2, 0.1]), "slow_valves: rms_ci95_m_s is"),
    (of("slow_valves", ratio=None), "slow_valves: ratio is"),
    (of("slow_valves", ratio=99.0), "slow_valves: ratio is 99.0, which is outside"),
    (of("slow_valves", passes=10**6), "slow_valves: 1000000 passes, but the table was simulated on 4000"),
    (of("slow_valves", passes=0), "slow_valves: 0 passes"),
    (of("slow_valves", impossible="x"), "slow_valves: the document is"),
]


@pytest.mark.parametrize(("forge", "told"), FORGED)
def test_what_cannot_be_is_told(case: Case, forge: Callable[[Case], Any], told: str) -> None:
    forge(case)
    [sentence] = off_nominal_faults(case)
    assert told in sentence


def test_a_plant_that_cannot_be_needs_no_figures(case: Case) -> None:
    case["off_nominal"]["wrong_weight"] = {"name": "weight ± 10 %", "impossible": "cut: mass_t is too much"}
    assert not list(off_nominal_faults(case))


def test_verify_reads_it(tuned_once: Path, tmp_path: Path) -> None:
    folder = tmp_path / "out"
    shutil.copytree(tuned_once, folder)
    file = folder / "summary.json"
    document = json.loads(file.read_text(encoding="utf-8"))
    document["cases"][0]["off_nominal"]["slow_valves"]["rms_m_s"] = 9.0
    file.write_text(json.dumps(document), encoding="utf-8")
    told = [finding.sentence for finding in verify(folder, 20, 1).findings]
    assert any("off nominal, slow_valves: rms_m_s is 9.0" in sentence for sentence in told)
