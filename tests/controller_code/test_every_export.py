"""Exported C of every kind of tables: clean for all checkers, self-contained, not to be mixed, plain text."""

from __future__ import annotations

import re
import subprocess
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Final

import pytest

from scripts.studies.in_the_loop.controller_process import CONTRACT, BuildError, compile_with
from tests.controller_code.building import written
from tests.controller_code.conftest import Tool
from tests.controller_code.passage_tables import odd_table, passage_table
from tests.controller_code.sample_book import sample_book, surface_book
from tests.effort import every
from tests.tuning_tables.aim.made_tables import category_table, measured_table
from tests.tuning_tables.st.conftest import oddly_named_book
from tuning_tables.aim import AimTables
from tuning_tables.aim.exports import aim_c_files
from tuning_tables.correction import Correction
from tuning_tables.export_names import RETARDER, ExportPrefix
from tuning_tables.exports import c_files, correction_c_files
from tuning_tables.passages.exports import passage_c_files
from tuning_tables.passages.passage_book import PassageBook
from tuning_tables.self_test_size import SMALL
from tuning_tables.table_book import TableBook

Files = Mapping[str, bytes]
PARK: Final = ExportPrefix("PARK")
PEDANTIC: Final = (
    *CONTRACT, "-O2", "-Wconversion", "-Wshadow", "-Wcast-align", "-Wcast-qual", "-Wdouble-promotion", "-Wfloat-equal",
    "-Wundef", "-Wstrict-prototypes", "-Wmissing-prototypes", "-Wvla", "-Wtrigraphs", "-c",
)  # fmt: skip
EVERYTHING: Final = (
    "-Weverything", "-Wno-padded", "-Wno-unsafe-buffer-usage", "-Wno-unknown-warning-option",
    "-Wno-declaration-after-statement",
)  # fmt: skip
CORTEX: Final = ("-mcpu=cortex-m4", "-mthumb", "-mfloat-abi=hard", "-mfpu=fpv4-sp-d16")
STRICT: Final = (("gcc", ()), ("clang", EVERYTHING), ("arm-linux-gnueabihf-gcc", CORTEX))
FLOAT_H: Final = ("-DFLT_RADIX=2", "-DFLT_MANT_DIG=24", "-DFLT_MAX_EXP=128", "-DFLT_MAX=3.40282347e+38F")
"""What <float.h> says: cppcheck reads no system headers."""

ALLOWED: Final = (
    "missingIncludeSystem", "unusedFunction", "constParameter", "constParameterPointer", "unmatchedSuppression",
)  # fmt: skip
"""Who includes a header need not call all of it, and the interface is the same in every export."""


@dataclass(frozen=True)
class Export:
    """Files of a few tables, and of others of the same kind; the function that tests them."""

    made: Callable[[ExportPrefix], Files]
    other: Callable[[ExportPrefix], Files]
    self_test: str


def _lines(book: TableBook, *ids: str) -> Callable[[ExportPrefix], Files]:
    few = TableBook(tuple(table for table in book.tables if table.id.startswith(ids)))
    return lambda prefix: c_files(few, prefix, SMALL)


def _points(*tables: str) -> Callable[[ExportPrefix], Files]:
    book = PassageBook((*map(passage_table, tables), odd_table()))
    return lambda prefix: passage_c_files(book, prefix, SMALL)


def _aims(least_m_s: float) -> Callable[[ExportPrefix], Files]:
    aims = AimTables((category_table(least_m_s), measured_table(), category_table(1.5, 4, "СТ")))
    return lambda prefix: aim_c_files(aims, prefix, SMALL)


FEW_LINES: Final = ("light-2.0", "light-3.3", "odd")
"""Two tables between which there are others, and one of odd numbers; with them no code falls away."""

EXPORTS: Final = {
    "lines": Export(_lines(sample_book(), *FEW_LINES), _lines(sample_book(), "light"), "self_test"),
    "odd names": Export(_lines(oddly_named_book(), ""), _lines(sample_book(), "light"), "self_test"),
    "surfaces": Export(_lines(surface_book(), *FEW_LINES), _lines(surface_book(), "light"), "self_test"),
    "points": Export(_points("to 2.5"), _points(), "passages_self_test"),
    "aims": Export(_aims(1.0), _aims(0.7), "aim_self_test"),
    "correction": Export(
        lambda prefix: correction_c_files(Correction(0.15, 0.06), prefix),
        lambda prefix: correction_c_files(Correction(0.1, 0.06), prefix),
        "correction_self_test",
    ),
}
EACH = pytest.mark.parametrize("name", EXPORTS)


@cache
def files_of(name: str, prefix: ExportPrefix = PARK) -> Files:
    return EXPORTS[name].made(prefix)


def header_of(name: str) -> str:
    """The header of its self-test."""
    return f"park_{EXPORTS[name].self_test}.h"


@EACH
@pytest.mark.requirement("CODE-05")
@pytest.mark.parametrize(("compiler", "switches"), STRICT, ids=[compiler for compiler, _ in STRICT])
def test_compilers_have_nothing_to_say(
    name: str, compiler: str, switches: tuple[str, ...], tmp_path: Path, tool: Tool
) -> None:
    for source in written(files_of(name), tmp_path):
        assert compile_with([tool(compiler), *PEDANTIC, *switches, source, "-o", str(tmp_path / "o")]) == ""


@pytest.mark.parametrize("name", every(2, reversed(EXPORTS)))
def test_analysers_have_nothing_to_say(name: str, tmp_path: Path, tool: Tool) -> None:
    sources = written(files_of(name), tmp_path)
    for source in sources:
        assert compile_with([tool("gcc"), *PEDANTIC, "-fanalyzer", source, "-o", str(tmp_path / "o")]) == ""
    caller = tmp_path / "main.c"
    caller.write_text(
        f'#include "{header_of(name)}"\nint main(void) {{ return (int)park_{EXPORTS[name].self_test}(0); }}'
    )
    checks = ["--enable=all", "--inconclusive", "--std=c99", "--quiet", "--error-exitcode=3", *FLOAT_H]
    said = compile_with([tool("cppcheck"), *checks, *(f"--suppress={each}" for each in ALLOWED), *sources, str(caller)])
    assert said == ""


@EACH
@pytest.mark.requirement("CODE-05")
def test_nothing_but_itself_is_linked_nothing_is_variable_and_all_names_have_the_prefix(
    name: str, tmp_path: Path, tool: Tool
) -> None:
    sources = written(files_of(name), tmp_path)
    for source in sources:
        compile_with([tool("gcc"), *CONTRACT, "-Os", "-c", source, "-o", f"{source}.o"])
    listed = compile_with(["nm", *(f"{source}.o" for source in sources)])
    kinds = {(line.split()[-2], line.split()[-1]) for line in listed.splitlines() if len(line.split()) >= 2}
    defined = {symbol for kind, symbol in kinds if kind in "TRDBC"}
    # GCC may make memcpy and memset of a structure's assignment; a freestanding environment has to have them.
    assert {symbol for kind, symbol in kinds if kind == "U"} - defined <= {"memcpy", "memset"}
    assert not {kind for kind, _ in kinds} & set("dDbBC")
    assert len(defined) >= 4
    assert all(symbol.startswith("park_") for symbol in defined)


@EACH
@pytest.mark.requirement("CODE-08")
def test_files_of_two_exports_are_not_compiled_together(name: str, tmp_path: Path, tool: Tool) -> None:
    sources = written(files_of(name), tmp_path)
    other = EXPORTS[name].other(PARK)
    (header,) = (each for each in other if each.endswith(".h") and "self_test" not in each)
    (tmp_path / header).write_bytes(other[header])
    for source in sources:
        with pytest.raises(BuildError, match=rf"{re.escape(header)} is of another export"):
            compile_with([tool("gcc"), *CONTRACT, "-fsyntax-only", source])


@EACH
@pytest.mark.parametrize("standard", ["c++98", "c++17"])
def test_cxx_takes_the_headers_and_since_17_the_code(name: str, standard: str, tmp_path: Path, tool: Tool) -> None:
    sources, caller = written(files_of(name), tmp_path), tmp_path / "caller.cpp"
    caller.write_text(f'#include "{header_of(name)}"\nint main() {{ return park_{EXPORTS[name].self_test}(0); }}\n')
    compiler = [tool("clang"), "-x", "c++", f"-std={standard}", "-pedantic-errors", "-fsyntax-only"]
    compile_with([*compiler, str(caller)])
    for source in sources if standard == "c++17" else ():
        compile_with([*compiler, "-ffp-contract=off", source])


WITHOUT = """
    retarder_correction c; retarder_tracker t;
    retarder_begin_correction(&c); retarder_begin_correction(0); retarder_learn_exit(0, 0, 0.0f, 1);
    retarder_begin_cut(&t); retarder_begin_cut(0);
    wrong += retarder_corrected_speed(retarder_correction_settings, &c, 1.0f) != 1.0f;
    wrong += retarder_decide(0, 0, 1.0f, 1.0f, 0.0f) != 0;
    wrong += retarder_at_pulse(0, &t, 0, 1.0f, 0.1f, 3, 1) != 3;
    wrong += retarder_at_pulse(retarder_passage_tables, 0, 0, 1.0f, 0.1f, 3, 1) != 3;
    wrong += retarder_believed_passage(0, &t, 0, 1.0f, 2.0f) != -1;
    wrong += retarder_wanted_stage(0, 0, 3, 2.0f) != 3;
    wrong += retarder_passage_table_intact(0);
    wrong += PARK_CATEGORY_ST != RETARDER_CATEGORY_ST;
"""
"""Without a table, a tracker or a record nothing is commanded, and nothing falls."""


@pytest.mark.requirement("CODE-09")
def test_all_kinds_of_two_positions_fit_into_one_program(tmp_path: Path, tool: Tool) -> None:
    names = ("lines", "points", "aims", "correction")
    included, called, sources = "", "", []
    for prefix in (PARK, RETARDER):
        for name in names:
            sources += written(files_of(name, prefix), tmp_path)
            (header,) = (each for each in files_of(name, prefix) if each.endswith("self_test.h"))
            included += f'#include "{header}"\n'
            called += f"    wrong += (int){header.removesuffix('.h')}(0);\n"
    main = tmp_path / "main.c"
    main.write_text(f"{included}int main(void)\n{{\n    int wrong = 0;\n{called}{WITHOUT}    return wrong;\n}}\n")
    program = str(tmp_path / "all")
    compile_with([tool("gcc"), *CONTRACT[:-1], "-O0", *sources, str(main), "-o", program])
    assert subprocess.run([program], check=False).returncode == 0


@EACH
def test_the_text_is_plain_and_equal_tables_give_equal_bytes(name: str) -> None:
    files, other = files_of(name), EXPORTS[name].other(PARK)
    assert files == EXPORTS[name].made(PARK)
    assert files != other
    assert list(files) == list(other)
    assert all(file.startswith("park_") for file in files)
    assert b"retarder_" not in b"".join(files.values()).lower()
    for file in (each for each in files if not each.endswith(".csv")):
        lines = files[file].decode("ascii").split("\n")
        assert lines[-1] == ""
        assert all(line == line.rstrip() and not {*"\t@"} & {*line} for line in lines)
        # A row of numbers may be long, and the code points of a name.
        assert [x for x in lines if len(x) > 120 and not re.search(r"<U\+|^ *-?\d|\{-?\d|^ *\{", x)] == []
