"""A tune by another criterion than the mean square: it is obeyed, and summary and report say so."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from tests.system.conftest import CLASS, EPOCH, MEASURED, Command


@pytest.fixture
def default_case(measured_once: Path) -> Any:
    """The case of the default criterion in its summary."""
    summary = json.loads((measured_once / "summary.json").read_text())
    assert summary["figures"]["criterion"] == "mean squared exit-speed error"
    assert "requirement" not in summary["tables"]
    return summary["tables"]["cases"][0]


def tuned_by(command: Command, criterion: str, out: Path) -> tuple[Any, str]:
    """(summary, report) of a tune for the measured speed with that [criterion]."""
    config = out.with_suffix(".toml")
    config.write_text(CLASS.replace("csv = true", "plots = false") + MEASURED + f"[criterion]\n{criterion}\n")
    assert command("tune", config, "-o", out, "--workers", "1").code in (0, 1)
    return json.loads((out / "summary.json").read_text()), (out / "report.html").read_text()


def test_dearer_overspeed_makes_slower_exits(command: Command, default_case: Any, tmp_path: Path) -> None:
    summary, report = tuned_by(command, "overspeed_factor = 4.0", tmp_path / "out")
    assert "over-speed weighing 4 times" in summary["figures"]["criterion"]
    assert summary["figures"]["criterion"] in report
    (slower,) = summary["tables"]["cases"]
    assert slower["bias_m_s"]["value"] < default_case["bias_m_s"]["value"] - 0.003


def test_a_limit_that_is_kept_anyway_changes_no_line(
    command: Command,
    default_case: Any,
    measured_once: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv("SOURCE_DATE_EPOCH", EPOCH)
    summary, report = tuned_by(command, "p_overspeed = 0.5\noverspeed_margin_m_s = 0.3", tmp_path / "out")
    (case,), (requirement,) = summary["tables"]["cases"], summary["tables"]["requirement"]
    assert requirement["multiplier_m2_s2"] == 0.0
    assert "without a price and keeps 0.5: the limit is not active" in report
    predicted = [
        {key: value for key, value in each.items() if key.startswith("predicted_")} for each in (case, default_case)
    ]
    assert predicted[0] == predicted[1]
    assert predicted[0]["predicted_rms_m_s"] > 0.0
    tables = [
        json.loads((at / "tables" / f"{case['id']}.json").read_text()) for at in (tmp_path / "out", measured_once)
    ]
    assert tables[0]["stages"] == tables[1]["stages"]
    assert tables[0]["generator"]["config_sha256"] != tables[1]["generator"]["config_sha256"]
