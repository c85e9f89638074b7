"""Tables for point sensors by the checker's own reading: sound ones pass, every planted fault is found."""

from __future__ import annotations

import json
import re
import shutil
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from synth.checker.finding import DamagedError, Kind
from synth.checker.passages.table import passages_heard, read_passage_table, wanted
from synth.cli import main
from tests.checker.planted_fault import Document, found, judged, look, rewrite
from tests.controller_code.passage_tables import every_axle_book, passage_book
from tests.effort import sized
from tests.tuning_tables.passages.made_tables import passage_tables as any_tables
from tests.tuning_tables.passages.made_tables import table_of
from tuning_tables.csv_file import to_csv
from tuning_tables.json_file import to_json
from tuning_tables.passages.exports import passage_c_files
from tuning_tables.passages.passage_book import PassageBook
from tuning_tables.passages.passage_table import PassageTable
from tuning_tables.passages.rule import held_by
from tuning_tables.passages.sensor_layout import DecidesOn
from tuning_tables.programs.at_pulse import wanted_stage

TABLES = (table_of(), replace(table_of(DecidesOn.EVERY_AXLE), id="every", validated=None))


@pytest.fixture(scope="session")
def exported_once(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two tables with CSV beside them; not to be changed."""
    folder = tmp_path_factory.mktemp("passages") / "out"
    (folder / "tables").mkdir(parents=True)
    for table in TABLES:
        (folder / "tables" / f"{table.id}.json").write_bytes(to_json(table))
        (folder / "tables" / f"{table.id}.csv").write_bytes(to_csv(table))
    return folder


@pytest.fixture
def exported(exported_once: Path, tmp_path: Path) -> Path:
    """A copy of it, to be changed at will."""
    return Path(shutil.copytree(exported_once, tmp_path / "out"))


def test_sound_tables_and_exports_are_confirmed(exported_once: Path, capsys: pytest.CaptureFixture[str]) -> None:
    verdict = judged(exported_once)
    assert verdict.findings == ()
    assert {each.table.id for each in verdict.passages} == {table.id for table in TABLES}
    assert len(verdict.files) == 4
    alone = exported_once / "tables" / "every.json"
    assert main(["verify", str(alone)]) == 0
    assert "every: ok; 14 passages over point sensors; not simulated" in capsys.readouterr().out
    assert main(["verify", str(alone), "--json"]) == 0
    told = json.loads(capsys.readouterr().out)["passages"]
    assert told == [{"id": "every", "ok": True, "passages": 14, "predicted_rms_m_s": 0.08, "simulated": None}]


@pytest.mark.parametrize("table", (*passage_book().tables, *every_axle_book().tables)[:4], ids=lambda table: table.id)
def test_the_checkers_rule_is_the_rule_to_the_last_bit(table: PassageTable) -> None:
    read, held, rng = read_passage_table(to_json(table)), held_by(table), np.random.default_rng(5)
    speeds = np.unique(table.switching_m_s[np.isfinite(table.switching_m_s)]).astype(float)
    near = [0.0, *speeds, *np.nextafter(speeds.astype(np.float32), np.float32(99)).astype(float), 50.0, -1.0, np.nan]
    for _ in range(4000):
        passage, stage = int(rng.integers(-1, len(table.passages) + 1)), int(rng.integers(-1, 11))
        v = float(rng.choice(near) if rng.random() < 0.5 else rng.uniform(0.0, 12.0))
        right = wanted_stage(held, passage, stage, v)
        assert wanted(read, passage, stage, v) == right
    heard = passages_heard(read.sensors_m, read.axle_offsets_m)
    assert [np.float32(path) for path, _, _ in heard] == table.heard_path_m.tolist()
    assert [sensor for _, sensor, _ in heard] == table.heard_sensor.tolist()


@given(any_tables())
@settings(derandomize=True, max_examples=sized(10, 40), deadline=None, suppress_health_check=list(HealthCheck))
def test_every_table_that_can_be_written_is_read(table: PassageTable) -> None:
    read = read_passage_table(to_json(table))
    assert read.id == table.id
    speeds = [list(map(list, passage.rows)) for passage in read.passages]
    assert np.array_equal(np.array(speeds, dtype=np.float32), table.switching_m_s)


def change(*place: str | int, to: Any) -> Callable[[Document], None]:
    """A change of one member of the document."""

    def edit(document: Document) -> None:
        parent: Any = document
        for step in place[:-1]:
            parent = parent[step]
        parent[place[-1]] = to

    return edit


@pytest.mark.parametrize(
    ("edit", "words"),
    [
        (change("cut", "category_number", to=2), "category_number"),
        (change("passages", 0, "switching_m_s", to=[[1.0, 2.0]]), "the number of rows"),
        (change("passages", 0, "switching_m_s", 1, to=[1.0]), "the length of row 1"),
        (change("target_speed_m_s", to=30.0), "target"),
        (change("pressure_kpa", 2, to=100.0), "pressures"),
        (change("retarder", "exit_m", to=40.0), "exit"),
        (change("valid_v_m_s", to=[4.0, 9.0]), "target"),
        (change("sensors", "path_m", to=[-4.0, 3.0, 3.1, 30.0, 45.0]), "too near"),
        (change("sensors", "path_m", to=[-4.0, 3.0, 9.6, 30.0, 45.0]), "passage 2 must be"),
        (change("approach", "length_m", to=5.0), "begin at the first sensor"),
        (change("initial_stage", to=2), "before the entrance"),
        (change("passages", 1, "axle", to=1), "passage 1 must be"),
        (change("passages", 1, "path_m", to=3.1), "passage 1 must be"),
        (change("sensors", "decides_on", to="every_axle"), "it has 4 passages"),
        (change("passages", 2, "switching_m_s", 1, 0, to=4.1), "float32"),
        (change("passages", 2, "switching_m_s", 0, 0, to=-1.0), "float32"),
        (change("passages", 2, "switching_m_s", 2, to=[7.0, 5.5]), "fall"),
        (change("passages", 2, "switching_m_s", 1, to=[6.25, 6.25]), "lower and to raise"),
    ],
)
def test_what_makes_no_sense_is_damage(exported: Path, edit: Callable[[Document], None], words: str) -> None:
    file = exported / "tables" / f"{TABLES[0].id}.json"
    rewrite(file, edit)
    assert found(look(file), Kind.DAMAGED, words)


def test_a_table_that_never_acts_is_found(tmp_path: Path) -> None:
    never = ((None, None), (None, None), (None, None))
    file = tmp_path / "table.json"
    file.write_bytes(to_json(TABLES[0]))

    def edit(document: Document) -> None:
        for passage in document["passages"]:
            passage["switching_m_s"] = never

    rewrite(file, edit)
    verdict = judged(file)
    assert found(verdict, Kind.DAMAGED, "at no passage is the brake applied")
    assert found(verdict, Kind.DAMAGED, "at no passage is the highest stage left")


@pytest.mark.parametrize(
    ("edit", "words"),
    [
        (change("predicted", "rms_m_s", to=0.04), "does not agree with the validated one"),
        (change("predicted", "rms_m_s", to=0.16), "does not agree with the validated one"),
        (change("predicted", "bias_m_s", to=0.5), "exceeds the predicted rms"),
        (change("validated", "rms_m_s", to=0.09), "not within its interval"),
    ],
)
def test_claims_that_contradict_one_another_are_found(
    exported: Path, edit: Callable[[Document], None], words: str
) -> None:
    file = exported / "tables" / f"{TABLES[0].id}.json"
    rewrite(file, edit)
    assert found(judged(file), Kind.CLAIM, words)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        (
            "number,passages.1.switching_m_s.1,4.5,6.25",
            "number,passages.1.switching_m_s.1,4.5,6.26",
            r"passages.1.switching_m_s.1 holds",
        ),
        (
            "number,passages.1.switching_m_s.2,-inf,5.5",
            "number,passages.1.switching_m_s.2,inf,5.5",
            r"passages.1.switching_m_s.2 holds",
        ),
        (
            "number,passages.3.switching_m_s.0,5.0,inf",
            "number,passages.4.switching_m_s.0,5.0,inf",
            r"passages.3.switching_m_s.0 is missing",
        ),
        ("number,sensors.base_m,0.2", "number,sensors.base_m,0.3", "sensors.base_m holds"),
        ("text,id,leer-22t-3.0", "text,id,other", "which no other file holds"),
    ],
)
def test_one_changed_cell_of_the_sheet_is_found(exported: Path, old: str, new: str, words: str) -> None:
    file = exported / "tables" / f"{TABLES[0].id}.csv"
    text = file.read_bytes().decode("utf-8")
    place = text.index(old)
    file.write_bytes((text[:place] + new + text[place + len(old) :]).encode("utf-8"))
    assert found(look(exported), Kind.DISAGREES, words)


@pytest.mark.parametrize(
    ("pattern", "replacement", "kind", "words"),
    [
        (
            rb"(?m)^(0,.*),0,(\S+)\r$",
            rb"\1,1,\2\r",
            Kind.DISAGREES,
            r"golden_stages.csv: row \d+ says 1, but the rule says 0",
        ),
        (rb"(?m)^0,.*\r\n", b"", Kind.DISAGREES, "golden_stages.csv: it has no golden stage"),
        (rb"wanted", b"wished", Kind.DAMAGED, "its first line is not"),
        (rb"(?m)^0,[^,]*", b'0,"else"', Kind.DAMAGED, "row 2 is no golden stage of a table"),
    ],
)
def test_a_wrong_golden_stage_is_found(
    tmp_path: Path, pattern: bytes, replacement: bytes, kind: Kind, words: str
) -> None:
    book = PassageBook(passage_book().tables[:2])
    for table in book.tables:
        (tmp_path / f"{table.id}.json").write_bytes(to_json(table))
    (tmp_path / "c").mkdir()
    golden = tmp_path / "c" / "golden_stages.csv"
    golden.write_bytes(passage_c_files(book)[golden.name])
    assert look(tmp_path).findings == ()
    changed, count = re.subn(pattern, replacement, golden.read_bytes())
    assert count > 0
    golden.write_bytes(changed)
    assert found(look(tmp_path), kind, words)


def test_an_id_given_twice_is_found(exported: Path) -> None:
    shutil.copy(exported / "tables" / "every.json", exported / "tables" / "twin.json")
    assert found(look(exported), Kind.DISAGREES, "another file has the id every, too")


def test_no_flipped_bit_changes_what_is_read() -> None:
    """A flipped bit is refused, or is in white space: layout is the exporter's, content the checker's."""
    least = table_of(places_m=(-0.5, 26.0), axles_m=(0.0,), rows=((3.0,), (2.5,)), pressures=(0.0, 9.0))
    content = to_json(least)
    read, unchanged = read_passage_table(content), 0
    for at in range(0, len(content), 2):
        for bit in range(8):
            changed = content[:at] + bytes([content[at] ^ 1 << bit]) + content[at + 1 :]
            try:
                assert read_passage_table(changed) == read
                unchanged += 1
            except DamagedError:
                continue
    assert unchanged < 30


@given(st.binary(max_size=60))
@settings(derandomize=True, max_examples=sized(12, 50))
def test_noise_is_damage(content: bytes) -> None:
    with pytest.raises(DamagedError):
        read_passage_table(content)
