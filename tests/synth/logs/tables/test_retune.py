"""Retuned tables against those tuned with the truth, and a log from which nothing more is to be gained."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from synth.cli import main
from synth.frame.command import Limit
from synth.frame.exhibits import File, Table
from synth.frame.told import rows_of
from synth.frame.workers.engine import Teller
from synth.logs.fitting_passes import fitting_passes
from synth.logs.retune.retune import GainOrder, Retuned, RetuneOrder, retune
from synth.logs.retune.shown import files
from synth.retarder.failed_case import FailedCase
from synth.simulation.closed_loop import TableController, simulate
from synth.simulation.sampled_pass import LoggedClass, mixed_log
from synth.simulation.stratified_passes import stratified_passes
from tuning_tables import ControllerTable, from_json, read_book, write_book
from tuning_tables.pass_log.log_files import write_log
from tuning_tables.pass_log.pass_log import PassLog

from .conftest import COARSE, CREATED, KNOWN_MEAN, TEXT, Yard

CASES = [("LS-1", 3.0), ("S-1", 3.0)]


def log_of(yard: Yard, tables: Yard, seed: int) -> PassLog:
    plants = dict(yard.config.plants())
    return mixed_log(
        [LoggedClass(plants[label], TableController(tables.tables[label, target]), target) for label, target in CASES],
        [150] * len(CASES), seed, None,
    )  # fmt: skip


@pytest.fixture(scope="module")
def retuned(known: Yard, worse: Yard) -> Retuned:
    passes = fitting_passes(log_of(worse, known, 3), known.config.plants(), "test")
    return retune(passes, known.source, RetuneOrder(known.tables, CREATED, threads=2), Teller(lambda _: None))


def test_the_retuned_tables_recover_what_can_be_recovered(retuned: Retuned, known: Yard, worse: Yard) -> None:
    """20 000 passes of the true plant: at least 80 % of what the tables tuned with the truth gain.

    The gain is 0.4 of the rms. The reserve of the library's `mean_cv` leaves 2 %, which is what designs for two nearly
    equal plants differ by, so the mean friction is taken as known here.
    """
    passes, plants = stratified_passes(99, 0, 20_000), dict(worse.config.plants())

    def rms(case: tuple[str, float], table: ControllerTable) -> float:
        sample = simulate(plants[case[0]], TableController(table), passes)
        return float(np.sqrt(sample.weight @ (sample.exit_speed_m_s - case[1]) ** 2 / sample.weight.sum()))

    for case, gain in zip(CASES, retuned.gains, strict=True):
        old, new, best = (rms(case, yard[case]) for yard in (known.tables, retuned.new, worse.tables))
        assert old - best > 0.05
        assert (old - new) / (old - best) >= 0.8
        assert gain in retuned.changed
        assert new / old == pytest.approx(gain.ratio, abs=0.05)


def test_the_new_book_states_the_identified_plant(retuned: Retuned) -> None:
    assert [(table.id, table.target_speed_m_s) for table in retuned.tables] == [
        (f"{label}-to-{target:g}-m-s", target) for label, target in CASES
    ]
    for table in retuned.tables:
        assert table.generator.config_sha256 == retuned.identified.sha256 != retuned.config.sha256
        assert table.validated is not None


def test_the_files_of_a_gain_are_its_book_and_each_of_its_tables(retuned: Retuned, tmp_path: Path) -> None:
    written = {each.name: each.content for each in files(retuned) if isinstance(each, File)}
    assert set(written) == {"book.h5", *(f"tables/{table.id}.json" for table in retuned.tables)}
    (tmp_path / "book.h5").write_bytes(written["book.h5"])
    assert read_book(tmp_path / "book.h5") == retuned.tables
    write_book(retuned.tables, tmp_path / "again.h5")
    assert (tmp_path / "again.h5").read_bytes() == written["book.h5"]
    assert tuple(from_json(written[f"tables/{table.id}.json"]) for table in retuned.tables) == retuned.tables


@pytest.mark.long
def test_what_a_log_gave_is_not_offered_again(
    retuned: Retuned, known: Yard, worse: Yard, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The same log and the tables that it gave: the new ones are these, so nothing is to be gained."""
    write_log(log_of(worse, known, 3), tmp_path / "log.h5")
    write_book(retuned.tables, tmp_path / "old.h5")
    (tmp_path / "c.toml").write_text(KNOWN_MEAN)
    words = ["--table", str(tmp_path / "old.h5"), "--config", str(tmp_path / "c.toml")]
    out = tmp_path / "out"
    assert main(["retune", str(tmp_path / "log.h5"), *words, "-o", str(out)]) == 1
    assert "within noise" in capsys.readouterr().out
    assert not (out / "book.h5").exists()
    summary = json.loads((out / "summary.json").read_text())
    assert not summary["accepted"]
    assert [case["table"] for case in summary["tables"]["cases"]] == ["kept: within noise"] * len(CASES)
    assert {case["ratio"]["n"] for case in summary["tables"]["cases"]} == {GainOrder().sets}
    assert {"report.html", "plots/retune-gains.svg"} <= set(summary["files"])


@pytest.mark.long
def test_a_replay_of_the_own_tables_commands_what_they_did(assumed: Yard, tmp_path: Path) -> None:
    write_log(log_of(assumed, assumed, 3), tmp_path / "log.h5")
    write_book(tuple(assumed.tables.values()), tmp_path / "old.h5")
    (tmp_path / "c.toml").write_text(TEXT + COARSE)
    words = ["--table", str(tmp_path / "old.h5"), "--config", str(tmp_path / "c.toml")]
    assert main(["replay", str(tmp_path / "log.h5"), *words, "--own", words[1], "-o", str(tmp_path / "again")]) == 0
    told = json.loads((tmp_path / "again" / "summary.json").read_text())
    own, _ = told["tables"]["agreement"]
    assert own["rows_same"] == own["rows_asked"] > 0
    assert main(["replay", str(tmp_path / "nothing.h5"), *words]) == 2


def test_a_case_without_a_new_table_keeps_its_old_one_and_is_told(retuned: Retuned, known: Yard) -> None:
    from synth.logs.retune.command import limits
    from synth.logs.retune.retune import book_of
    from synth.logs.retune.shown import gained

    first, second = CASES
    new = {first: retuned.new[first]}
    tables, kept = book_of(CASES, known.tables, new, {first})
    assert list(tables) == CASES
    assert kept == {second}
    assert tables[second] is known.tables[second]
    assert list(book_of(CASES, {first: known.tables[first]}, new, {first})[0]) == [first]  # nowhere a second one
    found = replace(retuned, failed=(FailedCase(*second, "the grid is too coarse"),))
    told = "S-1 to 3 m/s: no new table, the old one is kept: the grid is too coarse"
    assert list(limits(found))[-1] == Limit(told, False)
    (failed,) = (each for each in gained(found) if isinstance(each, Table) and each.name == "failed")
    assert rows_of(failed) == [{"label": "S-1", "target_m_s": 3.0, "reason": "the grid is too coarse"}]


def test_a_mixed_book_keeps_lines_without_a_proven_gain(retuned: Retuned, known: Yard, tmp_path: Path) -> None:
    from synth.logs.retune.retune import book_of
    from synth.logs.retune.tuned_books import class_setups, finished

    tables, kept = book_of(CASES, known.tables, retuned.new, {CASES[0]})
    assert kept == {CASES[1]}
    made = finished(class_setups(retuned.identified, CREATED), tables, kept)
    assert made[0].stages == retuned.new[CASES[0]].stages
    assert made[1].stages == known.tables[CASES[1]].stages
    assert made[1].predicted != known.tables[CASES[1]].predicted
    write_book(made, tmp_path / "b.h5")
    assert len(read_book(tmp_path / "b.h5")) == 2
