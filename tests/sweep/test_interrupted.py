"""A sweep that is killed, here or on a cluster, goes on and ends with the same bytes; a lost scheduler tells
nothing.
"""

from __future__ import annotations

import io
import json
import logging
import os
import random
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import pytest

from synth.frame.workers.dask_cluster import LOGGERS, SCHEDULER_LOST, silence
from synth.retarder.sweep.sweep_directory import DONE, STARTED
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


WITH_DISTRIBUTED = pytest.mark.skipif(find_spec("distributed") is None, reason="the extra [sweep] is not installed")

# In a process of its own: the library's threads and warnings are no concern of the tests.
CLUSTER = """
import json, sys
from distributed import Client, LocalCluster
if __name__ == "__main__":
    with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None, silence_logs=50) as cluster:
        client = Client(cluster)
        client.wait_for_workers(2)
        def pids():
            return list(client.run(lambda: __import__("os").getpid()).values())
        print(json.dumps([cluster.scheduler_address, pids()]), flush=True)
        sys.stdin.read()
"""


@pytest.fixture
def cluster(tmp_path: Path) -> Iterator[tuple[str, list[int]]]:
    """(address of the scheduler, process ids of its two workers)."""
    script = tmp_path / "cluster.py"
    script.write_text(CLUSTER, encoding="utf-8")
    process = subprocess.Popen(
        [sys.executable, script],
        env={**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))},
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
    )
    assert process.stdout is not None
    try:
        found: list[Any] = json.loads(process.stdout.readline())
        yield found[0], found[1]
    finally:
        process.communicate("", timeout=60)


@WITH_DISTRIBUTED
@pytest.mark.long
def test_killed_worker_and_killed_driver(
    config: Path, serial: Path, tmp_path: Path, cluster: tuple[str, list[int]]
) -> None:
    address, workers = cluster
    out = tmp_path / "out"
    first = begin("sweep", "run", config, "-o", out, "--scheduler", address)
    wait_until(lambda: events(out, STARTED), first)
    os.kill(workers[0], signal.SIGKILL)
    wait_until(lambda: events(out, DONE), first)
    kill_and_reap(first)
    before = {event["unit"] for event in events(out, DONE)}
    begun = len(events(out, STARTED))
    second = begin("sweep", "run", config, "-o", out, "--scheduler", address)
    _, said = second.communicate(timeout=120)
    assert second.returncode == 0, said
    assert before.isdisjoint(event["unit"] for event in events(out, STARTED)[begun:])
    assert contents(out) == contents(serial)


@WITH_DISTRIBUTED
@pytest.mark.long
def test_trains_on_a_cluster_whose_worker_and_driver_are_killed(
    trial: Path, humped: Path, tmp_path: Path, cluster: tuple[str, list[int]]
) -> None:
    address, workers = cluster
    out = tmp_path / "out"
    first = begin("hump", "simulate", trial, "-o", out, "--scheduler", address)
    wait_until(lambda: (out / "batches").is_dir(), first)
    os.kill(workers[0], signal.SIGKILL)
    wait_until(lambda: list((out / "batches").glob("*.npz")), first)
    kill_and_reap(first)
    second = begin("hump", "simulate", trial, "-o", out, "--scheduler", address)
    assert second.communicate(timeout=300) is not None
    assert second.returncode == 0
    assert contents(out) == contents(humped)


def test_the_whole_tree_of_loggers_is_silent_and_no_other() -> None:
    told = io.StringIO()
    handler = logging.StreamHandler(told)
    names = ["silent", "silent.client", "silent.client.deep", "silently"]
    loggers = [logging.getLogger(name) for name in names]
    for logger in loggers:
        logger.setLevel(logging.WARNING)
        logger.addHandler(handler)
        logger.propagate = False
    silence(("silent",))
    for logger in (*loggers, logging.getLogger("silent.later")):
        logger.critical("%s", logger.name)
    assert told.getvalue() == "silently\n"
    assert "distributed" in LOGGERS
    assert "sweep" not in SCHEDULER_LOST
