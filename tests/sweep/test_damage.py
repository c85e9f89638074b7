"""What lies in the directory is believed only where it is whole; one run at a time writes there."""

from __future__ import annotations

import json
import random
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from synth.frame.own_files import is_held
from synth.frame.results_directory import results_directory
from synth.frame.workers.engine import InThisProcess
from synth.retarder.sweep.command import answer
from synth.retarder.sweep.sweep_directory import DONE, PLAN, STARTED, SWEEP, LedgerWriter, SweepDirectory, read_ledger
from synth.retarder.sweep.unit_result import from_bytes, to_bytes
from tests.sweep.conftest import Ran, contents, events, run
from tests.tuning_tables.every_kind import altered, places
from tuning_tables import DamagedTable
from tuning_tables.json_text import canonical_json
from tuning_tables.whole_file import SEAL_BYTES, seal_of


def test_a_result_is_read_back_as_it_was(serial: Path) -> None:
    for path in (serial / "sweep" / "units").iterdir():
        content = path.read_bytes()
        assert to_bytes(from_bytes(content, "x")) == content


def test_every_flipped_bit_and_every_cut_of_a_result_is_noticed(serial: Path) -> None:
    rng = random.Random(20261121)
    content = next((serial / "sweep" / "units").iterdir()).read_bytes()
    for _ in range(300):
        flipped = bytearray(content)
        flipped[rng.randrange(len(content))] ^= 1 << rng.randrange(8)
        with pytest.raises(DamagedTable):
            from_bytes(bytes(flipped), "x")
    for length in (0, 1, len(content) // 2, len(content) - 1):
        with pytest.raises(DamagedTable):
            from_bytes(content[:length], "x")


def test_what_is_no_result_is_refused_under_a_right_seal(serial: Path) -> None:
    content = next((serial / "sweep" / "units").iterdir()).read_bytes()
    document = json.loads(content[:-SEAL_BYTES])
    asked = [path for path in places(document) if "table" not in path]
    for path in asked:
        body = canonical_json(altered(document, path, {}))
        with pytest.raises(DamagedTable, match=r"^x: sealed, but no result of a sweep \("):
            from_bytes(body + seal_of(body), "x")
    assert len(asked) > 30


def test_a_damaged_result_is_computed_again(
    config: Path, serial: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    out = Path(shutil.copytree(serial, tmp_path / "out"))
    bad = min((out / "sweep" / "units").iterdir())
    bad.write_bytes(bad.read_bytes().replace(b"3", b"4", 1))
    (out / "book.h5").unlink()
    assert run(config, out, InThisProcess(answer)) == 0
    assert len(events(out, STARTED)) == 4
    assert f"{bad} is damaged; what it held is computed again" in capfd.readouterr().err
    assert contents(out) == contents(serial)


def test_a_torn_ledger_is_passed_over_and_continued(
    command: Callable[..., Ran], config: Path, serial: Path, tmp_path: Path
) -> None:
    out = Path(shutil.copytree(serial, tmp_path / "out"))
    ledger = out / "sweep" / "ledger.jsonl"
    whole = ledger.read_bytes()
    lines = whole.splitlines(keepends=True)
    torn = b"".join(lines[:-1]) + lines[-1][:20]
    ledger.write_bytes(torn.replace(b'"event":"done"', b'"event":"dome"', 1))
    found = read_ledger(ledger)
    assert found.bad_lines == 2
    assert len(found.of(DONE)) == 2
    code, said, _ = command("sweep", "status", out)
    assert code == 0
    assert "2 lines of the ledger are torn or damaged" in said
    begun = len(events(out, STARTED))
    assert run(config, out, InThisProcess(answer)) == 0
    assert len(events(out, STARTED)) == begun
    assert read_ledger(ledger).bad_lines == 2
    assert len(read_ledger(ledger).of(PLAN)) == 2
    assert contents(out) == contents(serial)


def test_the_date_is_that_of_the_first_run(
    monkeypatch: pytest.MonkeyPatch, config: Path, serial: Path, tmp_path: Path
) -> None:
    out = Path(shutil.copytree(serial, tmp_path / "out"))
    for path in list((out / "sweep" / "units").iterdir())[:1]:
        path.unlink()
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1800000000")
    assert run(config, out, InThisProcess(answer)) == 0
    own = {"summary.json", "report.html", ".retarder-synth"}  # these tell of the last run
    kept, before = contents(out), contents(serial)
    assert {name: kept[name] for name in before.keys() - own} == {name: before[name] for name in before.keys() - own}


def test_two_runs_at_once_are_refused(command: Callable[..., Ran], config: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    with results_directory(out, SWEEP):
        assert is_held(out)
        code, said, told = command("sweep", "run", config, "-o", out)
        assert (code, said) == (2, "")
        assert "another sweep run is writing there" in told
    assert not is_held(out)
    assert events(out, PLAN) == []


def test_the_results_of_something_else_are_left_alone(
    command: Callable[..., Ran], config: Path, serial: Path, tmp_path: Path
) -> None:
    (tmp_path / "book.h5").write_bytes(b"mine")
    code, _, said = command("sweep", "run", config, "-o", tmp_path)
    assert code == 2
    assert "it holds book.h5, which 'sweep run' did not write" in said
    assert (tmp_path / "book.h5").read_bytes() == b"mine"
    out = Path(shutil.copytree(serial, tmp_path / "out"))
    (out / "dry").mkdir()
    (out / "dry" / "book.h5").write_bytes(b"mine")
    other = tmp_path / "other.toml"
    other.write_text(config.read_text() + '[[sweep.condition]]\nname = "dry"\n', encoding="utf-8")
    code, _, said = command("sweep", "run", other, "-o", out)
    assert code == 2
    assert f"{out / 'dry' / 'book.h5'}: retarder-synth did not write it" in said
    assert (out / "dry" / "book.h5").read_bytes() == b"mine"


@pytest.mark.long
def test_no_book_of_other_conditions_stays(
    command: Callable[..., Ran], config: Path, serial: Path, tmp_path: Path
) -> None:
    out, other = Path(shutil.copytree(serial, tmp_path / "out")), tmp_path / "other.toml"
    other.write_text(config.read_text() + '[[sweep.condition]]\nname = "dry"\n', encoding="utf-8")
    assert run(other, out, InThisProcess(answer)) == 0
    assert not (out / "book.h5").exists()
    assert command("verify", out / "dry", "--passes", "100")[0] in (0, 1)
    begun = len(events(out, STARTED))
    assert run(config, out, InThisProcess(answer)) == 0
    assert len(events(out, STARTED)) == begun
    assert (out / "book.h5").read_bytes() == (serial / "book.h5").read_bytes()
    assert not (out / "dry" / "book.h5").exists()


def test_a_result_under_another_name_is_none(serial: Path, tmp_path: Path) -> None:
    out = Path(shutil.copytree(serial, tmp_path / "out"))
    directory = SweepDirectory(out)
    one, other, *_ = sorted((out / "sweep" / "units").iterdir())
    one.write_bytes(other.read_bytes())
    with pytest.raises(DamagedTable, match="another unit"):
        directory.stored(one.stem)


def test_a_ledger_line_is_on_the_disk_when_written(tmp_path: Path) -> None:
    path = tmp_path / "ledger.jsonl"
    with LedgerWriter(path) as ledger:
        ledger.write(DONE, {"unit": "a"})
        assert [event["unit"] for event in read_ledger(path).events] == ["a"]
        ledger.write(DONE, {"unit": "b"})
    path.write_bytes(path.read_bytes() + b'{"event":"do')
    with LedgerWriter(path) as ledger:
        ledger.write(DONE, {"unit": "c"})
    assert [event["unit"] for event in read_ledger(path).events] == ["a", "b", "c"]
    assert read_ledger(path).bad_lines == 1
