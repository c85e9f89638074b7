"""`hump watch`, night by night: what has drifted is first on the list, once, until it is repaired."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from scripts.studies.identification.truths import text_of_classes
from synth.cli import main
from synth.logs.fitting_passes import FittingPasses
from tests.system.test_hump_trials import SMALL
from tuning_tables.pass_log.log_files import write_log

YARD = """\
config = "knp-5.toml"
trial = "trial.toml"
[cost]
number = 20
[output]
plots = false
[[position]]
name = "calm"
[[position]]
name = "Park 1"
retarder = 421
"""


def night(root: Path, number: int, passes: FittingPasses, bias_m_s: float) -> None:
    """A night's logs of both positions; the sensor of one shows too much."""
    part = passes.log.taken(np.arange(40 * number, 40 * number + 40))
    for name, off in (("calm", 0.0), ("Park 1", bias_m_s)):
        (root / "logs" / name).mkdir(parents=True, exist_ok=True)
        write_log(replace(part, speed_m_s=part.speed_m_s + off), root / "logs" / name / f"{number}.csv")


def test_a_yard_is_watched_night_by_night(
    passes: FittingPasses, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")
    for name, text in (("yard.toml", YARD), ("trial.toml", SMALL), ("knp-5.toml", text_of_classes())):
        Path(name).write_text(text, encoding="utf-8")

    def watched(*words: str) -> tuple[int, Any]:
        code = main(["hump", "watch", "yard.toml", "-o", "out", "-q", *words])
        return code, json.loads(Path("out/summary.json").read_bytes())

    assert main(["hump", "watch", "yard.toml", "-o", "out"]) == 2
    assert "there is no such file or folder" in capsys.readouterr().err
    night(tmp_path, 0, passes, 0.0)
    code, told = watched()
    assert (code, told["figures"]["drifted"], told["figures"]["new_passes"]) == (0, 0, 80)
    Path("out/summary.json").unlink()  # as if it had been killed just before: every position is stored
    assert watched() == (code, told)
    night(tmp_path, 1, passes, 0.1)
    code, told = watched()
    assert (code, told["figures"]["drifted"], told["figures"]["new_passes"]) == (1, 1, 80)
    (first,) = told["tables"]["repairs"]
    assert (first["rank"], first["position"], first["cause"]) == (1, "Park 1", "sensor bias")
    assert first["weight_per_hour"]["n"] == 20
    (evidence,) = told["tables"]["evidence"]
    assert evidence["begin"]["value"] == 41
    # Only what the sensor showed was changed: its bias is taken off the exits.
    assert evidence["mean_since_m_s"]["value"] == pytest.approx(evidence["mean_before_m_s"]["value"], abs=0.02)
    code, again = watched()
    assert (code, again["figures"]["new_passes"]) == (1, 0)
    assert again["tables"]["repairs"] == told["tables"]["repairs"]
    code, told = watched("--repaired", "Park 1")
    assert (code, told["figures"]["drifted"]) == (0, 0)
    Path("yard.toml").write_text(YARD.replace("retarder = 421", "retarder = 499"), encoding="utf-8")
    assert main(["hump", "watch", "yard.toml", "-o", "out"]) == 2
    assert "retarder is 499; on the hump of the trial stand 401" in capsys.readouterr().err


def test_a_position_without_new_passes_is_told(passes: FittingPasses, tmp_path: Path) -> None:
    night(tmp_path, 0, passes, 0.0)
    (tmp_path / "knp-5.toml").write_text(text_of_classes(), encoding="utf-8")
    text = 'config = "knp-5.toml"\n[[position]]\nname = "calm"\n[[position]]\nname = "silent"\n'
    (tmp_path / "yard.toml").write_text(text + "[output]\nplots = false\nreport = false\n", encoding="utf-8")
    assert main(["hump", "watch", str(tmp_path / "yard.toml"), "-o", str(tmp_path / "out")]) == 1
    told = json.loads((tmp_path / "out" / "summary.json").read_bytes())
    assert told["accepted"] is False
    assert [each["kept"] for each in told["limits"]] == [True, None]
    assert "no new passes of silent" in told["limits"][1]["sentence"]
