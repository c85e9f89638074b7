"""A case that cannot be computed is told, stops nothing else, and is tried again by the next run."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from synth.sweep.local_workers import LocalWorkers
from synth.sweep.work import InThisProcess, Work
from tests.sweep import poison
from tests.sweep.conftest import Ran, Silence, contents, events, run
from tuning_tables import read_book


@pytest.mark.parametrize(
    ("work", "reason"),
    [(poison.refusing, "friction.common_cv is -1.0"), (poison.dying, "its worker was ended by SIGKILL, 2 times in 2")],
)
def test_a_poisoned_class_is_told_and_stops_no_other(
    command: Callable[..., Ran],
    monkeypatch: pytest.MonkeyPatch,
    config: Path,
    serial: Path,
    tmp_path: Path,
    work: Work,
    reason: str,
) -> None:
    out = tmp_path / "out"
    with monkeypatch.context() as patch:
        patch.setattr("synth.cli.sweep.engine_for", lambda *ignored: LocalWorkers(2, work))
        code, _, said = command("sweep", config, "-o", out)
    assert code == 1
    last = said.splitlines()[-1]
    assert last.startswith(f"retarder-synth: {poison.POISONED} failed: ")
    assert reason in last
    assert {table.cut.mass_t for table in read_book(out / "book.h5")} == {22.0, 30.0}

    code, listed, _ = command("sweep", "failed", out)
    assert code == 0
    assert listed.startswith(f"{poison.POISONED}: ")
    assert reason in listed
    assert "2 of 3 units done, 1 failed" in command("sweep", "status", out)[1]

    code, _, said = command("sweep", config, "-o", out, "--workers", "1")
    assert code == 0, said
    assert "2 of 3 units are there already" in said
    assert "no unit has failed" in command("sweep", "failed", out)[1]
    assert contents(out) == contents(serial)


def test_a_worker_that_dies_once_costs_nothing_but_time(
    monkeypatch: pytest.MonkeyPatch, config: Path, serial: Path, tmp_path: Path
) -> None:
    monkeypatch.setenv("DIED_ONCE", str(tmp_path / "died"))
    assert run(config, tmp_path / "out", LocalWorkers(2, poison.dying_once)).failures == ()
    assert (tmp_path / "died").exists()
    assert len(events(tmp_path / "out", "started")) == 4
    assert contents(tmp_path / "out") == contents(serial)


def test_another_program_on_a_worker_is_refused(config: Path, tmp_path: Path) -> None:
    outcome = run(config, tmp_path / "out", InThisProcess(poison.strange))
    assert len(outcome.failures) == 3
    assert "another version of retarder-synth" in outcome.failures[0].reason
    assert not (tmp_path / "out" / "book.h5").exists()


def test_a_full_memory_is_refused_before_anything_is_computed(
    command: Callable[..., Ran], monkeypatch: pytest.MonkeyPatch, config: Path, tmp_path: Path
) -> None:
    monkeypatch.setattr("synth.sweep.run.available_memory_bytes", lambda: 100 * 2**20)
    code, out, said = command("sweep", config, "-o", tmp_path / "out")
    assert (code, out) == (2, "")
    assert "make a step larger" in said
    assert [line for line in said.splitlines() if "warning: " not in line] == [said.splitlines()[-1]]
    monkeypatch.setattr("synth.sweep.run.available_memory_bytes", lambda: 800 * 2**20)
    code, _, said = command("sweep", config, "-o", tmp_path / "out", "--workers", "3")
    assert code == 0
    assert "memory allows for 1 of 3 workers" in said


def test_what_is_told_on_the_way(config: Path, tmp_path: Path) -> None:
    watcher = Silence()
    run(config, tmp_path / "out", LocalWorkers(2, poison.refusing), watcher)
    assert len(watcher.ended) == 3
    assert sum("failed: " in sentence for sentence in watcher.ended) == 1
