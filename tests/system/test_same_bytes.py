"""The same problem gives the same bytes: tables, book, pictures, report and summary, whatever the number of workers."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.system.conftest import EPOCH, Command


@pytest.mark.requirement("PRED-09")
def test_one_worker_gives_the_bytes_of_two(
    command: Command,
    tuned_once: tuple[Path, int],
    two_classes: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv("SOURCE_DATE_EPOCH", EPOCH)
    assert command("tune", two_classes, "-o", tmp_path, "--workers", "1").code == 0
    names = {path.relative_to(tmp_path) for path in tmp_path.rglob("*") if path.is_file()}
    assert names == {path.relative_to(tuned_once[0]) for path in tuned_once[0].rglob("*") if path.is_file()}
    assert [name for name in names if (tmp_path / name).read_bytes() != (tuned_once[0] / name).read_bytes()] == []
