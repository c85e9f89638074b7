"""Large runs of trains: the same bytes however they are split, killed, or damaged, and nothing is humped twice."""

from __future__ import annotations

import json
import os
import shutil
import signal
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

import pytest

from synth.frame.command import Unfinished
from synth.frame.results_directory import results_directory
from synth.frame.workers.engine import Answer, InThisProcess, missing_of
from synth.frame.workers.local_workers import LocalWorkers
from synth.hump.rolling.outcomes import joined
from synth.hump.trains.batch import BatchOrder, answer_batch, orders_of
from synth.hump.trains.outcome_file import to_npz, trains_of
from synth.hump.trains.train_run import TrialRun, run_of, run_trials
from synth.hump.trial.made_trial import made_trial
from synth.hump.trial.resolved_trial import load_trial
from synth.hump.trial.trial import BATCH
from tests.effort import every
from tests.sweep import poison
from tests.sweep.conftest import Ran, begin, contents, kill_and_reap, wait_until
from tuning_tables.whole_file import seal_of


def batch_file(out: Path, key: str) -> Path:
    """The file of a batch in `out`."""
    return out / "batches" / f"{key}.npz"


@contextmanager
def run_in(out: Path, trial: Path) -> Iterator[TrialRun]:
    """The batches of `trial` in `out`, which is held."""
    config = load_trial(trial)
    with results_directory(out, "hump simulate") as directory:
        yield run_of(config, made_trial(config), config.settings.trains.number, directory)


def test_batches_of_any_size_are_the_same_trains(trial: Path, humped: Path) -> None:
    """As one batch, one by one, and in uneven parts: the arrays of the file that the command wrote."""
    config = load_trial(trial)
    made = made_trial(config)
    of_trial = trains_of(config)
    written = batch_file(humped, next(iter(orders_of(made, config.trains_sha256, BATCH))).key)
    some = joined([made.batch(0, 1), made.batch(1, 6), made.batch(7, BATCH - 7)])
    assert to_npz(some, replace(of_trial, trains_sha256=written.stem)) == written.read_bytes()


@pytest.mark.long
def test_a_killed_run_goes_on_to_the_same_bytes(trial: Path, humped: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    run = begin("hump", "simulate", trial, "-o", out, "--workers", "1")
    wait_until(lambda: list((out / "batches").glob("*.npz")), run)
    kill_and_reap(run)
    kept = {path.name: path.stat().st_mtime_ns for path in (out / "batches").glob("*.npz")}
    assert not (out / "summary.json").exists()
    assert kept
    (out / "batches" / f".{next(iter(kept))}.{'0' * 16}.part").touch()
    again = begin("hump", "simulate", trial, "-o", out, "--workers", "2")
    _, said = again.communicate(timeout=300)
    assert again.returncode == 0
    if len(kept) < 3:
        assert f"{len(kept)} of 3 batches are there already" in said
    assert {name: (out / "batches" / name).stat().st_mtime_ns for name in kept} == kept
    assert contents(out) == contents(humped)


@pytest.mark.long
def test_a_worker_that_is_killed_loses_nothing(
    trial: Path, humped: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("DIED_ONCE", str(tmp_path / "mark"))
    watcher = Told()
    with run_in(tmp_path / "out", trial) as run:
        run_trials((run,), lambda batches: LocalWorkers(2, poison.batch_dying_once), watcher)
    assert (tmp_path / "mark").exists()
    for order in run.orders:
        assert batch_file(tmp_path / "out", order.key).read_bytes() == batch_file(humped, order.key).read_bytes()
    assert len(watcher.ended) == 3


def test_a_batch_that_cannot_be_humped_is_told_and_the_others_stay(trial: Path, tmp_path: Path) -> None:
    def refusing(order: BatchOrder) -> Answer:
        return answer_batch(order) if order.first == 0 else Answer(order.key, None, "no cars")

    with run_in(tmp_path, trial) as run:
        with pytest.raises(Unfinished, match=f"trains {BATCH + 1} to {2 * BATCH}: no cars"):
            run_trials((run,), lambda batches: InThisProcess(refusing), Told())
        assert [order.first for order in missing_of(run.orders, run.files.file, run.files.stored, Told())] == [
            BATCH,
            2 * BATCH,
        ]


def test_a_worker_of_another_version_is_refused(trial: Path) -> None:
    config = load_trial(trial)
    order = next(iter(orders_of(made_trial(config), config.trains_sha256, 1)))
    answer = answer_batch(replace(order, software="0" * 64))
    assert answer.result is None
    assert "another version of retarder-synth" in answer.reason


@pytest.mark.long
def test_more_trains_keep_those_that_are_there_and_another_trial_keeps_none(
    command: Callable[..., Ran], trial: Path, humped: Path, tmp_path: Path
) -> None:
    out = tmp_path / "out"
    assert command("hump", "simulate", trial, "-o", out, "--trains", BATCH)[0] == 0
    _, _, said = command("hump", "simulate", trial, "-o", out)
    assert "1 of 3 batches are there already" in said
    assert contents(out) == contents(humped)
    assert command("hump", "simulate", trial, "-o", out, "--trains", 2, "--seed", 1)[0] == 0
    assert [path.name.split("-")[1:] for path in (out / "batches").iterdir()] == [["0", "2.npz"]]


def bit_flipped(content: bytes, other: bytes) -> bytes:
    return content[:100] + bytes([content[100] ^ 1]) + content[101:]


def other_batch(content: bytes, other: bytes) -> bytes:
    return other


def no_batch(content: bytes, other: bytes) -> bytes:
    return b"PK" + seal_of(b"PK")


@pytest.mark.parametrize("damage", every(2, [other_batch, bit_flipped, no_batch]))
def test_a_damaged_batch_is_humped_again(
    command: Callable[..., Ran],
    trial: Path,
    humped: Path,
    tmp_path: Path,
    damage: Callable[[bytes, bytes], bytes],
) -> None:
    out = Path(shutil.copytree(humped, tmp_path / "out"))
    victim, other = sorted((out / "batches").iterdir())[:2]
    victim.write_bytes(damage(victim.read_bytes(), other.read_bytes()))
    code, _, said = command("hump", "simulate", trial, "-o", out)
    assert code == 0
    assert f"{victim} is damaged; " in said
    assert contents(out) == contents(humped)


def test_its_own_inputs_make_the_same_files_again(command: Callable[..., Ran], humped: Path, tmp_path: Path) -> None:
    out = Path(shutil.copytree(humped, tmp_path / "elsewhere"))
    for name in ("summary.json", "sheets/shares.csv", "sheets/program.csv", "trains.npz"):
        (out / name).unlink()
    config = out / "inputs" / "config.toml"
    code, told, said = command("hump", "simulate", config, "-o", out, "--json")
    assert code == 0
    assert "3 of 3 batches are there already" in said
    assert json.loads(told) == json.loads((humped / "summary.json").read_bytes())
    assert contents(out) == contents(humped)
    config.write_text(config.read_text(encoding="utf-8").replace("cuts = 3", "cuts = 4"), encoding="utf-8")
    code, _, said = command("hump", "simulate", config, "-o", out)
    assert code == 2
    assert f"{config}: it was changed after retarder-synth wrote it" in said


def test_ctrl_c_keeps_what_is_humped(trial: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    run = begin("hump", "simulate", trial, "-o", out, "--trains", 400 * BATCH, "--workers", "1")
    wait_until(lambda: list((out / "batches").glob("*.npz")), run)
    os.kill(run.pid, signal.SIGINT)
    _, said = run.communicate(timeout=60)
    assert run.returncode == 130
    assert "the same command goes on" in said
    assert "Traceback" not in said


class Told:
    """A watcher that keeps what it is told."""

    def __init__(self) -> None:
        self.notes: list[str] = []
        self.ended: list[str] = []

    def begin(self, done: int) -> None:
        self.notes.append(f"{done} there")

    def note(self, sentence: str) -> None:
        self.notes.append(sentence)

    def done(self, sentence: str) -> None:
        self.ended.append(sentence)
