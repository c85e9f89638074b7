"""A tune in which a case cannot be solved: the others are whole, and everybody is told of that one."""

from __future__ import annotations

import contextlib
import html
import io
import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

from plant_models import PlantError
from synth.checker.verdict import verify
from synth.cli import main
from synth.retarder.configuration.config_file import parse_config
from synth.retarder.failed_case import FailedCase, attempted, told_together
from synth.solver.descent import CoarseGridError
from tests.frame.small_command import results_in
from tests.system.conftest import CLASS, MEASURED, SECOND_CLASS, Command, changed
from tests.system.test_permissions import COARSE
from tests.system.test_sensors_tune import CONFIG as POINTS
from tuning_tables import InvalidTable, read_book

STEEP = "[criterion]\noverspeed_factor = 1000\n"
WIDE = ("speed_step_m_s = 0.04", "speed_step_m_s = 0.2")
"""A cost that so wide cells cannot hold at 2.5 m/s, nor half as wide ones; 1.5 m/s is well."""

KEPT = ("prediction_ratio_high = 1.35", "prediction_ratio_high = 2.0\nrms_m_s = 0.3")
ONE_BAD = (
    changed(CLASS, WIDE, KEPT, ("[1.5]", "[1.5, 2.5]")) + MEASURED + STEEP + SECOND_CLASS + "targets_m_s = [1.5]\n"
)
BAD = "gondola-4-22t to 2.5 m/s"
REASON = "the grid is too coarse for these lines (an expected square came out negative): make grid.speed_step_m_s"
KEYS = "; now grid.speed_step_m_s is 0.2 and grid.path_step_m is 1"


@dataclass(frozen=True)
class Tuned:
    """A tune: exit code, what it printed, and its directory."""

    code: int
    out: str
    err: str
    directory: Path

    @property
    def summary(self) -> dict[str, Any]:
        """summary.json."""
        found: dict[str, Any] = json.loads((self.directory / "summary.json").read_bytes())
        return found


@pytest.fixture(scope="module")
def tuned(tmp_path_factory: pytest.TempPathFactory) -> Tuned:
    """Three cases in two classes, of which one cannot be solved; not to be changed."""
    folder = tmp_path_factory.mktemp("one-bad")
    (folder / "c.toml").write_text(ONE_BAD, encoding="utf-8")
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        code = main(["tune", str(folder / "c.toml"), "-o", str(folder / "out"), "--workers", "2"])
    return Tuned(code, out.getvalue(), err.getvalue(), folder / "out")


@pytest.mark.requirement("CMD-09")
def test_the_other_cases_are_whole(tuned: Tuned) -> None:
    assert tuned.code == 1
    ids = ["gondola-4-22t-to-1.5-m-s", "gondola-4-30t-to-1.5-m-s"]
    assert [table.id for table in read_book(tuned.directory / "book.h5")] == ids
    assert sorted(path.stem for path in (tuned.directory / "tables").glob("*.json")) == ids
    assert (tuned.directory / "c" / "retarder_table.c").is_file()
    cases = tuned.summary["tables"]["cases"]
    assert [case["id"] for case in cases if case["verdict"] != "no table"] == ids
    pictures = {path.name for path in (tuned.directory / "plots").glob("*.svg")}
    assert {"rms-by-controller.svg", "feasibility.svg"} <= pictures
    assert not [name for name in pictures if "2.5" in name]


@pytest.mark.requirement("CMD-09")
def test_the_bad_case_is_named_with_its_reason_and_what_to_change(tuned: Tuned) -> None:
    (failed,) = tuned.summary["tables"]["failed"]
    assert (failed["label"], failed["target_m_s"]) == ("gondola-4-22t", 2.5)
    assert failed["reason"].startswith(REASON)
    assert failed["reason"].endswith(KEYS)
    page = html.unescape((tuned.directory / "report.html").read_text(encoding="utf-8"))
    sentence = tuned.summary["limits"][0]["sentence"]
    for text in (sentence, tuned.out, page, tuned.err):
        assert BAD in text
        assert failed["reason"] in " ".join(text.split())
    assert "there is no table for 1 of 3 cases (" in sentence
    assert tuned.summary["accepted"] is False
    (row,) = (line.split() for line in tuned.out.splitlines() if line.split()[1:4] == ["2.5", "no", "table"])
    assert row[0] == "gondola-4-22t"
    assert '<td class="words">no table</td>' in page


def test_the_counter_counts_cases_and_nothing_else(tuned: Tuned) -> None:
    counted = [line for line in tuned.err.splitlines() if line.startswith("[")]
    assert [line[:5] for line in counted] == ["[1/3]", "[2/3]", "[3/3]"]
    assert sum("no table" in line for line in counted) == 1


def test_what_a_tune_leaves_is_read_by_who_checks_it(tuned: Tuned, command: Command) -> None:
    assert verify(tuned.directory, 100, 1).code in (0, 1)
    ran = command("inspect", tuned.directory)
    assert ran.code == 0
    assert f"there is no table for 1 of 3 cases ({BAD}: " in ran.out
    config, out = tuned.directory.parent / "c.toml", tuned.directory.parent / "validated"
    assert command("validate", tuned.directory / "book.h5", "--config", config, "--passes", "1000", "-o", out).code in (
        0,
        1,
    )


def test_tables_for_point_sensors_lose_none_but_the_bad_case(command: Command, tmp_path: Path) -> None:
    config, out = tmp_path / "c.toml", tmp_path / "out"
    swaps = (
        ("speed_step_m_s = 0.04", "speed_step_m_s = 0.1"),
        ("[2.0, 2.5]", "[3.0, 2.5]"),
        ("csv", "plots = false\ncsv"),
    )
    config.write_text(changed(POINTS, *swaps) + STEEP, encoding="utf-8")
    ran = command("tune", config, "-o", out, "--workers", "1")
    assert ran.code == 1
    summary = json.loads((out / "summary.json").read_bytes())
    assert [path.stem for path in (out / "tables").glob("*.json")] == ["gondola-4-22t-to-2.5-m-s"]
    (failed,) = summary["tables"]["failed"]
    assert (failed["label"], failed["target_m_s"]) == ("gondola-4-22t", 3.0)
    assert "the grid is too coarse for these switching speeds" in failed["reason"]
    page = html.unescape((out / "report.html").read_text(encoding="utf-8"))
    for text in (summary["limits"][0]["sentence"], page, ran.out):
        assert f"gondola-4-22t to 3 m/s: {failed['reason']}" in text
    assert [line[:5] for line in ran.err.splitlines() if line.startswith("[")] == ["[1/2]", "[2/2]"]
    assert verify(out, 100, 1).code in (0, 1)
    assert command("inspect", out).code == 0


@pytest.fixture
def no_surfaces(monkeypatch: pytest.MonkeyPatch) -> None:
    """Commands at any time find no design."""

    def too_coarse(*_: object) -> None:
        raise CoarseGridError("no surfaces on this grid")

    monkeypatch.setattr("synth.retarder.permissions.case_permissions.at_any_time", too_coarse)


WITHOUT_SURFACES = ("commands at any time", "commands at any time, no pressure gauge")


@pytest.mark.usefixtures("no_surfaces")
def test_permissions_of_the_other_cases_are_told(command: Command, tmp_path: Path) -> None:
    config, out = tmp_path / "c.toml", tmp_path / "out"
    swaps = ("[2.5]", "[2.5, 1.5]"), ("speed_step_m_s = 0.05", WIDE[1]), ("[regulator]\n", MEASURED)
    config.write_text(changed(COARSE, *swaps) + STEEP, encoding="utf-8")
    ran = command("hardware", config, "-o", out)
    assert ran.code == 1
    summary = json.loads((out / "summary.json").read_bytes())
    (case,), missing = summary["tables"]["permissions"], summary["tables"]["missing"]
    failed = [row["target_speed_m_s"] for row in missing if row["permission"] is None]
    assert (case["target_speed_m_s"], failed) == (1.5, [2.5])
    assert {row["permission"] for row in missing if row["target_speed_m_s"] == 1.5} == set(WITHOUT_SURFACES)
    assert f"{BAD}: no table: {REASON}" in ran.out
    assert f"gondola-4-22t to 1.5 m/s, {WITHOUT_SURFACES[0]}: no surfaces on this grid" in ran.out
    assert [line[:5] for line in ran.err.splitlines() if line.startswith("[")] == ["[1/2]", "[2/2]"]


def test_all_cases_bad_are_one_sentence(command: Command, tmp_path: Path) -> None:
    config = tmp_path / "c.toml"
    config.write_text(changed(CLASS, WIDE, ("[1.5]", "[2.5]")) + MEASURED + STEEP + SECOND_CLASS, encoding="utf-8")
    ran = command("tune", config, "-o", tmp_path / "out")
    assert (ran.code, ran.out) == (2, "")
    told = ran.err.splitlines()[-1]
    assert told.startswith(f"retarder-synth: {config}: no table for {BAD} (nor for the 1 other case): {REASON}")
    assert results_in(tmp_path / "out") == {}


def test_what_a_case_fails_by_is_told_in_the_words_of_the_configuration() -> None:
    config = parse_config(CLASS, "c.toml")

    def told(fault: Exception) -> str:
        def fail() -> int:
            raise fault

        case = attempted(fail, "a", 2.0, config)
        assert isinstance(case, FailedCase)
        return case.reason

    assert told(PlantError("sensor: noise_m_s is 0")) == "sensor.noise_m_s is 0"
    assert told(CoarseGridError("make it finer", ("fit.degree",))) == "make it finer; now fit.degree is 2"
    assert told(InvalidTable("lines touch.")).startswith("what was found makes no table (lines touch): make grid.")
    with pytest.raises(ZeroDivisionError):
        attempted(lambda: 1 // 0, "a", 2.0, config)


def test_cases_that_fail_alike_are_told_together() -> None:
    cases = [FailedCase("a", 1.5, "coarse"), FailedCase("b", 2.0, "other"), FailedCase("c", 1.5, "coarse")]
    assert told_together(cases) == "a to 1.5 m/s, c to 1.5 m/s: coarse; b to 2 m/s: other"
