"""Files of passes: what is written reads back exactly, foreign logs by a mapping, folders, speed, damage."""

from __future__ import annotations

import csv
import io
import re
import time
from dataclasses import fields, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tests.tuning_tables.pass_log.sample_logs import sample_log
from tuning_tables.errors import InvalidLog
from tuning_tables.pass_log.csv_log import read_csv_log
from tuning_tables.pass_log.log_files import read_logs, write_log
from tuning_tables.pass_log.log_mapping import LogMapping, read_mapping
from tuning_tables.pass_log.pass_log import PassLog


def assert_equal(one: PassLog, other: PassLog) -> None:
    for field in fields(PassLog):
        ours, theirs = getattr(one, field.name), getattr(other, field.name)
        if isinstance(ours, np.ndarray):
            assert ours.dtype == theirs.dtype, field.name
            assert np.array_equal(ours, theirs, equal_nan=ours.dtype.kind == "f"), field.name
        else:
            assert ours == theirs, field.name


@pytest.mark.parametrize("gauge", [True, False])
@pytest.mark.parametrize("name", ["log.csv", "log.h5"])
def test_a_log_reads_back_exactly(tmp_path: Path, name: str, gauge: bool) -> None:
    log = sample_log(gauge=gauge)
    speed = log.speed_m_s.copy()
    speed[7] = np.nan  # a missing reading
    log = replace(log, speed_m_s=speed, path_is_independent=gauge)
    write_log(log, tmp_path / name)
    loaded = read_logs([tmp_path / name], None, 2)
    assert loaded.faults == ()
    assert loaded.refused == ()
    assert_equal(loaded.log, log)
    assert [path.name for path in tmp_path.iterdir()] == [name]


def test_a_log_of_quoted_cells_is_the_same(tmp_path: Path) -> None:
    log = replace(sample_log(), cut_id=tuple(f'{number},,"{number}"' for number in range(len(sample_log()))))
    speed = log.speed_m_s.copy()
    speed[7] = np.nan
    log = replace(log, speed_m_s=speed)
    write_log(log, plain := tmp_path / "plain.csv")
    head, *lines = plain.read_text(encoding="utf-8").splitlines(keepends=True)
    quoted = io.StringIO(head, newline="")
    quoted.seek(0, io.SEEK_END)
    csv.writer(quoted, quoting=csv.QUOTE_ALL).writerows(csv.reader(lines))
    (tmp_path / "quoted.csv").write_text(quoted.getvalue(), encoding="utf-8", newline="")
    for name in ("plain.csv", "quoted.csv"):
        loaded = read_logs([tmp_path / name], None, 2)
        assert (loaded.faults, loaded.refused) == ((), ())
        assert_equal(loaded.log, log)


def test_a_foreign_log_is_read_by_a_mapping(tmp_path: Path) -> None:
    log = sample_log(gauge=True)
    lines = ["nr;t;Weg, ft;v;p;Stufe;Gewicht;Klasse"]
    for number in range(len(log)):
        for row in range(log.rows(number).start, log.rows(number).stop):
            lines.append(
                ";".join([
                    f'"{log.cut_id[number]}"', f"{log.time_s[row] * 1000:.0f}", f"{log.path_m[row] / 0.3048:.9f}",
                    f"{log.speed_m_s[row] * 3.6:.9f}", f"{log.pressure_kpa[row] / 100:.9f}", f"{log.stage[row]}",
                    f"{log.mass_t[number] * 1000:.6f}", "Т",
                ]).replace(".", ",")
            )  # fmt: skip
    (tmp_path / "log.csv").write_bytes(("\ufeff" + "\r\n".join(lines) + "\r\n;;;;;;;" * 2).encode())
    (tmp_path / "mapping.toml").write_text(
        'delimiter = ";"\ndecimal = ","\npath = "from speed"\n'
        '[columns]\ncut_id = "nr"\ntime_s = "t"\npath_m = "Weg, ft"\nspeed_m_s = "v"\npressure_kpa = "p"\n'
        'stage = "Stufe"\nmass_t = "Gewicht"\ncategory = "Klasse"\n'
        '[units]\ntime_s = "ms"\npath_m = "ft"\nspeed_m_s = "km/h"\npressure_kpa = "bar"\nmass_t = "kg"\n'
        "[constant]\naxles = 4\ntarget_m_s = 2.0\n",
        encoding="utf-8",
    )
    loaded = read_logs([tmp_path / "log.csv"], read_mapping(tmp_path / "mapping.toml"), None)
    assert loaded.faults == ()
    for name in ("time_s", "path_m", "speed_m_s", "pressure_kpa", "mass_t"):
        assert np.allclose(getattr(loaded.log, name), getattr(log, name), rtol=1e-8, atol=1e-6), name
    assert loaded.log.cut_id == log.cut_id
    assert set(loaded.log.category) == {"Т"}
    assert np.all(loaded.log.axles == 4)
    assert np.all(loaded.log.target_m_s == 2.0)
    assert not loaded.log.path_is_independent


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("speed = 3", "speed is not known; it must be one of columns, units"),
        ('[units]\nspeed_m_s = "knots"', 'units.speed_m_s is \'knots\'; it must be one of "m/s", "km/h"'),
        ('[units]\nstage = "bar"', "units.stage is not known"),
        ('[columns]\nvelocity = "v"', "columns.velocity is not known"),
        ("[columns]\ntime_s = 3", "columns.time_s is 3"),
        ('[constant]\nmass_t = "heavy"', "constant.mass_t is 'heavy'; it must be a number"),
        ("[constant]\naxles = 0", "constant.axles is 0; it must be a whole number from 1 to 1000 axles."),
        ("[constant]\naxles = 4.5", "constant.axles is 4.5; it must be a whole number from 1 to 1000 axles."),
        ("[constant]\naxles = inf", "constant.axles is inf; it must be a whole number from 1 to 1000 axles."),
        ("[constant]\ntarget_m_s = nan", "constant.target_m_s is nan; it must be a number from 0 to 40 m/s."),
        (f"[constant]\nmass_t = 1{'0' * 400}", "it must be a number from 1 to 20000 t."),
        ("[constant]\nstopped_by_hand = 2", "constant.stopped_by_hand is 2; it must be a whole number from 0 to 1."),
        ("[constant]\ntime_s = 0.1", "constant.time_s is not possible: it changes from row to row."),
        ('[constant]\ncut_id = "1"', "constant.cut_id is not possible"),
        ('[constant]\nmass_t = 80.0\n[columns]\nmass_t = "m"', "mass_t stands in [columns] and in [constant]"),
        ('decimal = ","', "decimal and delimiter are both"),
        ('path = "odometer"', 'path is \'odometer\'; it must be one of "independent", "from speed"'),
        ("units = 3", "units is 3; it must be a table"),
        ("[units", "no TOML file"),
        (f"decimal = {'9' * 5000}", "no TOML file (Exceeds the limit"),
        (f"decimal = 0x{'f' * 5000}", "no TOML file (Exceeds the limit"),
    ],
)
def test_a_mapping_with_unknown_entries_is_refused(tmp_path: Path, text: str, sentence: str) -> None:
    (tmp_path / "m.toml").write_text(text, encoding="utf-8")
    with pytest.raises(InvalidLog, match=re.escape(sentence)):
        read_mapping(tmp_path / "m.toml")


def test_of_a_thousand_files_three_bad_ones_are_named_and_the_others_used(tmp_path: Path) -> None:
    log = sample_log(passes=1, rows=6)
    write_log(log, tmp_path / "model.csv")
    model = (tmp_path / "model.csv").read_text(encoding="utf-8")
    (tmp_path / "model.csv").unlink()
    for number in range(1000):
        text = model.replace("cut-00000", f"cut-{number:05d}")
        if number == 17:
            text = text.replace("path_m", "way")
        elif number == 500:
            text = text.replace("\ncut-00500", "\ncut-00500,x", 2)
        (tmp_path / f"{number:04d}.csv").write_text(text, encoding="utf-8")
    (tmp_path / "0999.csv").write_bytes(b"\x89HDF\r\n\x1a\n\xff\xff")
    loaded = read_logs([tmp_path], None, None)
    assert [Path(fault.file).name for fault in loaded.refused] == ["0017.csv", "0500.csv", "0999.csv"]
    for fault in loaded.refused:
        assert fault.sentence.startswith(fault.file + ":")
        assert fault.sentence.count("\n") == 0
    assert len(loaded.log) == len(loaded.files) == 997


def test_files_are_put_in_the_order_of_time(tmp_path: Path) -> None:
    late, early = sample_log(passes=3, first=5), sample_log(passes=3, first=0)
    write_log(late, tmp_path / "a.csv")
    write_log(early, tmp_path / "b.h5")
    loaded = read_logs([tmp_path / "a.csv", tmp_path / "b.h5", tmp_path / "none.csv"], None, None)
    assert loaded.log.cut_id == early.cut_id + late.cut_id
    assert [path.name for path in loaded.files] == ["b.h5", "a.csv"]
    assert "none.csv: No such file" in loaded.refused[0].sentence


def test_cuts_of_one_name_in_two_files_are_told_apart(tmp_path: Path) -> None:
    write_log(sample_log(passes=2), tmp_path / "monday.csv")
    write_log(sample_log(passes=3), tmp_path / "tuesday.csv")
    ids = read_logs([tmp_path], None, None).log.cut_id
    assert ids == (
        "monday/cut-00000", "monday/cut-00001", "tuesday/cut-00000", "tuesday/cut-00001", "cut-00002"
    )  # fmt: skip


def test_without_any_pass_the_first_file_is_told(tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("", encoding="utf-8")
    (tmp_path / "b.csv").write_text("", encoding="utf-8")
    with pytest.raises(InvalidLog, match=r"no measured pass can be used: .*a\.csv: no rows .* \(and 1 more files\)"):
        read_logs([tmp_path], None, None)
    (tmp_path / "empty").mkdir()
    with pytest.raises(InvalidLog, match="no log in this folder"):
        read_logs([tmp_path / "empty"], None, None)


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"cut_id": ("a",) * 6}, "stands for two passes"),
        ({"cut_id": (" a", *"bcdef")}, "is no name for a cut"),
        ({"category": ("x" * 64,) * 6}, "is no name for a cut"),
    ],
)
def test_names_that_a_file_cannot_hold_are_not_written(tmp_path: Path, change: dict[str, Any], sentence: str) -> None:
    with pytest.raises(InvalidLog, match=sentence):
        write_log(replace(sample_log(), **change), tmp_path / "log.csv")
    with pytest.raises(InvalidLog, match="ends in"):
        write_log(sample_log(), tmp_path / "log.xls")


def test_two_hundred_thousand_rows_are_read_in_seconds(tmp_path: Path) -> None:
    """Half a second when developed; the bound leaves a busy machine room, but no loop over cells in Python."""
    write_log(sample_log(passes=2000, rows=100), tmp_path / "log.csv")
    began = time.process_time()
    loaded = read_logs([tmp_path / "log.csv"], None, None)
    assert time.process_time() - began < 6.0
    assert len(loaded.log.time_s) == 200_000


@pytest.mark.parametrize(("name", "mutants", "least"), [("log.csv", 300, 20), ("log.h5", 40, 30)])
def test_changed_bytes_give_a_log_or_a_sentence(tmp_path: Path, name: str, mutants: int, least: int) -> None:
    """No other error than `InvalidLog`, whatever happens to bytes of a file."""
    write_log(sample_log(passes=3, rows=8), tmp_path / name)
    sound = (tmp_path / name).read_bytes()
    rng, refused = np.random.default_rng(1), 0
    for _ in range(mutants):
        content = bytearray(sound)
        for place in rng.integers(0, len(content), rng.integers(1, 6)).tolist():
            content[place] = int(rng.choice([0, 10, 13, 34, 44, 45, 46, 57, 101, 255, int(rng.integers(256))]))
        if rng.random() < 0.2:
            del content[int(rng.integers(len(content))) :]
        (tmp_path / name).write_bytes(bytes(content))
        try:
            read_logs([tmp_path / name], None, None)
        except InvalidLog as fault:
            refused += 1
            assert name in str(fault)  # noqa: PT017  # either end is right
            assert len(str(fault)) < 1500  # noqa: PT017
    assert refused > least


@pytest.mark.parametrize(
    ("line", "speed", "target"),
    [
        (",,,1.5", np.nan, 1.5),
        (" ,  , ,1.5", np.nan, 1.5),
        ("4.5,,,", 4.5, np.nan),
        (" 4.5 ,,, ", 4.5, np.nan),
        (",,,", np.nan, np.nan),
    ],
)
def test_empty_cells_are_missing_readings(tmp_path: Path, line: str, speed: float, target: float) -> None:
    """Also several in a row, of spaces, at the beginning and the end of a line."""
    head = "speed_m_s,pressure_kpa,note,target_m_s,cut_id,time_s,path_m,stage,mass_t,axles,category,stopped_by_hand"
    rows = [f"{line},a,{row},{row},1,20,4,T,{'' if line == ',,,' else 0}" for row in range(6)]
    (tmp_path / "log.csv").write_text("\n".join([head, *rows]), encoding="utf-8")
    columns = read_csv_log(tmp_path / "log.csv", LogMapping())
    found = {name: columns.numbers[name] for name in ("speed_m_s", "pressure_kpa", "target_m_s", "path_m")}
    expected = {"speed_m_s": [speed] * 6, "pressure_kpa": [np.nan] * 6, "target_m_s": [target] * 6, "path_m": range(6)}
    for name, values in expected.items():
        assert np.array_equal(found[name], list(values), equal_nan=True), name
    assert np.isnan(columns.numbers["stopped_by_hand"]).all() == (line == ",,,")
