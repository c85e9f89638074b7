"""Waiting times and the error of integration: processes that end, and passes whose differences are known."""

from __future__ import annotations

import os
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from synth.frame.input_error import InputError
from synth.simulation.passes import PassTrace
from synth.studies.integration_error import commands_of, compared
from synth.studies.times.commands import NO_PICTURES, run_process, tune_calls
from synth.studies.times.findings import Waited
from synth.studies.timing.turns import Times


@pytest.mark.parametrize("code", [0, 1])
def test_a_process_that_misses_limits_is_a_complete_run(code: int) -> None:
    run_process([sys.executable, "-c", f"raise SystemExit({code})"])


def test_a_process_that_fails_is_told_with_its_last_line() -> None:
    with pytest.raises(InputError, match=r"ended with 2: the end$"):
        run_process([sys.executable, "-c", "import sys; print('more\\nthe end', file=sys.stderr); sys.exit(2)"])


def test_a_process_gets_the_cache_that_is_asked_for_and_not_that_of_this_process(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("NUMBA_CACHE_DIR", "mine")
    told = tmp_path / "told"
    text = (
        f"import os; open({str(told)!r}, 'w').write(str(os.environ.get('NUMBA_CACHE_DIR')) + ' ' + os.environ['{{}}'])"
    )
    run_process([sys.executable, "-c", text.format("RETARDER_SYNTH_CACHE")], tmp_path / "cache")
    assert told.read_text() == f"None {tmp_path / 'cache'}"
    assert os.environ["NUMBA_CACHE_DIR"] == "mine"


def test_a_tune_of_the_default_book_is_also_timed_without_pictures(tmp_path: Path) -> None:
    assert set(tune_calls(tmp_path, None, cold=True)) == {
        "tune, warm",
        "tune, nothing compiled",
        "tune, warm, without pictures and report",
    }
    assert (tmp_path / "bare.toml").read_text() == NO_PICTURES
    assert set(tune_calls(tmp_path, tmp_path / "own.toml", cold=False)) == {"tune, warm"}


def test_a_time_is_told_with_its_extremes() -> None:
    assert Waited("a", Times((9.03, 9.0, 9.1), (1.0, 1.0, 1.0))).cell == "9.03 s (9 to 9.1, n = 3)"


def trace(exit_m_s: float, stages: list[int]) -> PassTrace:
    n = len(stages)
    return PassTrace(
        time_s=np.arange(float(n)) * 0.1,
        path_m=np.arange(float(n)),
        speed_m_s=np.full(n, exit_m_s),
        overpressure_kpa=np.zeros(n),
        stage=np.array(stages),
        measured_m_s=np.full(n, np.nan),
        stalled=False,
    )


def test_commands_are_the_changes_of_stage() -> None:
    assert commands_of(trace(3.0, [0, 0, 1, 1, 0])) == [(0.2, 1), (0.4, 0)]


def test_passes_with_other_commands_count_for_the_share_alone() -> None:
    truth = [trace(3.0, [0, 1, 1]), trace(3.0, [0, 1, 1]), trace(3.0, [0, 1, 1])]
    mine = [trace(3.003, [0, 1, 1]), trace(2.996, [0, 1, 1]), trace(4.0, [0, 0, 1])]
    row = compared(5, mine, truth)
    assert row.same == pytest.approx(2.0 / 3.0)
    assert row.rms_m_s == pytest.approx(np.sqrt((0.003**2 + 0.004**2) / 2.0))
    assert row.largest_m_s == pytest.approx(0.004)
    assert compared(5, mine[2:], truth[2:]) == replace(row, same=0.0, rms_m_s=0.0, largest_m_s=0.0)
