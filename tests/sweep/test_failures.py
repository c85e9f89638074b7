"""A case that cannot be computed is told, stops nothing else, and is tried again by the next run."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from synth.frame.interval import Interval
from synth.frame.workers.engine import InThisProcess, Work
from synth.frame.workers.local_workers import LocalWorkers
from synth.retarder.sweep.book_figures import BookFigures, Failure
from synth.retarder.sweep.heat_map import heat_map
from synth.retarder.sweep.sweep_file import parse_sweep
from tests.sweep import poison
from tests.sweep.conftest import COMMAND, Ran, contents, events, run
from tuning_tables import read_book


@pytest.mark.long
@pytest.mark.parametrize(
    ("work", "reason"),
    [
        pytest.param(poison.refusing, "friction.common_cv is -1.0", marks=pytest.mark.long),
        (poison.dying, "its worker was ended by SIGKILL, 2 times in 2"),
    ],
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
        patch.setattr("synth.retarder.sweep.command.engine_for", lambda *ignored: LocalWorkers(2, work))
        code, told, said = command("sweep", "run", config, "-o", out)
    assert code == 1
    assert f"not accepted: there is no table for {poison.POISONED}: " in told
    assert reason in told
    assert sum(f"{poison.POISONED} failed: " in line for line in said.splitlines()) == 1
    assert {table.cut.mass_t for table in read_book(out / "book.h5")} == {22.0, 30.0}

    code, listed, _ = command("sweep", "failed", out)
    assert code == 0
    assert listed.startswith(f"{poison.POISONED}: ")
    assert reason in listed
    assert "2 of 3 units done, 1 failed" in command("sweep", "status", out)[1]

    code, _, said = command("sweep", "run", config, "-o", out, "--workers", "1")
    assert code == 0, said
    assert "2 of 3 units are there already" in said
    assert "no unit has failed" in command("sweep", "failed", out)[1]
    assert contents(out) == contents(serial)


TOO_COARSE = """\
[regulator]
approach_m = 0.0
estimator = false
[grid]
path_step_m = 2.0
speed_step_m_s = 0.2
friction_scenarios = 2
resistance_scenarios = 1
[criterion]
overspeed_factor = 1000
[sweep]
exit_speeds_m_s = {speeds}
passes = 1000
[[sweep.cut]]
car = "gondola-4"
mass_per_car_t = [22, 85]
"""


@pytest.mark.long
def test_a_target_without_a_table_loses_none_but_itself(command: Callable[..., Ran], tmp_path: Path) -> None:
    def swept(name: str, speeds: str) -> tuple[int, str]:
        (tmp_path / f"{name}.toml").write_text(TOO_COARSE.format(speeds=speeds), encoding="utf-8")
        code, out, said = command("sweep", "run", tmp_path / f"{name}.toml", "-o", tmp_path / name, "--workers", "1")
        return code, out + said

    code, said = swept("some", "[2.0, 3.0, 3.5, 4.0]")
    assert code == 1
    assert "targets without a table: 1" in said
    assert "there is no table for gondola-4-22t to 3.5 m/s: the grid is too coarse" in said
    code, listed, _ = command("sweep", "failed", tmp_path / "some")
    assert [line.split(":")[0] for line in listed.splitlines()] == ["gondola-4-22t to 3.5 m/s"]
    status = command("sweep", "status", tmp_path / "some")[1]
    assert "complete; 2 of 2 units done, 0 failed, targets without a table: 1" in status
    summary = json.loads((tmp_path / "some" / "summary.json").read_text(encoding="utf-8"))
    assert [(each["label"], each["target_m_s"]) for each in summary["tables"]["failed"]] == [("gondola-4-22t", 3.5)]
    (condition,) = parse_sweep((tmp_path / "some.toml").read_text(encoding="utf-8"), "x").conditions
    cases = tuple({**case, "rms_m_s": Interval(**case["rms_m_s"])} for case in summary["tables"]["cases"])
    failures = (Failure("", "gondola-4-22t", "it is too coarse", 3.5),)
    axes = heat_map(BookFigures(condition, cases, (), failures)).axes[0]
    tables, empty = axes.collections[:2]
    assert (len(tables.get_paths()), len(empty.get_paths())) == (7, 1)
    assert axes.get_title(loc="left").endswith("hatched: no table")
    assert swept("some", "[2.0, 3.0, 3.5, 4.0]")[0] == 1  # it is known, and not computed again
    assert len(events(tmp_path / "some", "started")) == 2

    assert swept("others", "[2.0, 3.0]")[0] == 0
    some, others = (
        {table.id: (table.stages, table.predicted, table.validated) for table in read_book(tmp_path / name / "book.h5")}
        for name in ("some", "others")
    )
    assert len(others) == 4
    assert set(some) - set(others) == {"gondola-4-22t-to-4-m-s", "gondola-4-85t-to-3.5-m-s", "gondola-4-85t-to-4-m-s"}
    assert {name: some[name] for name in others} == others


def test_a_class_without_any_table_has_failed(command: Callable[..., Ran], tmp_path: Path) -> None:
    (tmp_path / "sweep.toml").write_text(TOO_COARSE.format(speeds="[3.5]"), encoding="utf-8")
    code, told, _ = command("sweep", "run", tmp_path / "sweep.toml", "-o", tmp_path / "out", "--workers", "1")
    assert code == 1
    assert "there is no table for gondola-4-22t: the grid is too coarse" in told
    assert "1 of 2 units done, 1 failed\n" in command("sweep", "status", tmp_path / "out")[1]


@pytest.mark.long
def test_refining_gives_up_a_class_with_a_target_without_a_table(command: Callable[..., Ran], tmp_path: Path) -> None:
    text = TOO_COARSE.format(speeds="[3.0, 3.5]").replace("[sweep]", "[sweep]\ninterpolation_loss_m_s = 0.5")
    (tmp_path / "sweep.toml").write_text(text, encoding="utf-8")
    code, _, said = command("sweep", "run", tmp_path / "sweep.toml", "-o", tmp_path / "out", "--workers", "1")
    assert code == 1
    assert "gondola-4-22t failed: the grid is too coarse" in said
    assert {table.cut.mass_t for table in read_book(tmp_path / "out" / "book.h5")} == {85.0}


@pytest.mark.long
def test_a_worker_that_dies_once_costs_nothing_but_time(
    monkeypatch: pytest.MonkeyPatch, config: Path, serial: Path, tmp_path: Path
) -> None:
    monkeypatch.setenv("DIED_ONCE", str(tmp_path / "died"))
    assert run(config, tmp_path / "out", LocalWorkers(2, poison.dying_once)) == 0
    assert (tmp_path / "died").exists()
    assert len(events(tmp_path / "out", "started")) == 4
    assert contents(tmp_path / "out") == contents(serial)


def test_another_program_on_a_worker_is_refused(config: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    assert run(config, out, InThisProcess(poison.strange)) == 1
    failed = json.loads((out / "summary.json").read_text(encoding="utf-8"))["tables"]["failed"]
    assert len(failed) == 3
    assert "another version of retarder-synth" in failed[0]["reason"]
    assert not (out / "book.h5").exists()


def test_a_full_memory_is_refused_before_anything_is_computed(
    command: Callable[..., Ran], monkeypatch: pytest.MonkeyPatch, config: Path, tmp_path: Path
) -> None:
    monkeypatch.setattr("synth.retarder.sweep.run.available_memory_bytes", lambda: 100 * 2**20)
    code, out, said = command("sweep", "run", config, "-o", tmp_path / "out")
    assert (code, out) == (2, "")
    assert "make a step larger" in said
    assert [line for line in said.splitlines() if "warning: " not in line] == [said.splitlines()[-1]]
    monkeypatch.setattr("synth.retarder.sweep.run.available_memory_bytes", lambda: 800 * 2**20)
    code, _, said = command("sweep", "run", config, "-o", tmp_path / "out", "--workers", "3")
    assert code == 0
    assert "memory allows for 1 of 3 workers" in said


WORKERS_WITHOUT_A_CACHE = """
import sys
from pathlib import Path
from synth.frame.terminal.telling import leave
from synth.frame.workers.local_workers import LocalWorkers
from synth.retarder.sweep.plan import plan_of
from synth.retarder.sweep.sweep_file import parse_sweep
from tests.sweep.poison import caching
orders = [unit.order for unit in plan_of(parse_sweep(Path(sys.argv[1]).read_text(), "x"), "2020-01-01T00:00:00Z").units]
print({answer.reason for answer in LocalWorkers(2, caching).answers(orders, lambda order: None)}, flush=True)
leave(0)
"""


def test_workers_leave_no_kernel_cache_of_their_own(config: Path, tmp_path: Path) -> None:
    nowhere = {"RETARDER_SYNTH_CACHE": "", "XDG_CACHE_HOME": "", "HOME": "/proc/none", "NUMBA_CACHE_DIR": ""}
    ran = subprocess.run(
        [sys.executable, "-c", WORKERS_WITHOUT_A_CACHE, str(config)],
        env={**os.environ, **nowhere, "TMPDIR": str(tmp_path), "PYTHONPATH": str(Path(__file__).parents[2])},
        capture_output=True, text=True, timeout=60, check=False,
    )  # fmt: skip
    assert ran.returncode == 0, ran.stderr
    assert ran.stdout.count(str(tmp_path)) == 1
    assert list(tmp_path.iterdir()) == []


def test_too_little_address_space_is_refused_before_a_worker_hangs_in_it(config: Path, tmp_path: Path) -> None:
    ran = subprocess.run(
        ["bash", "-c", 'ulimit -v 600000; exec "$@"', "-", *COMMAND, "sweep", "run", config, "-o", tmp_path / "out"],
        capture_output=True, text=True, timeout=20, check=False,
    )  # fmt: skip
    assert ran.returncode == 2
    assert "ulimit -v is 600000 kB, but the worker for gondola-4-" in ran.stderr
    assert "Traceback" not in ran.stderr
