"""The command judges by what failed, and tells what it could not check."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest

from synth.cli import main
from synth.cli.qualification import qualified
from synth.cli.qualification.check import Check, checked, not_checked
from synth.cli.qualification.qualified import Qualified

PASSED = checked("bytes", "by hash", "equal", "equal", holds=True)
LEFT = not_checked("compiler", "self-test", "not on PATH: cc", "sound", "put a compiler on PATH")
FAILED = checked("claim", "by simulation", "0.3 m/s", "at most 0.1 m/s", holds=False)


@pytest.mark.parametrize(
    ("checks", "code", "sentence"),
    [
        ((PASSED, PASSED), 0, "2 checks passed, none failed"),
        ((PASSED, LEFT), 0, "1 check passed, none failed; 1 check could not be made"),
        ((PASSED, LEFT, FAILED), 1, "claim: 0.3 m/s; asked: at most 0.1 m/s"),
    ],
)
def test_the_exit_code_is_that_of_what_was_checked(
    checks: tuple[Check, ...], code: int, sentence: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def made(done: Callable[[str], None]) -> Qualified:
        return Qualified(checks, (), {"measured/a.json": b"{}"})

    monkeypatch.setattr(qualified, "qualified", made)
    assert main(["qualify", "-o", str(tmp_path / "out"), "-q"]) == code
    summary = json.loads((tmp_path / "out" / "summary.json").read_bytes())
    assert [limit["sentence"] for limit in summary["limits"]] == [sentence]
    assert [row["outcome"] for row in summary["tables"]["checks"]] == [check.outcome.value for check in checks]
    page = (tmp_path / "out" / "report.html").read_text()
    assert (LEFT.remedy in page) == (LEFT in checks)
    assert (tmp_path / "out" / "measured" / "a.json").read_bytes() == b"{}"
