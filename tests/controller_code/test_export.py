"""The exported C as text: clean for every checker, complete, equal to the table to the last bit, not to be mixed."""

from __future__ import annotations

import csv
import io
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from scripts.studies.in_the_loop.controller_process import (
    CONTRACT,
    BuildError,
    compile_with,
    sources_of,
    write_sources,
)
from scripts.studies.in_the_loop.held_words import held_record, held_words, places
from tests.controller_code.conftest import Built, Tool
from tuning_tables import InvalidTable, decide_for, from_json, read_book, to_json, write_book
from tuning_tables.c_source import c_files
from tuning_tables.controller_code.line_code import line_code
from tuning_tables.language.c99_data import hex_float
from tuning_tables.self_test_size import FULL, SMALL
from tuning_tables.table_book import TableBook

PEDANTIC = (
    *CONTRACT, "-O2", "-Wconversion", "-Wshadow", "-Wcast-align", "-Wcast-qual", "-Wdouble-promotion", "-Wfloat-equal",
    "-Wundef", "-Wstrict-prototypes", "-Wmissing-prototypes", "-Wvla", "-Wtrigraphs", "-c",
)  # fmt: skip
CHANGES = np.array([*(1 << bit for bit in range(8)), 0xFF, 0x5A], dtype=np.uint8)
"""Bits of a byte that are turned round: each alone, all, and half of them."""

SOURCES = ("retarder_table.c", "retarder_self_test.c")
PROGRAM = (*SOURCES, "controller_process.c")
ANALYZED = ("light-2.0", "light-3.3", "odd")
"""Two tables between which there are others, and one of odd numbers; with them no code falls away."""

FLOAT_H = ("-DFLT_RADIX=2", "-DFLT_MANT_DIG=24", "-DFLT_MAX_EXP=128", "-DFLT_MAX=3.40282347e+38F")


@pytest.mark.requirement("CODE-05")
@pytest.mark.parametrize(
    ("compiler", "switches"),
    [("gcc", ()), ("clang", ()), ("clang", ("-Weverything", "-Wno-padded", "-Wno-unsafe-buffer-usage",
                                            "-Wno-unknown-warning-option", "-Wno-declaration-after-statement")),
     ("arm-linux-gnueabihf-gcc", ("-mcpu=cortex-m4", "-mthumb", "-mfloat-abi=hard",
                                                            "-mfpu=fpv4-sp-d16"))],
    ids=lambda value: value if isinstance(value, str) else " ".join(value[:1]),
)  # fmt: skip
def test_compilers_have_nothing_to_say(
    compiler: str, switches: tuple[str, ...], book: TableBook, tmp_path: Path, tool: Tool
) -> None:
    write_sources(book, tmp_path)
    for name in SOURCES:
        said = compile_with([tool(compiler), *PEDANTIC, *switches, str(tmp_path / name), "-o", str(tmp_path / "o")])
        assert said == ""


@pytest.mark.long
def test_the_analyzer_has_nothing_to_say(book: TableBook, tmp_path: Path, tool: Tool) -> None:
    """Of all the code, but with few numbers: it goes through each row anew for every function that reads rows."""
    few = TableBook(tuple(table for table in book.tables if table.id in ANALYZED))
    assert len(few.tables) == len(ANALYZED)
    for name, content in sources_of(few, SMALL).items():
        (tmp_path / name).write_bytes(content)
    for name in SOURCES:
        analyze = [tool("gcc"), *PEDANTIC, "-fanalyzer", str(tmp_path / name), "-o", str(tmp_path / "o")]
        assert compile_with(analyze) == ""


@pytest.mark.long
def test_cppcheck_has_nothing_to_say(book: TableBook, tmp_path: Path, tool: Tool) -> None:
    write_sources(book, tmp_path)
    # The interface is the same in every export; without estimators retarder_observe leaves the estimate alone.
    names = ("constParameter", "constParameterPointer", "unmatchedSuppression")  # as versions call it
    interface = () if held_record(book).room["breaks"] else [f"--suppress={name}" for name in names]
    # It reads no system headers, so it is told what <float.h> says.
    said = compile_with(
        [tool("cppcheck"), "--enable=all", "--inconclusive", "--std=c99", "--quiet", "--error-exitcode=3",
         "--suppress=missingIncludeSystem", *interface, *FLOAT_H, *(str(tmp_path / name) for name in PROGRAM)]
    )  # fmt: skip
    assert said == ""


@pytest.mark.requirement("CODE-05")
def test_nothing_but_itself_is_linked(book: TableBook, tmp_path: Path, tool: Tool) -> None:
    write_sources(book, tmp_path)
    for name in SOURCES:
        compile_with([tool("gcc"), *CONTRACT, "-Os", "-c", str(tmp_path / name), "-o", str(tmp_path / f"{name}.o")])
    listed = compile_with(["nm", *(str(tmp_path / f"{name}.o") for name in SOURCES)])
    kinds = {(line.split()[-2], line.split()[-1]) for line in listed.splitlines() if len(line.split()) >= 2}
    undefined = {name for kind, name in kinds if kind == "U"}
    defined = {name for kind, name in kinds if kind in "TRDBC"}
    # GCC may make memcpy and memset of a structure's assignment; a freestanding environment has to have them.
    assert undefined - defined <= {"memcpy", "memset"}
    assert not {kind for kind, _ in kinds} & set("dDbBC")  # no variable data at all


@pytest.mark.requirement("CODE-08")
def test_files_of_two_exports_are_not_compiled_together(book: TableBook, tmp_path: Path, tool: Tool) -> None:
    write_sources(book, tmp_path)
    other = c_files(TableBook(book.tables[1:]))
    (tmp_path / "retarder_table.c").write_bytes(other["retarder_table.c"])
    with pytest.raises(BuildError, match=r"retarder_table\.h is of another export"):
        compile_with([tool("gcc"), *CONTRACT, "-c", str(tmp_path / "retarder_table.c"), "-o", str(tmp_path / "o")])


def test_exports_of_other_numbers_have_another_tag(book: TableBook) -> None:
    """Also where shapes are equal."""
    first = book.tables[0]
    changed = replace(first, stages=(replace(first.stages[0], upper=first.stages[1].upper), *first.stages[1:]))
    tags = {line_code(TableBook((table,)), SMALL).tag for table in (first, changed)}
    assert len(tags) == 2
    assert line_code(TableBook((first,)), FULL).tag in tags


@pytest.mark.parametrize("standard", ["c++98", "c++11", "c++14", "c++17"])
def test_cxx_takes_the_headers_and_since_17_the_code(
    standard: str, book: TableBook, tmp_path: Path, tool: Tool
) -> None:
    write_sources(book, tmp_path)
    caller = '#include "retarder_self_test.h"\nint main() { return retarder_self_test(0); }\n'
    (tmp_path / "caller.cpp").write_text(caller)
    compiler = [tool("clang"), "-x", "c++", f"-std={standard}", "-pedantic-errors", "-c", "-o", str(tmp_path / "o")]
    compile_with([*compiler, str(tmp_path / "caller.cpp")])
    if standard == "c++17":
        for name in SOURCES:
            compile_with([*compiler, "-ffp-contract=off", str(tmp_path / name)])
    else:
        with pytest.raises(BuildError, match="hexadecimal floating"):
            compile_with([*compiler, str(tmp_path / "retarder_table.c")])


@pytest.mark.requirement("CODE-07")
def test_every_changed_byte_of_a_table_is_found(book: TableBook, built: Built) -> None:
    controller = built(book)
    right = held_words(book, 0)
    assert controller.intact(right[None, :]).all()
    length = 4 * len(right)
    damaged = np.repeat(right.view(np.uint8)[None, :], len(CHANGES) * length, axis=0)
    place, change = np.divmod(np.arange(len(damaged)), len(CHANGES))
    damaged[np.arange(len(damaged)), place] ^= CHANGES[change]
    assert not controller.intact(damaged.view(np.uint32)).any()


@pytest.mark.requirement("FILE-05")
def test_json_book_and_c_hold_the_same_bits(book: TableBook, tmp_path: Path, built: Built) -> None:
    write_book(book.tables, tmp_path / "book.h5")
    way_round = TableBook(tuple(from_json(to_json(table)) for table in read_book(tmp_path / "book.h5")))
    assert way_round == book
    assert c_files(way_round) == c_files(book)
    record, where = held_record(book), places(book)
    for table, words in zip(book.tables, built(way_round).dump(), strict=True):
        lines = words[where["coefficient"]].view(np.float32).reshape(record.shape("coefficient"))
        has_line = words[where["has_line"]].reshape(record.shape("has_line"))
        assert words[where["stages"]] == len(table.stages)
        assert words[where["powers"]] == table.degree + 1
        for stage in table.stages:
            for index, line in enumerate((stage.lower, stage.upper)):
                assert has_line[stage.k, index] == (line is not None)
                held = lines[stage.k, index, : table.degree + 1].astype(np.float64)
                assert np.array_equal(held.view(np.uint64), np.array(line or 0.0 * held).view(np.uint64))
        if "slope" in where:
            pressures = [stage.pressure_kpa if table.has_gauge else 0.0 for stage in table.stages]
            assert words[where["pressure_kpa"]].view(np.float32)[: len(pressures)].tolist() == pressures
            slopes = words[where["slope"]].view(np.float32).reshape(-1, 2)[: len(pressures)]
            assert slopes.tolist() == [[each or 0.0 for each in stage.slopes] for stage in table.stages]
        if table.estimator is not None:
            work = [words[where[name]].view(np.float32)[: len(table.estimator.s_m)]
                    for name in ("place_m", "drive", "brake")]  # fmt: skip
            assert np.array_equal(work, table.estimator.work)
            for name, value in table.estimator.numbers.items():
                assert words[where[name]].view(np.float32)[0] == np.float32(value), name


def test_golden_vectors_as_csv_are_answered_as_they_say(book: TableBook) -> None:
    rows = list(csv.DictReader(io.StringIO(c_files(book)["golden_vectors.csv"].decode("utf-8"), newline="")))
    assert len(rows) > 300 * len(book.tables)
    columns = {"s_bits": "s_m", "v_bits": "v_m_s"} | (
        {"p_bits": "pressure_kpa"} if held_record(book).room["gauge"] else {}
    )
    assert {*rows[0]} == {"table", "id", "stage", *columns, *columns.values(), "answer"}
    for row in rows:
        reading = [np.array([int(row[key], 16)], np.uint32).view(np.float32)[0] for key in columns]
        shown = np.array([row[key] for key in columns.values()], dtype=np.float32)
        assert np.array_equal(shown, reading, equal_nan=True)
        assert decide_for(book.tables[int(row["table"])], int(row["stage"]), *reading) == int(row["answer"])
        assert book.tables[int(row["table"])].id == row["id"]


def test_the_text_is_plain_whatever_names_hold(book: TableBook) -> None:
    content = c_files(book)
    for name in content:
        if not name.endswith(".csv"):
            text = content[name].decode("ascii")
            assert "\r" not in text
            assert "\t" not in text
            assert "@" not in text
            assert all(len(line.rstrip()) == len(line) for line in text.splitlines())
    header = content["retarder_table.h"].decode("ascii")
    assert "#define RETARDER_CATEGORY_ST 4 /* <U+0421><U+0422> */" in header
    assert "??/" not in header


def test_hexadecimal_floats() -> None:
    assert [hex_float(x) for x in (2.5, -0.1, 0.0, -0.0, 1e-45, 3.4028235e38)] == [
        "0x1.4p+1f", "-0x1.99999ap-4f", "0x0p+0f", "-0x0p+0f", "0x1p-149f", "0x1.fffffep+127f",
    ]  # fmt: skip


def test_a_book_of_two_positions_is_refused(book: TableBook) -> None:
    first = book.tables[0]
    other = replace(first, id="other", retarder=replace(first.retarder, name="РНЗ-2М"))
    with pytest.raises(InvalidTable, match="a book serves one position"):
        TableBook((first, other))
