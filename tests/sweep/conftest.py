"""A sweep of three cut classes and two targets on a coarse grid: a unit takes half a second."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from synth.cli import main
from synth.frame.own_files import MARKER
from synth.frame.workers.engine import Engine, InThisProcess
from synth.hump.trial.trial import BATCH
from synth.retarder.sweep.command import answer

EPOCH = "1700000000"
PLANT = """\
[position]
name = "rnz-2m-park"
[entry]
high_m_s = 4.0
[grid]
path_step_m = 1.0
speed_step_m_s = 0.05
friction_scenarios = 3
resistance_scenarios = 1
[fit]
degree = 2
"""
MEASURED = "[regulator]\nestimator = false\n"
SWEEP = """\
[sweep]
exit_speeds_m_s = { from = 1.5, to = 2.0, step = 0.5 }
passes = 1000
tables = true
[[sweep.cut]]
car = "gondola-4"
mass_per_car_t = { from = 22, to = 30, step = 4 }
"""
TRIAL = f"""\
hump = "medium"
[trains]
number = {2 * BATCH + 40}
cuts = 3
most_cars = 3
[hump_speed]
step_m_s = 0.4
[exit_speeds]
choices = 3
[aim]
design_cuts = 200
[acceptance]
catch_ups = 1.0
overspeed = 1.0
[output]
plots = false
report = false
"""
COMMAND = [sys.executable, "-c", "import sys; from synth.cli import main; raise SystemExit(main(sys.argv[1:]))"]


def run(config: Path, directory: Path, engine: Engine) -> int:
    """A run of the sweep in `config` by `engine`; the exit code."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("synth.retarder.sweep.command.engine_for", lambda *ignored: engine)
        return main(["sweep", "run", str(config), "-o", str(directory)])


def contents(directory: Path) -> dict[str, bytes]:
    """Every file by name but the ledger, which tells times, and the marker, which tells the number of the run."""
    files = {path.relative_to(directory).as_posix(): path for path in directory.rglob("*") if path.is_file()}
    return {name: path.read_bytes() for name, path in files.items() if name not in ("sweep/ledger.jsonl", MARKER)}


def events(directory: Path, kind: str) -> list[dict[str, Any]]:
    """The sound lines of a kind in the ledger, read without the code that is tested."""
    try:
        lines = (directory / "sweep" / "ledger.jsonl").read_text(encoding="utf-8").split("\n")
    except FileNotFoundError:
        return []
    found = [json.loads(line) for line in lines if line.endswith("}")]
    return [event for event in found if event["event"] == kind]


def begin(*arguments: object) -> subprocess.Popen[str]:
    """The command line in a process of its own, which a Ctrl-C reaches even where the tests run in the background."""
    return subprocess.Popen(
        [*COMMAND, *map(str, arguments)],
        env={**os.environ, "SOURCE_DATE_EPOCH": EPOCH},
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
        preexec_fn=hear_ctrl_c,
    )


def hear_ctrl_c() -> None:
    """Undo what a shell does to a process in the background."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


def wait_until(true: Callable[[], object], process: subprocess.Popen[str], longest_s: float = 90.0) -> None:
    """Until `true()`; fails if the process ends before."""
    deadline = time.monotonic() + longest_s
    while not true():
        assert process.poll() is None, process.communicate()[1]
        assert time.monotonic() < deadline
        time.sleep(0.02)


def kill_and_reap(process: subprocess.Popen[str]) -> None:
    """SIGKILL: nothing of the process can tidy up."""
    process.send_signal(signal.SIGKILL)
    process.communicate()


@pytest.fixture(autouse=True)
def dated(monkeypatch: pytest.MonkeyPatch) -> None:
    """All runs at the same time."""
    monkeypatch.setenv("SOURCE_DATE_EPOCH", EPOCH)


@pytest.fixture(scope="session")
def config(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The file of the sweep."""
    path = tmp_path_factory.mktemp("sweep") / "sweep.toml"
    path.write_text(PLANT + SWEEP, encoding="utf-8")
    return path


@pytest.fixture(scope="session")
def serial(config: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The directory of the sweep, computed in this process, one unit after the other; not to be changed."""
    directory = tmp_path_factory.mktemp("serial") / "out"
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("SOURCE_DATE_EPOCH", EPOCH)
        assert run(config, directory, InThisProcess(answer)) == 0
    return directory


@pytest.fixture(scope="session")
def trial(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The configuration: two full batches and a bit."""
    path = tmp_path_factory.mktemp("trains") / "trial.toml"
    path.write_text(TRIAL, encoding="utf-8")
    return path


@pytest.fixture(scope="session")
def humped(trial: Path) -> Path:
    """The directory of the trial, humped in one process by the command; not to be changed."""
    out = trial.parent / "out"
    process = begin("hump", "simulate", trial, "-o", out)
    assert process.communicate(timeout=300) is not None
    assert process.returncode == 0
    return out


Ran = tuple[int, str, str]


@pytest.fixture
def command(capfd: pytest.CaptureFixture[str]) -> Callable[..., Ran]:
    """Run the command line in this process: (exit code, stdout, stderr)."""

    def call(*arguments: object) -> Ran:
        capfd.readouterr()
        code = main([str(argument) for argument in arguments])
        return (code, *capfd.readouterr())

    return call
