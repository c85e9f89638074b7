"""Whoever computes a sweep, its bytes are the same; and its tables are those of a tune."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from synth.frame.workers.engine import InThisProcess
from synth.frame.workers.local_workers import LocalWorkers
from synth.retarder.sweep.unit_answer import answer
from tests.sweep.conftest import MEASURED, PLANT, SWEEP, Ran, contents, events, run
from tuning_tables import read_book

TUNED = """\
[validation]
passes = 1000
[targets]
exit_speeds_m_s = [1.5, 2.0]
[output]
plots = false
report = false
[[cut]]
car = "gondola-4"
mass_t = 22
[[cut]]
car = "gondola-4"
mass_t = 26
[[cut]]
car = "gondola-4"
mass_t = 30
"""


@pytest.mark.parametrize("workers", [pytest.param(1, marks=pytest.mark.long), 2])
def test_worker_processes_give_the_bytes_of_this_process(
    config: Path, serial: Path, tmp_path: Path, workers: int
) -> None:
    assert run(config, tmp_path / "out", LocalWorkers(workers, answer)) == 0
    assert contents(tmp_path / "out") == contents(serial)


@pytest.mark.long
@pytest.mark.parametrize("regulator", ["", MEASURED])
def test_tables_are_those_of_a_tune(command: Callable[..., Ran], serial: Path, tmp_path: Path, regulator: str) -> None:
    # The same steps, but a tune solves each target beside other ones.
    (tmp_path / "tune.toml").write_text(PLANT + regulator + TUNED, encoding="utf-8")
    code, _, said = command("tune", tmp_path / "tune.toml", "-o", tmp_path / "out", "--workers", "2")
    assert code in (0, 1), said
    if regulator:
        (tmp_path / "sweep.toml").write_text(PLANT + regulator + SWEEP, encoding="utf-8")
        assert run(tmp_path / "sweep.toml", tmp_path / "swept", LocalWorkers(2, answer)) == 0
    tuned = read_book(tmp_path / "out" / "book.h5")
    swept = read_book((tmp_path / "swept" if regulator else serial) / "book.h5")
    assert len(tuned) == 6
    assert all((table.estimator is None) == bool(regulator) for table in tuned)
    assert all(one == other for one, other in zip(swept, tuned, strict=True))


@pytest.mark.long
def test_the_other_commands_take_what_a_sweep_leaves(command: Callable[..., Ran], serial: Path, tmp_path: Path) -> None:
    code, said, _ = command("inspect", serial)
    assert code == 0
    assert "files that it lists are there unchanged" in said
    given = ("validate", serial / "book.h5", "--config", serial / "config.toml", "--passes", "1000")
    code, said, warned = command(*given, "-o", tmp_path)
    assert code in (0, 1)
    assert said
    assert "another configuration" not in warned
    code, said, _ = command("verify", serial, "--passes", "100")
    assert code in (0, 1), said


@pytest.mark.long
def test_a_grown_grid_keeps_what_is_there(config: Path, serial: Path, tmp_path: Path) -> None:
    larger, smaller = tmp_path / "larger.toml", tmp_path / "smaller.toml"
    larger.write_text(config.read_text(), encoding="utf-8")
    smaller.write_text(config.read_text().replace("to = 30", "to = 26"), encoding="utf-8")
    out = tmp_path / "out"
    assert run(smaller, out, InThisProcess(answer)) == run(larger, out, InThisProcess(answer)) == 0
    assert len(events(out, "started")) == 3
    kept, new = contents(out), contents(serial)
    # Tables are stamped with the configuration of the last run, whichever run computed them; results are not.
    assert {name: kept[name] for name in new if not name.startswith("sweep/units")} == {
        name: content for name, content in new.items() if not name.startswith("sweep/units")
    }
