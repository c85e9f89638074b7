"""A sweep that is killed at any moment goes on, computes only what was under way, and ends with the same bytes."""

from __future__ import annotations

import json
import random
import signal
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from synth.retarder.sweep.ledger import DONE, STARTED
from tests.sweep.conftest import Ran, begin, contents, events, kill_and_reap, wait_until


def test_a_killed_sweep_resumes_to_the_same_bytes(config: Path, serial: Path, tmp_path: Path) -> None:
    out, rng = tmp_path / "out", random.Random(20261121)
    for done in (0, 1, 2):
        sweep = begin("sweep", "run", config, "-o", out, "--workers", "1")

        def under_way(done: int = done) -> bool:
            return len(events(out, DONE)) >= done and len(events(out, STARTED)) > done

        wait_until(under_way, sweep)
        time.sleep(rng.uniform(0.0, 0.3))
        kill_and_reap(sweep)
    before = {event["unit"] for event in events(out, DONE)}
    assert len(before) >= 2
    begun = len(events(out, STARTED))
    last = begin("sweep", "run", config, "-o", out, "--workers", "1")
    assert last.communicate(timeout=120) is not None
    assert last.returncode == 0
    again = [event["unit"] for event in events(out, STARTED)[begun:]]
    assert before.isdisjoint(again)
    assert len(again) <= 3 - len(before)
    assert contents(out) == contents(serial)


@pytest.mark.skipif(not Path("/proc/self/task").is_dir(), reason="children are found in /proc")
def test_workers_end_with_a_killed_sweep(config: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    sweep = begin("sweep", "run", config, "-o", out, "--workers", "2")
    wait_until(lambda: len(events(out, STARTED)) >= 2, sweep)
    workers = [pid for pid in children_of(sweep.pid) if b"spawn_main" in command_of(pid)]
    kill_and_reap(sweep)
    assert len(workers) == 2
    deadline = time.monotonic() + 10.0
    while any(b"spawn_main" in command_of(pid) for pid in workers):
        assert time.monotonic() < deadline
        time.sleep(0.05)


def test_ctrl_c_says_how_to_go_on(config: Path, tmp_path: Path) -> None:
    """Of so many units that they cannot all be done before the signal comes, however busy the machine is."""
    many, out = tmp_path / "many.toml", tmp_path / "out"
    many.write_text(config.read_text(encoding="utf-8").replace("step = 4 }", "step = 0.25 }"), encoding="utf-8")
    sweep = begin("sweep", "run", many, "-o", out, "--workers", "1")
    wait_until(lambda: events(out, DONE), sweep)
    sweep.send_signal(signal.SIGINT)
    told = time.monotonic()
    _, said = sweep.communicate(timeout=60)
    assert time.monotonic() - told < 5.0
    assert sweep.returncode == 130
    assert f"{out} holds no complete summary, but what the same command goes on from" in said
    assert "Traceback" not in said
    assert not (out / "summary.json").exists()


def children_of(pid: int) -> set[int]:
    tasks = Path(f"/proc/{pid}/task").glob("*/children")
    return {int(child) for task in tasks for child in task.read_text().split()}


def command_of(pid: int) -> bytes:
    try:
        return Path(f"/proc/{pid}/cmdline").read_bytes()
    except OSError:
        return b""


@pytest.mark.long
def test_status_while_it_runs(command: Callable[..., Ran], config: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    sweep = begin("sweep", "run", config, "-o", out, "--workers", "1")
    wait_until(lambda: events(out, DONE), sweep)
    status = json.loads(command("sweep", "status", out, "--json")[1])
    kill_and_reap(sweep)
    assert status["units"] == 3
    assert 1 <= status["done"] <= 3
    assert status["running"] or status["complete"]
    if status["running"] and status["done"] < 3:
        assert status["rate_units_per_min"] > 0.0
        assert status["remaining_s"] > 0.0
    status = json.loads(command("sweep", "status", out, "--json")[1])
    assert not status["running"]
    assert status["in_flight"] == []
