"""Commands find out how many threads to take on every system."""

from __future__ import annotations

import os

import pytest

from synth.frame.processors import available


def test_as_many_as_this_process_may_use(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(os, "sched_getaffinity", lambda process: {0, 3, 5}, raising=False)
    assert available() == 3


def test_all_where_the_system_does_not_tell(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delattr(os, "sched_getaffinity", raising=False)
    monkeypatch.setattr(os, "cpu_count", lambda: 8)
    assert available() == 8
    monkeypatch.setattr(os, "cpu_count", lambda: None)
    assert available() == 1
