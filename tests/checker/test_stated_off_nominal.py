"""What a summary says of tables off nominal is read strictly: shape, intervals, numbers of passes."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any, cast

import pytest

from synth.checker.stated_off_nominal import KEYS, off_nominal_faults
from synth.checker.summary import by_case
from synth.checker.verdict import verify
from synth.retarder.off_nominal.trial import CONDITIONS

Row = dict[str, Any]
Rows = list[Any]
PASSES = 4000


@pytest.fixture
def rows(tuned_once: Path) -> Rows:
    """What a tune's summary says of one case off nominal."""
    tables = json.loads((tuned_once / "summary.json").read_text(encoding="utf-8"))["tables"]
    first = tables["cases"][0]["label"], tables["cases"][0]["target_speed_m_s"]
    return by_case(tables["off_nominal"])[first]


def test_the_conditions_of_the_tune_are_those_that_the_checker_asks_for(rows: Rows) -> None:
    assert tuple(each.key for each in CONDITIONS) == KEYS
    assert {row["key"] for row in rows} == set(KEYS)
    assert not list(off_nominal_faults(rows, PASSES))


def slow_valves(rows: Rows) -> Row:
    """One of the conditions."""
    (found,) = (row for row in rows if row["key"] == "slow_valves")
    return cast(Row, found)


def of(**changes: Any) -> Callable[[Rows], None]:
    return lambda rows: slow_valves(rows).update(changes)


def figure(name: str, **changes: Any) -> Callable[[Rows], None]:
    return lambda rows: slow_valves(rows)[name].update(changes)


FORGED: list[tuple[Callable[[Rows], Any], str]] = [
    (lambda rows: rows.clear(), "must tell of low_friction"),
    (lambda rows: rows.pop(), "must tell of low_friction"),
    (lambda rows: rows.append(dict(rows[0])), "must tell of low_friction"),
    (of(key="sunshine"), "must tell of low_friction"),
    (lambda rows: rows.append([]), "must tell of low_friction"),
    (lambda rows: slow_valves(rows).pop("rms_m_s"), "slow_valves: the document is"),
    (of(more=1), "slow_valves: the document is"),
    (of(rms_m_s="0.1"), "slow_valves: rms_m_s is"),
    (figure("rms_m_s", value=9.0), "slow_valves: rms_m_s is 9.0, which is outside its interval"),
    (figure("stalled", value=0.5), "slow_valves: stalled is 0.5, which is outside"),
    (figure("overspeed", value=1.2, low95=1.1, high95=1.3), "slow_valves: a share above 1"),
    (figure("rms_m_s", low95=0.2, high95=0.1), "slow_valves: rms_m_s is"),
    (figure("ratio", value=99.0), "slow_valves: ratio is 99.0, which is outside"),
    (figure("stalled", n=10**6), "slow_valves: stalled of 1000000 passes, but the table was simulated on 4000"),
    (figure("rms_m_s", n=0), "slow_valves: rms_m_s of 0 passes"),
    (of(impossible="x"), "slow_valves: "),
]


@pytest.mark.parametrize(("forge", "told"), FORGED)
def test_what_cannot_be_is_told(rows: Rows, forge: Callable[[Rows], Any], told: str) -> None:
    forge(rows)
    [sentence] = off_nominal_faults(rows, PASSES)
    assert told in sentence


def test_a_plant_that_cannot_be_needs_no_figures(rows: Rows) -> None:
    figures = dict.fromkeys(("change", "rms_m_s", "ratio", "overspeed", "stalled"))
    slow_valves(rows).update({**figures, "impossible": "cut: mass_t is too much"})
    assert not list(off_nominal_faults(rows, PASSES))


def test_verify_reads_it(tuned_once: Path, tmp_path: Path) -> None:
    folder = tmp_path / "out"
    shutil.copytree(tuned_once, folder)
    file = folder / "summary.json"
    document = json.loads(file.read_text(encoding="utf-8"))
    slow_valves(document["tables"]["off_nominal"][: len(KEYS)])["rms_m_s"]["value"] = 9.0
    file.write_text(json.dumps(document), encoding="utf-8")
    told = [finding.sentence for finding in verify(folder, 20, 1).findings]
    assert any("off nominal, slow_valves: rms_m_s is 9.0" in sentence for sentence in told)
