"""The command validate on a real, small book: it confirms what is true, finds what is not, and logs passes."""

from __future__ import annotations

import json
from collections import Counter
from pathlib import Path

import numpy as np
import pytest

from tests.system.conftest import Command
from tests.system.small_book import ID
from tuning_tables import read_book, read_json, to_json
from tuning_tables.canonical import canonical_json, document_checksum
from tuning_tables.pass_log.log_files import read_logs


def test_validate_confirms_what_the_tables_say(
    command: Command, tuned: Path, two_classes: Path, tmp_path: Path
) -> None:
    ran = command("validate", tuned / "book.h5", "--config", two_classes, "--json", "-o", tmp_path / "one")
    assert ran.code == 0
    found = json.loads(ran.out)
    assert (found["warnings"], found["accepted"]) == ([], True)
    for each, table in zip(found["tables"]["tables"], read_book(tuned / "book.h5"), strict=True):
        assert table.validated is not None
        assert each["rms_m_s"]["value"] == table.validated.rms_m_s  # the same passes
        assert each["stated_rms_m_s"] == each["rms_m_s"]
        assert (each["confirmed"], each["same_config"]) == (True, True)
    page = (tmp_path / "one" / "report.html").read_text(encoding="utf-8").partition("<h2>")[0]
    n = len(found["tables"]["tables"])
    assert f"<strong>{n} of {n}</strong><p>files state an rms that these passes confirm</p>" in page
    assert "What to do first" not in page
    given = ("validate", tuned / "tables" / f"{ID}.json", "--config", two_classes, "-o", tmp_path / "other")
    other = command(*given, "--seed", 7, "--passes", 4000)
    assert other.code == 0
    assert "limits kept, as stated" in other.out
    assert "4000 stratified passes of each table, seed 7" in other.out


@pytest.mark.parametrize(("name", "std"), [("log.csv", "0"), ("log.h5", "none")])
def test_validate_logs_passes_as_a_controller_would(
    command: Command, tuned: Path, two_classes: Path, tmp_path: Path, name: str, std: str
) -> None:
    given = ("validate", tuned / "book.h5", "--config", two_classes, "--passes", 1000, "--log", name, "-o", tmp_path)
    ran = command(*given, "--log-passes", 30, "--gauge-std", std)
    assert ran.code == 0
    assert f"30 passes of each table, as a controller logs them: {name}" in ran.out
    tables = read_book(tuned / "book.h5")
    loaded = read_logs([tmp_path / name], None, len(tables[0].stages) - 1)
    assert loaded.faults == ()
    log = loaded.log
    assert Counter(log.mass_t.tolist()) == {22.0: 30, 30.0: 30}
    assert set(log.target_m_s) == {1.5}
    assert log.has_gauge == (std == "0")
    if log.has_gauge:  # a drive at rest is within the dead band of its stage, and an exact gauge shows it there
        apart_kpa = np.abs(log.pressure_kpa - np.array([stage.pressure_kpa for stage in tables[0].stages])[log.stage])
        assert np.median(apart_kpa) <= tables[0].retarder.dead_band_kpa


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (("--log", "log.xlsx"), "--log is 'log.xlsx'; it must be the name of a file in DIR that ends in .csv or .h5"),
        (("--log", "a/log.csv"), "--log is 'a/log.csv'; it must be the name of a file in DIR"),
        (("--log-passes", 5), "are about a log; name its file in DIR by --log NAME.csv"),
        (("--gauge-std", "none"), "are about a log; name its file in DIR by --log NAME.csv"),
        *(
            (("--log", "log.csv", "--gauge-std", word), f"--gauge-std is '{word}'; it must be 0 to 100 kPa, or none")
            for word in ("-1", "nan", "101", "much")
        ),
    ],
)
def test_validate_refuses_a_log_that_cannot_be(
    command: Command, tuned: Path, tmp_path: Path, words: tuple[object, ...], says: str
) -> None:
    ran = command("validate", tuned / "book.h5", *words, "-o", tmp_path / "out")
    assert (ran.code, ran.out) == (2, "")
    assert says in ran.sentence
    assert not (tmp_path / "out").exists()


@pytest.mark.requirement("CMD-10")
def test_validate_finds_a_table_that_lies(command: Command, tuned: Path, two_classes: Path, tmp_path: Path) -> None:
    path = tuned / "tables" / f"{ID}.json"
    table = read_json(path)
    text = to_json(table).decode().replace(f'"rms_m_s": {table.predicted.rms_m_s!r}', '"rms_m_s": 0.005')
    document = json.loads(text)
    document.pop("crc32")
    document["crc32"] = document_checksum(document)
    path.write_bytes(canonical_json(document))
    ran = command("validate", path, "--config", two_classes, "-o", tmp_path / "out")
    assert ran.code == 1
    assert "predicted / simulated rms 0.2" in ran.out


def test_validate_refuses_a_plant_that_does_not_fit(command: Command, tuned: Path, tmp_path: Path) -> None:
    beside = command("validate", tuned / "book.h5", "--passes", "1000", "-o", tmp_path / "beside", "-q")
    assert beside.code == 0  # by the configuration that lies beside the book
    assert beside.out.startswith("accepted: ")
    assert (beside.err, beside.out.count("\n")) == ("", 1)
    (tmp_path / "alone.h5").write_bytes((tuned / "book.h5").read_bytes())
    ran = command("validate", tmp_path / "alone.h5", "-o", tmp_path / "out")
    assert ran.code == 2
    assert "no cut class fits the table gondola-4-22t-to-1.5-m-s" in ran.sentence
    assert "retarder.zones_m" in ran.sentence
