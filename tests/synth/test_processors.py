"""Commands find out on every system how many threads to take, and what the processor is."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from synth.frame.processors import available, processor_name


def test_as_many_as_this_process_may_use(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(os, "sched_getaffinity", lambda process: {0, 3, 5}, raising=False)
    assert available() == 3


def test_all_where_the_system_does_not_tell(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delattr(os, "sched_getaffinity", raising=False)
    monkeypatch.setattr(os, "cpu_count", lambda: 8)
    assert available() == 8
    monkeypatch.setattr(os, "cpu_count", lambda: None)
    assert available() == 1


def test_the_processor_names_itself(tmp_path: Path) -> None:
    told = tmp_path / "cpuinfo"
    told.write_text("processor : 0\nmodel name\t: A Processor of 3 GHz\n", encoding="utf-8")
    assert processor_name(told) == "A Processor of 3 GHz"
    assert processor_name(tmp_path / "none")
