"""A Dask cluster whose worker is killed, and a driver that is killed: all results are there, with the same bytes."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import pytest

from synth.retarder.sweep.ledger import DONE, STARTED
from tests.sweep.conftest import begin, contents, events, kill_and_reap, wait_until

pytestmark = pytest.mark.skipif(find_spec("distributed") is None, reason="the extra [sweep] is not installed")

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
