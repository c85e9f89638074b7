"""Aim tables and their exports by the checker's own reading: sound ones pass, every planted fault is found."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy import stats

from synth.checker.aim.table import exit_speed, read_aim
from synth.checker.finding import Kind
from synth.checker.float32 import bits
from synth.checker.verdict import verify
from synth.cli import main
from tests.checker.planted_fault import Document, found, judged, look
from tests.controller_code.sample_book import FOUR_AXLES, table_of
from tests.st_files import aim_st_files
from tests.tuning_tables.aim.made_tables import answers, category_table, hard_questions, measured_table, sample_set
from tuning_tables.aim import AimTables
from tuning_tables.aim.aim_tables import AimTable
from tuning_tables.aim.exports import aim_c_files, aim_export
from tuning_tables.csv_file import to_csv
from tuning_tables.export_names import ExportPrefix
from tuning_tables.exports import c_files
from tuning_tables.json_file import from_json, to_json
from tuning_tables.json_text import canonical_json, document_checksum
from tuning_tables.language.st_layout import unit_files
from tuning_tables.table_book import TableBook

AIMS = AimTables((category_table(1.0), measured_table(), category_table(1.5, 4, "СТ")))
PARK = ExportPrefix("Park")


def write_all(folder: Path, aims: AimTables) -> Path:
    """The tables with CSV beside them, C in c/, Structured Text in st/, and another export of both, prefixed, split."""
    for name in ("tables", "c", "st"):
        (folder / name).mkdir(parents=True)
    for table in aims.tables:
        (folder / "tables" / f"{table.id}.json").write_bytes(to_json(table))
        (folder / "tables" / f"{table.id}.csv").write_bytes(to_csv(table))
    exports = {"c": aim_c_files(aims), "st": aim_st_files(aims), "": aim_c_files(aims, PARK)}
    for place, files in (*exports.items(), ("st", unit_files(aim_export(aims, PARK)))):
        for name, content in files.items():
            (folder / place / name).write_bytes(content)
    return folder


@pytest.fixture(scope="session")
def exported_once(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Every export of three tables; not to be changed."""
    return write_all(tmp_path_factory.mktemp("aims") / "out", AIMS)


@pytest.fixture
def exported(exported_once: Path, tmp_path: Path) -> Path:
    """A copy of it, to be changed at will."""
    return Path(shutil.copytree(exported_once, tmp_path / "out"))


def test_sound_tables_and_exports_are_confirmed(exported_once: Path, tmp_path: Path) -> None:
    verdict = judged(exported_once)
    assert verdict.findings == ()
    assert verdict.code == 0
    assert {each.aim.id for each in verdict.aims} == {table.id for table in AIMS.tables}
    assert len(verdict.files) == 3 + 3 + 2 * 2 + 2
    hard = judged(write_all(tmp_path / "hard", sample_set()))
    assert hard.findings == ()
    assert len(hard.aims) == 19


def test_the_checkers_rule_is_the_rule_to_the_last_bit() -> None:
    aims = sample_set()
    read = [read_aim(to_json(table)) for table in aims.tables]
    asked = hard_questions(aims, 20_000, 77)
    for (number, cars, distance, resistance), right in zip(asked.tolist(), answers(aims, asked), strict=True):
        speed = exit_speed(read[number], cars, distance, resistance)
        assert bits(-1.0 if speed is None else speed) == int(right.view(np.uint32))


@pytest.mark.parametrize(
    ("name", "pattern", "replacement", "words"),
    [
        ("c/aim_table.c", r"(0x1\.)([0-8])([0-9a-f]*p\+0f)", r"\g<1>9\3", "the crc32 of table 0"),
        ("c/aim_table.c", r"(0x1\.)([0-8])([0-9a-f]*p\+0f)", r"\g<1>9\3", "but the table says"),
        ("c/aim_table.c", r"aim_table_count = 3", "aim_table_count = 2", "aim_table_count is 2"),
        ("c/aim_table.c", r"        4, /\* category \*/", "        5, /* category */", "category of table 2 is 5"),
        ("c/aim_table.c", r"-0x1p\+0f", "0x1p+0f", r"aim-1-category: .*speedms\[\d+\] .* is 1.0, but .* -1.0"),
        ("c/aim_table.h", r"(CATEGORY_\w+) 1 ", r"\1 2 ", "defines the categories"),
        ("c/aim_table.h", r"distance_m\[7\]", "distance_m[8]", "its struct has"),
        ("park_aim_table.c", r"(0x1\.)([0-8])([0-9a-f]*p\+0f)", r"\g<1>9\3", "park_aim_table.c: .* but the table says"),
        ("c/golden_aims.csv", r"(?m)^(0,[^,]*,1,41a00000,\w+,)3f", r"\g<1>40", r"golden_aims.csv: row \d+ says .* but"),
        ("c/golden_aims.csv", r"(?m)^0,.*\r\n(?=0)", "", ""),
        ("park_golden_aims.csv", r"table,id", "table,di", "its first line is not"),
        ("st/aim_table.st", r"(\d\.\d{8})\d(E[+-]\d\d)", r"\g<1>X\2", "something else than REAL"),
        ("st/aim_table.st", r"(Distance_1 : ARRAY.*?)2\.0", r"\g<1>2.1", r"distancem\[0\] of table 1"),
        ("st/aim_table.st", r"(Speed_0 : .*?:= \[\s*)\d", r"\g<1>9", r"aim-1-category: .*speedms\[0\]"),
        ("st/aim_table.st", r"IsMeasuredOf : (.*?):= \[0", r"IsMeasuredOf : \1:= [1", "ismeasured of table 0 is 1"),
        ("st/aim_table.st", r"(AIM_SELECT.*IsMeasuredOf : .*?:= )\[0", r"\1[1", "stands there more than once"),
        ("st/aim_table.st", r"ListedOf : (.*?)\[5, 5", r"ListedOf : \1[5, 4", r"listed of table 1 is 4"),
        ("st/aim_table.st", r"TablePart : (.*?)\[0, 1", r"TablePart : \1[0, 2", r"of table 1 is"),
        ("st/aim_table.st", r"    Cars_1 : [^\n]*\n", "", "cars of table 1 is missing"),
        ("st/0003_PARK_AIM_LOAD.st", r"(Speed_0 : .*?:= \[\s*)\d", r"\g<1>9", r"speedms\[0\]"),
        ("tables/aim-1-category.csv", r"(?m)^(node,0,1,)20.0", r"\g<1>21.0", "the row node,0 holds"),
        ("tables/aim-1-category.csv", r"(?m)^(node,6,1,400.0,,),", r"\g<1>0.5,", "the row node,6 holds"),
        ("tables/aim-1-category.csv", r"(?m)^node,7,.*\r\n", "", "the row node,7 is missing"),
        ("tables/aim-1-category.csv", r"(required.p_overspeed),0.1", r"\1,0.2", "required.p_overspeed holds"),
        ("tables/aim-1-measured.csv", r"(?m)^names,node,cars", "names,node,cats", "the row names,node holds"),
        ("tables/aim-1-measured.csv", r"text,id,aim-1-measured", "text,id,other", "which no other file holds"),
    ],
)  # fmt: skip
def test_one_changed_digit_in_an_export_is_found(
    exported: Path, name: str, pattern: str, replacement: str, words: str
) -> None:
    text, count = re.subn(pattern, replacement, (exported / name).read_bytes().decode(), count=1, flags=re.DOTALL)
    if ".csv" in name:
        text, count = re.subn(pattern, replacement, (exported / name).read_bytes().decode(), count=1)
    assert count == 1
    (exported / name).write_bytes(text.encode())
    if not words:  # fewer golden aims than the export writes are still right ones
        assert judged(exported).findings == ()
        return
    damaged = ("else than", "count is", "first line", "struct has")
    kind = Kind.DAMAGED if any(each in words for each in damaged) else Kind.DISAGREES
    assert found(look(exported), kind, words)


def test_a_table_more_or_less_is_found(exported: Path) -> None:
    moved = exported / "tables" / "aim-4-category.json"
    content = moved.read_bytes()
    moved.unlink()
    verdict = judged(exported)
    for words in (
        "it holds 3 tables, but there are 2",
        "no other file holds",
        "no golden aim",
    ):
        assert found(verdict, Kind.DAMAGED if "golden" in words else Kind.DISAGREES, words)
    moved.write_bytes(content)
    moved.with_name("copy.json").write_bytes(content)
    assert found(look(exported), Kind.DISAGREES, "another file has the id aim-4-category, too")


def rewritten(change: Callable[[Document], object], measured: bool = False) -> bytes:
    document = json.loads(to_json(measured_table() if measured else category_table(1.0)))
    change(document)
    return canonical_json({**document, "crc32": document_checksum(document)})


def put(place: tuple[Any, ...], value: object) -> Callable[[Document], None]:
    """Puts `value` at a place of the document."""

    def change(document: Document) -> None:
        part: Any = document
        for key in place[:-1]:
            part = part[key]
        part[place[-1]] = value

    return change


FAULTS: tuple[tuple[Callable[[Document], object], str], ...] = (
    (put(("measured",), {"from_m": 0.0, "to_m": 1.0, "speed_std_m_s": 0.1}), "axes.resistance_n_per_kn is None"),
    (put(("exit_speed_m_s", 1), [1.0]), r"exit_speed_m_s\[1\] is \[1\], but it must be an array of 7"),
    (lambda d: d["exit_speed_m_s"].pop(), "exit_speed_m_s is .* an array of 5"),
    (put(("category", "number"), 3), "has the number 3, which is not its own"),
    (put(("category",), {"number": 7, "name": "own"}), "has the number 7"),
    (put(("required", "p_overspeed"), 1.0), r"does not lie within \(0, 1\)"),
    (put(("bounds_m_s",), [7.0, 0.5]), "two numbers, the smaller one first"),
    (put(("axes", "cars"), [1, 2, 3, 3, 8]), "its numbers of cars"),
    (put(("axes", "free_distance_m", 1), 20.0005), "its free distances do not rise by 0.001"),
    (put(("exit_speed_m_s", 4, 6), 7.5), "8 cars at 400 m: the exit speed of 7.5 m/s is out of its bounds"),
    (put(("exit_speed_m_s", 0, 5), None), "1 cars at 300 m: figures are reported where there is no exit speed"),
    (put(("reported", "p_overspeed", 2, 2), 0.2), "3 cars at 100 m: p of 0.2 in"),
    (put(("reported", "mean_gap_m", 2, 2), None), "3 cars at 100 m: some figures are reported without the others"),
)  # fmt: skip
MEASURED_FAULTS: tuple[tuple[Callable[[Document], object], str], ...] = (
    (put(("axes", "resistance_n_per_kn", 1), 0.4), "its resistances do not rise"),
    (put(("axes", "resistance_n_per_kn"), None), "axes.resistance_n_per_kn is None"),
    (put(("measured",), None), "axes.resistance_n_per_kn is"),
    (put(("measured", "to_m"), 228.0), "its resistance is measured from 228 to 228 m"),
    (put(("exit_speed_m_s", 1, 2, 2), 0.6), "2 cars at 100 m and 1.5 N/kN: the exit speed is less than for a"),
    (put(("exit_speed_m_s", 1, 2, slice(1, 3)), [None, 0.6]), "2 cars at 100 m and 1.5 N/kN: the exit speed is less"),
    (put(("exit_speed_m_s", 0, 0), [1.0]), r"exit_speed_m_s\[0\]\[0\] is \[1\], but it must be an array of 5"),
)  # fmt: skip


@pytest.mark.parametrize(("change", "words"), FAULTS, ids=[str(place) for place in range(len(FAULTS))])
def test_a_fault_under_a_right_checksum_is_found_as_the_reader_finds_it(
    change: Callable[[Document], object], words: str, tmp_path: Path
) -> None:
    require_found(rewritten(change), words, tmp_path)


@pytest.mark.parametrize(("change", "words"), MEASURED_FAULTS, ids=[str(n) for n in range(len(MEASURED_FAULTS))])
def test_a_fault_of_a_measured_table_is_found_as_the_reader_finds_it(
    change: Callable[[Document], object], words: str, tmp_path: Path
) -> None:
    require_found(rewritten(change, measured=True), words, tmp_path)


def require_found(content: bytes, words: str, folder: Path) -> None:
    (folder / "aim.json").write_bytes(content)
    assert found(look(folder / "aim.json"), Kind.DAMAGED, words)
    with pytest.raises(ValueError):  # noqa: PT011  # whichever kind of refusal
        from_json(content, AimTable)


def test_a_wrong_checksum_is_damage(tmp_path: Path) -> None:
    (tmp_path / "aim.json").write_bytes(to_json(category_table()).replace(b"0.012", b"0.013"))
    assert found(look(tmp_path / "aim.json"), Kind.DAMAGED, "crc32")
    assert found(look(tmp_path), Kind.DAMAGED, "aim.json: its crc32")


def test_more_over_speeds_than_required_are_a_claim_that_is_not_confirmed(tmp_path: Path) -> None:
    def excess(document: Document, low: float) -> None:
        for name, value in (("low95", low), ("high95", 0.14)):
            document["reported"][f"p_overspeed_{name}"][3][4] = value
        document["reported"]["p_overspeed"][3][4] = 0.13

    # By chance one of `count` nodes lies so far above its interval as often as a single one lies above its own.
    count = int(np.isfinite(category_table().reported.p_overspeed).sum())
    least = 0.13 - (0.13 - 0.11) * stats.norm.isf(0.025) / stats.norm.isf(0.025 / count)
    for low, code in ((least + 1e-4, 1), (least - 1e-4, 0)):
        (tmp_path / "aim.json").write_bytes(rewritten(partial(excess, low=low)))
        assert verify(tmp_path, 100, 1).code == code
    (tmp_path / "aim.json").write_bytes(rewritten(partial(excess, low=0.12)))
    words = (
        r"at 1 nodes more cuts over-speed than required, p = 0.1; most at 5 cars at 200 m: 0.1300 \[0.1200, 0.1400\]"
    )
    assert found(judged(tmp_path), Kind.CLAIM, words)


def test_beside_controller_tables(exported: Path) -> None:
    """Tables of both kinds in one directory, with code of both, one of it of a prefix that looks alike."""
    table = table_of("a", "Л", 22.0, FOUR_AXLES, 2.0)
    (exported / "tables" / "a.json").write_bytes(to_json(table))
    for name, content in c_files(TableBook((table,)), ExportPrefix("AIM_2")).items():
        (exported / "c" / name).write_bytes(content)
    verdict = judged(exported)
    assert verdict.findings == ()
    assert [each.table.id for each in verdict.tables] == ["a"]
    assert len(verdict.aims) == 3
    assert "c/aim_2_table.c" in verdict.files
    for text in ("AIM", "aim", "PARK_AIM"):
        with pytest.raises(ValueError, match="must not end with AIM"):
            ExportPrefix(text)
    with pytest.raises(ValueError, match="its kind is aim"):
        from_json(to_json(category_table()))


def test_words_json_and_no_numpy(exported_once: Path, capfd: pytest.CaptureFixture[str]) -> None:
    capfd.readouterr()
    assert main(["verify", str(exported_once)]) == 0
    lines = capfd.readouterr().out.splitlines()
    assert lines[0] == "aim-1-category: ok; an aim table of 35 nodes, 1 without an exit speed"
    assert lines[-1] == "accepted: 3 tables, 12 files: nothing found"
    assert main(["verify", str(exported_once), "--json"]) == 0
    told = json.loads(capfd.readouterr().out)
    assert told["aims"][1] == {"id": "aim-1-measured", "ok": True, "nodes": 175, "nodes_without_speed": 26}
    assert told["tables"] == []
    source = (
        "import sys; from synth.cli import main; code = main(['verify', sys.argv[1]]); "
        "print(*sorted({name.partition('.')[0] for name in sys.modules}), file=sys.stderr); raise SystemExit(code)"
    )
    ran = subprocess.run(
        [sys.executable, "-c", source, str(exported_once)], capture_output=True, text=True, timeout=60, check=True
    )
    assert set(ran.stderr.split()).isdisjoint({"numpy", "scipy", "numba", "h5py", "tuning_tables", "plant_models"})
