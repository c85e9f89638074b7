"""Watches that go on night by night.

A watch that goes on night by night finds what a watch on all passes finds; what it keeps is whole or refused.
`hump watch`, night by night: what has drifted is first on the list, once, until it is repaired.
"""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np
import pytest

from scripts.studies.identification import Yard, text_of_classes
from synth.cli import main
from synth.logs.drift import kept_watch
from synth.logs.drift.charts import limit_of, page_sums
from synth.logs.drift.evidence import configured
from synth.logs.drift.kept_watch import KeptWatch, WatchedNight, from_npz, to_npz, watched_night
from synth.logs.drift.watch import watch
from synth.logs.fitting_passes import FittingPasses, fitting_passes
from tests.system.test_hump_trials import SMALL
from tuning_tables import DamagedTable
from tuning_tables.pass_log.log_files import write_log
from tuning_tables.pass_log.pass_log import PassLog

RUN_LENGTH = 10_000.0
BEGIN = 50
NIGHTS = ((0, 30), (30, 61), (61, 80))


@pytest.fixture(scope="module")
def biased(passes: FittingPasses) -> PassLog:
    """The sensor shows 0.1 m/s too much from a pass on."""
    log = passes.log
    return replace(log, speed_m_s=log.speed_m_s + np.where(log.pass_of_row >= BEGIN, 0.1, 0.0))


def nights(yard: Yard, log: PassLog, kept: KeptWatch) -> list[WatchedNight]:
    """The watch on a log that comes in three parts, and what it keeps goes through its file."""
    found = []
    for begin, end in NIGHTS:
        part = log.taken(np.arange(begin, end))
        found.append(watched_night(kept, part, yard.config, "the test", RUN_LENGTH))
        kept = from_npz(to_npz(found[-1].kept, "sha"), "the state", "sha")
    return found


def test_nights_are_one_watch(yard: Yard, biased: PassLog, monkeypatch: pytest.MonkeyPatch) -> None:
    passes = fitting_passes(biased, yard.config.plants(), "the test")
    values, slope_key = configured(passes, yard.config.parameters)
    whole = watch(passes, values, slope_key)
    assert whole.drift is not None
    assert whole.drift.diagnosis.first.cause.name == "sensor bias"
    begun = KeptWatch(values=MappingProxyType(values))
    *before, last = nights(yard, biased, begun)
    assert [each.found for each in before[:1]] == [None]
    assert last.found is not None
    assert last.limit == limit_of(len(whole.charts.kinds), RUN_LENGTH)
    assert last.found.charts.sums == pytest.approx(whole.charts.sums, abs=1e-9)
    assert last.found.drift is not None
    assert last.found.drift.diagnosis.alarm == whole.drift.diagnosis.alarm
    assert last.found.drift.size == whole.drift.size
    monkeypatch.setattr(kept_watch, "LEAST_KEPT", 8)  # what is forgotten is not missed
    monkeypatch.setattr(kept_watch, "MOST_KEPT", 20)
    *before, last = nights(yard, biased, begun)
    assert before[0].kept.first == NIGHTS[0][1] - 20
    assert last.found is not None
    assert last.found.drift is not None
    assert last.found.number_of[last.found.drift.diagnosis.first.begin] == BEGIN


def test_a_pass_that_comes_twice_counts_once(yard: Yard, passes: FittingPasses) -> None:
    one = watched_night(KeptWatch(), passes.log, yard.config, "the test", RUN_LENGTH)
    assert (one.new, one.found) == (len(passes), None)
    renamed = replace(passes.log, cut_id=tuple(f"again/{each}" for each in passes.log.cut_id))
    begun = one.kept.in_run(1, is_repaired=False)
    two = watched_night(begun, renamed, yard.config, "the test", RUN_LENGTH)
    assert two.new == 0
    assert to_npz(two.kept, "sha") == to_npz(begun, "sha")
    assert watched_night(two.kept, None, yard.config, "the test", RUN_LENGTH).highest == one.highest


def test_a_run_that_goes_on_counts_what_the_killed_one_has_read() -> None:
    kept = replace(KeptWatch(), first=7, new=40, run=3)
    assert (kept.in_run(3, False).new, kept.in_run(4, False).new) == (40, 0)
    repaired = kept.in_run(4, True)
    assert (repaired.watched, repaired.run, repaired.new) == (0, 4, 0)
    stored = replace(repaired, first=5, new=20)
    assert stored.in_run(4, True).watched == stored.watched == 5
    assert (stored.in_run(4, True).new, stored.in_run(5, True).watched) == (20, 0)


def test_what_is_kept_is_whole_or_refused(yard: Yard, passes: FittingPasses) -> None:
    kept = watched_night(KeptWatch(), passes.log, yard.config, "the test", RUN_LENGTH).kept
    content = to_npz(kept, "sha")
    read = from_npz(content, "the state", "sha")
    assert to_npz(read, "sha") == content
    other = from_npz(content, "the state", "of new tables")
    assert (other.watched, other.log, len(other.seen)) == (0, None, len(passes))
    assert watched_night(other, passes.log, yard.config, "the test", RUN_LENGTH).new == 0
    for damaged in (content[:-1], content.replace(b"sha", b"shb", 1)):
        with pytest.raises(DamagedTable, match="the state"):
            from_npz(damaged, "the state", "sha")


def test_sums_go_on_where_they_ended() -> None:
    steps = np.random.default_rng(3).normal(-0.1, 1.0, (60, 4))
    whole = page_sums(steps)
    plain = np.zeros(4)
    for step, told in zip(steps, whole, strict=True):
        plain = np.maximum(plain + step, 0.0)
        assert told == pytest.approx(plain, abs=1e-9)
    assert page_sums(steps[25:], whole[24]) == pytest.approx(whole[25:], abs=1e-9)


def test_sums_that_do_not_belong_to_the_passes_are_refused() -> None:
    forged = replace(KeptWatch(), names=("friction 0.9",), sums=np.zeros((3, 1)))
    with pytest.raises(DamagedTable, match="0 passes and 1 charts have sums of the shape"):
        from_npz(to_npz(forged, "a"), "kept", "a")
    with pytest.raises(DamagedTable, match="the hashes of passes"):
        from_npz(to_npz(replace(KeptWatch(), first=-1), "a"), "kept", "a")
    assert from_npz(to_npz(KeptWatch(), "a"), "kept", "a").log is None


YARD = """\
config = "knp-5.toml"
trial = "trial.toml"
[cost]
number = 20
[output]
plots = false
[[position]]
name = "calm"
[[position]]
name = "Park 1"
retarder = 421
"""


def night(root: Path, number: int, passes: FittingPasses, bias_m_s: float) -> None:
    """A night's logs of both positions; the sensor of one shows too much."""
    part = passes.log.taken(np.arange(40 * number, 40 * number + 40))
    for name, off in (("calm", 0.0), ("Park 1", bias_m_s)):
        (root / "logs" / name).mkdir(parents=True, exist_ok=True)
        write_log(replace(part, speed_m_s=part.speed_m_s + off), root / "logs" / name / f"{number}.csv")


def test_a_yard_is_watched_night_by_night(
    passes: FittingPasses, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")
    for name, text in (("yard.toml", YARD), ("trial.toml", SMALL), ("knp-5.toml", text_of_classes())):
        Path(name).write_text(text, encoding="utf-8")

    def watched(*words: str) -> tuple[int, Any]:
        code = main(["hump", "watch", "yard.toml", "-o", "out", "-q", *words])
        return code, json.loads(Path("out/summary.json").read_bytes())

    assert main(["hump", "watch", "yard.toml", "-o", "out"]) == 2
    assert "there is no such file or folder" in capsys.readouterr().err
    night(tmp_path, 0, passes, 0.0)
    code, told = watched()
    assert (code, told["figures"]["drifted"], told["figures"]["new_passes"]) == (0, 0, 80)
    Path("out/summary.json").unlink()  # as if it had been killed just before: every position is stored
    assert watched() == (code, told)
    night(tmp_path, 1, passes, 0.1)
    code, told = watched()
    assert (code, told["figures"]["drifted"], told["figures"]["new_passes"]) == (1, 1, 80)
    (first,) = told["tables"]["repairs"]
    assert (first["rank"], first["position"], first["cause"]) == (1, "Park 1", "sensor bias")
    assert first["weight_per_hour"]["n"] == 20
    (evidence,) = told["tables"]["evidence"]
    assert evidence["begin"]["value"] == 41
    # Only what the sensor showed was changed: its bias is taken off the exits.
    assert evidence["mean_since_m_s"]["value"] == pytest.approx(evidence["mean_before_m_s"]["value"], abs=0.02)
    code, again = watched()
    assert (code, again["figures"]["new_passes"]) == (1, 0)
    assert again["tables"]["repairs"] == told["tables"]["repairs"]
    code, told = watched("--repaired", "Park 1")
    assert (code, told["figures"]["drifted"]) == (0, 0)
    Path("yard.toml").write_text(YARD.replace("retarder = 421", "retarder = 499"), encoding="utf-8")
    assert main(["hump", "watch", "yard.toml", "-o", "out"]) == 2
    assert "retarder is 499; on the hump of the trial stand 401" in capsys.readouterr().err


def test_a_position_without_new_passes_is_told(passes: FittingPasses, tmp_path: Path) -> None:
    night(tmp_path, 0, passes, 0.0)
    (tmp_path / "knp-5.toml").write_text(text_of_classes(), encoding="utf-8")
    text = 'config = "knp-5.toml"\n[[position]]\nname = "calm"\n[[position]]\nname = "silent"\n'
    (tmp_path / "yard.toml").write_text(text + "[output]\nplots = false\nreport = false\n", encoding="utf-8")
    assert main(["hump", "watch", str(tmp_path / "yard.toml"), "-o", str(tmp_path / "out")]) == 1
    told = json.loads((tmp_path / "out" / "summary.json").read_bytes())
    assert told["accepted"] is False
    assert [each["kept"] for each in told["limits"]] == [True, None]
    assert "no new passes of silent" in told["limits"][1]["sentence"]
