"""Each planted fault in a table is found, with the right exit code and for the right reason."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from synth.checker.finding import Kind
from synth.checker.verdict import CONFIRMED, verify
from tests.checker.planted_fault import Document, alone, claim_in_summary, found, judged, look, rewrite


@pytest.mark.requirement("VERIFY-02")
def test_a_tune_with_every_export_passes(tuned_once: Path) -> None:
    verdict = verify(tuned_once, 300, 1)
    assert verdict.findings == ()
    assert verdict.code == CONFIRMED
    assert [each.skipped for each in verdict.tables] == [None, None]
    assert {"book.h5", "c/retarder_table.c", "c/golden_vectors.csv", "st/retarder_table.st"} <= set(verdict.files)
    assert sum(name.endswith(".csv") for name in verdict.files) == 3


def test_a_table_and_a_book_pass_alone(tuned_once: Path, tmp_path: Path) -> None:
    table = min((tuned_once / "tables").glob("*.json"))
    for file in (table, tuned_once / "book.h5"):
        assert judged(file).code == CONFIRMED
        assert all(each.figures is not None for each in judged(file).tables)
    lonely = Path(shutil.copy(table, tmp_path / "lonely.json"))
    (each,) = judged(lonely).tables
    assert each.figures is None
    assert "no usable summary.json" in str(each.skipped)


def halve_rms(document: Document) -> None:
    document["predicted"]["rms_m_s"] *= 0.5
    document["predicted"]["bias_m_s"] *= 0.5
    document["validated"]["rms_m_s"] *= 0.5
    document["validated"]["rms_ci95_m_s"] = [0.5 * x for x in document["validated"]["rms_ci95_m_s"]]


def double_rms(document: Document) -> None:
    document["predicted"]["rms_m_s"] *= 2.0
    document["validated"]["rms_m_s"] *= 2.0
    document["validated"]["rms_ci95_m_s"] = [2.0 * x for x in document["validated"]["rms_ci95_m_s"]]


def only_predicted(document: Document) -> None:
    document["predicted"]["rms_m_s"] *= 0.5
    document["predicted"]["bias_m_s"] = 0.0


def other_bias(document: Document) -> None:
    document["predicted"]["bias_m_s"] = -0.9 * document["predicted"]["rms_m_s"]


def fewer_switchings(document: Document) -> None:
    document["predicted"]["switchings"] *= 0.6


def many_overspeeds(document: Document) -> None:
    document["predicted"]["p_overspeed"] = 0.3


def many_stalls(document: Document) -> None:
    document["predicted"]["p_stall"] = 0.3


def outside_its_interval(document: Document) -> None:
    document["validated"]["rms_ci95_m_s"] = [0.9 * x for x in document["validated"]["rms_ci95_m_s"]]


@pytest.mark.requirement("VERIFY-03")
@pytest.mark.parametrize(
    ("change", "words"),
    [
        (halve_rms, r"validated rms is .* coarse simulation gives .* more than"),
        (halve_rms, r"predicted rms is .* coarse simulation gives .* more than"),
        (double_rms, r"validated rms is .* coarse simulation gives .* less than"),
        (only_predicted, "does not agree with the validated one"),
        (other_bias, "bias"),
        (fewer_switchings, "switchings a pass"),
        (many_overspeeds, "probability of over-speed"),
        (many_stalls, "probability of stalls"),
        (outside_its_interval, "is not within its interval"),
    ],
)
def test_a_false_claim_is_not_confirmed(tuned: Path, change: Callable[[Document], None], words: str) -> None:
    """The summary's own figures are changed alike, so that only the simulation can tell."""
    table = alone(tuned)
    rewrite(table, change)
    claim_in_summary(tuned, json.loads(table.read_text(encoding="utf-8")))
    assert found(verify(table, 300, 1), Kind.CLAIM, words)


def cross_lines(document: Document) -> None:
    stage = document["stages"][1]
    stage["lower"], stage["upper"] = stage["upper"], stage["lower"]


def touch_lines(document: Document) -> None:
    document["stages"][1]["lower"] = document["stages"][1]["upper"]


def no_float32(document: Document) -> None:
    document["stages"][0]["upper"][0] += 1e-12


def falling_pressure(document: Document) -> None:
    document["stages"][1]["pressure_kpa"] = document["stages"][0]["pressure_kpa"]


def wild_line(document: Document) -> None:
    document["stages"][0]["upper"][1] = 2.0


def never_released(document: Document) -> None:
    document["stages"][1]["lower"] = [-1.0, 0.0, 0.0]


def other_target(document: Document) -> None:
    document["target_speed_m_s"] = 8.0


def short_path(document: Document) -> None:
    document["valid"]["s_m"][1] = 5.0


def other_exit(document: Document) -> None:
    document["retarder"]["exit_m"] += 1.0


@pytest.mark.requirement("VERIFY-04")
@pytest.mark.parametrize(
    ("change", "words"),
    [
        (cross_lines, "the lower line is not below the upper one"),
        (touch_lines, "the lower line is not below the upper one"),
        (no_float32, "no float32 number"),
        (falling_pressure, "do not rise"),
        (wild_line, "out of the plausible"),
        (never_released, "never left downwards"),
        (other_target, "or more from the target"),
        (short_path, "does not cover"),
        (other_exit, "the last axle leaves"),
    ],
)
def test_a_senseless_table_is_damaged(tuned: Path, change: Callable[[Document], None], words: str) -> None:
    table = alone(tuned)
    rewrite(table, change)
    assert found(look(table), Kind.DAMAGED, words)


@pytest.mark.requirement("VERIFY-04")
def test_a_table_of_another_configuration_is_found(tuned: Path) -> None:
    rewrite(alone(tuned), lambda document: document["generator"].update(config_sha256="0" * 64))
    assert found(look(tuned), Kind.DISAGREES, "it was made from another configuration than summary.json tells")
