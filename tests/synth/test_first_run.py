"""A second process compiles beside a first run, and ends with it."""

from __future__ import annotations

import sys
import time

import pytest

from synth.retarder import first_run
from synth.retarder.first_run import compiled_beside

WAITS_FOR_EVER = (sys.executable, "-c", "import time; time.sleep(600)")
FAILS = (sys.executable, "-c", "raise SystemExit(1)")
SUCCEEDS = (sys.executable, "-c", "pass")


def ran(command: tuple[str, ...], seconds: float) -> list[str]:
    """What is told where the block takes so many seconds."""
    told: list[str] = []
    with compiled_beside(told.append, command):
        time.sleep(seconds)
    return told


def test_where_kernels_are_kept_nothing_is_begun(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(first_run, "first_time", lambda: False)
    assert ran(("no such program",), 0.0) == []


def test_it_tells_when_the_second_process_has_done_its_work(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(first_run, "first_time", lambda: True)
    begun, done = ran(SUCCEEDS, 2.0)
    assert "in two processes" in begun
    assert "beside the others" in done


@pytest.mark.parametrize("command", [WAITS_FOR_EVER, FAILS])
def test_one_that_is_not_done_is_ended_and_tells_nothing(
    monkeypatch: pytest.MonkeyPatch, command: tuple[str, ...]
) -> None:
    monkeypatch.setattr(first_run, "first_time", lambda: True)
    began = time.monotonic()
    assert len(ran(command, 0.3)) == 1
    assert time.monotonic() - began < 10.0
