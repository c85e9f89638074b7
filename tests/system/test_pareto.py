"""`retarder-synth tune --pareto` as a user runs it."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from synth.cli import main
from synth.retarder.pareto.pareto_front import PRICES_M2_S3
from tests.printed_page import Page, page_about

COARSE = """\
[position]
name = "rnz-2m-park"
[targets]
exit_speeds_m_s = [2.5]
[grid]
path_step_m = 0.5
speed_step_m_s = 0.05
friction_scenarios = 3
resistance_scenarios = 1
[validation]
passes = 1000
[[cut]]
car = "gondola-4"
mass_t = 22
"""


@pytest.mark.long
def test_time_falls_with_its_price(tmp_path: Path, pages: list[Page]) -> None:
    """The dearest table is quicker and no more accurate; the cheapest is the one that the tune exports."""
    (tmp_path / "c.toml").write_text(COARSE, encoding="utf-8")
    out = tmp_path / "out"
    assert main(["tune", str(tmp_path / "c.toml"), "-o", str(out), "--pareto"]) in (0, 1)
    tables = json.loads((out / "summary.json").read_bytes())["tables"]
    (case,), points = tables["cases"], tables["fronts"]
    assert [each["time_price_m2_s3"] for each in points] == list(PRICES_M2_S3)
    assert points[0]["rms_m_s"]["value"] == pytest.approx(case["rms_m_s"]["value"])
    assert points[0]["time_s"] == case["time_s"]
    assert points[-1]["time_s"]["high95"] < points[0]["time_s"]["low95"]
    assert points[-1]["ratio"]["high95"] > 1.0
    assert points[0]["ratio"]["value"] == 1.0
    told = [each for each in page_about(pages, out) if isinstance(each, str) and " a second " in each]
    assert len(told) == 1
    assert (out / "plots" / "pareto-fronts.svg").exists()
    assert "Accuracy against time" in (out / "report.html").read_text(encoding="utf-8")
