"""A controller of another layout is refused: by compiler, linker, the choice itself, and by whoever reads the code.

`layout_1` holds an export of version f503626, of a book with the loaded class first: its numbers are Т 1, Л 2.
"""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from scripts.studies.in_the_loop.controller_process import CONTRACT, BuildError, compile_with
from synth.checker.finding import Kind
from synth.checker.verdict import NOT_CONFIRMED, verify
from synth.cli import main
from tests.controller_code.conftest import Tool
from tuning_tables import read_json
from tuning_tables.c_source import c_files
from tuning_tables.st_source import TABLE_FILE, st_files
from tuning_tables.table_book import TableBook

OLD = Path(__file__).parent / "layout_1"
OLD_CALLER = """
#include "retarder_table.h"
int main(void)
{
    static retarder_table table;
    return retarder_select(1u, 4u, 3.0f, &table) != RETARDER_TUNED;
}
"""
NEW_CALLER = OLD_CALLER.replace("(1u,", "(RETARDER_LAYOUT, RETARDER_CATEGORY_L,")
HOST_CALLER = """
#include "retarder_table.h"
#include <stdio.h>
int main(void)
{
    static const retarder_table none;
    static const unsigned layouts[] = {2u, 0u, 1u, 3u, 4294967295u};
    unsigned place;
    for (place = 0u; place < 5u; ++place) {
        retarder_table table = none;
        const int status = retarder_select(layouts[place], 5u, 4u, 3.0f, &table);
        printf("%d %u %g\\n", status, (unsigned)table.category, table.mass_t);
    }
    return 0;
}
"""


@pytest.fixture(scope="module")
def same_book() -> TableBook:
    """The tables of the old export, in their order."""
    return TableBook(tuple(read_json(OLD / f"{name}.json") for name in ("loaded-to-3", "empty-to-3")))


@pytest.fixture
def new(same_book: TableBook, tmp_path: Path) -> Path:
    """The same book exported today."""
    folder = tmp_path / "new"
    folder.mkdir()
    for name, content in {**c_files(same_book), **st_files(same_book)}.items():
        (folder / name).write_bytes(content)
    return folder


def compiled(folder: Path, caller: str, tmp_path: Path) -> Path:
    """The object of a caller made with the header in `folder`."""
    (tmp_path / "caller.c").write_text(caller)
    made = tmp_path / "caller.o"
    compile_with(["gcc", *CONTRACT[:-1], f"-I{folder}", "-c", str(tmp_path / "caller.c"), "-o", str(made)])
    return made


def linked(caller: Path, folder: Path, tmp_path: Path) -> str:
    """What a caller prints, linked with the tables in `folder`."""
    tables, program = tmp_path / f"{folder.name}.o", tmp_path / "program"
    compile_with(["gcc", *CONTRACT, "-c", str(folder / "retarder_table.c"), "-o", str(tables)])
    compile_with(["gcc", str(caller), str(tables), "-o", str(program)])
    return compile_with([str(program)])


def test_callers_of_their_own_layout_run(new: Path, tmp_path: Path, tool: Tool) -> None:
    tool("gcc")
    linked(compiled(OLD, OLD_CALLER, tmp_path), OLD, tmp_path)
    linked(compiled(new, NEW_CALLER, tmp_path), new, tmp_path)


def test_sources_of_another_layout_do_not_compile(new: Path, tmp_path: Path, tool: Tool) -> None:
    tool("gcc")
    with pytest.raises(BuildError, match="too few arguments to function"):
        compiled(new, OLD_CALLER, tmp_path)
    with pytest.raises(BuildError, match="RETARDER_LAYOUT"):
        compiled(OLD, NEW_CALLER, tmp_path)


def test_objects_of_another_layout_do_not_link(new: Path, tmp_path: Path, tool: Tool) -> None:
    tool("gcc")
    old_caller = compiled(OLD, OLD_CALLER, tmp_path)
    with pytest.raises(BuildError, match=r"undefined reference to .retarder_select."):
        linked(old_caller, new, tmp_path)
    with pytest.raises(BuildError, match=r"undefined reference to .retarder_select_layout_2."):
        linked(compiled(new, NEW_CALLER, tmp_path), OLD, tmp_path)


def test_files_of_two_layouts_are_not_compiled_together(new: Path, tmp_path: Path, tool: Tool) -> None:
    tool("gcc")
    for head, body in ((new, OLD), (OLD, new)):
        mixed = tmp_path / f"mixed-{head.name}"
        mixed.mkdir()
        shutil.copy(head / "retarder_table.h", mixed)
        shutil.copy(body / "retarder_table.c", mixed)
        with pytest.raises(BuildError, match="is of another export"):
            compile_with(["gcc", "-std=c99", "-c", str(mixed / "retarder_table.c"), "-o", str(tmp_path / "o")])


def test_a_host_of_another_layout_gets_no_table(new: Path, tmp_path: Path, tool: Tool) -> None:
    tool("gcc")
    said = linked(compiled(new, HOST_CALLER, tmp_path), new, tmp_path).splitlines()
    assert said == ["0 5 85", *["-3 0 0"] * 4]


def test_an_old_export_is_recognised_and_not_called_damaged(
    new: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    old = Path(shutil.copytree(OLD, tmp_path / "old"))
    verdict = verify(old, 100, 1)
    assert {(finding.kind, finding.about) for finding in verdict.findings} == {
        (Kind.LAYOUT, "retarder_table.c"), (Kind.LAYOUT, "retarder_table.st"),
    }  # fmt: skip
    assert all("layout 1" in each.sentence and "export again" in each.sentence for each in verdict.findings)
    assert verdict.code == NOT_CONFIRMED
    for path, lines in ((old, 2), (old / "retarder_table.c", 1), (old / "retarder_table.st", 1)):
        assert main(["inspect", str(path)]) == 0
        said = [line for line in capsys.readouterr().out.splitlines() if "layout" in line]
        assert len(said) == lines
        assert all("layout 1" in line and line.endswith("export again") for line in said)
    for name in ("empty-to-3", "loaded-to-3"):
        shutil.copy(old / f"{name}.json", new)
    assert verify(new, 100, 1).findings == ()
    assert main(["inspect", str(new), "--json"]) == 0
    assert capsys.readouterr().out.count('"layout": 2') == 2


@pytest.mark.parametrize(
    ("name", "text", "newer"),
    [
        ("retarder_table.h", "RETARDER_LAYOUT 2u", "RETARDER_LAYOUT 3u"),
        ("retarder_table.st", "IF Layout <> 2 THEN", "IF Layout <> 3 THEN"),
    ],
)
def test_a_newer_export_asks_for_a_newer_checker(new: Path, name: str, text: str, newer: str) -> None:
    for table in ("empty-to-3", "loaded-to-3"):
        shutil.copy(OLD / f"{table}.json", new)
    content = (new / name).read_text("ascii")
    assert content.count(text) == 1
    (new / name).write_text(content.replace(text, newer), "ascii")
    (finding,) = verify(new, 100, 1).findings
    assert (finding.kind, finding.about) == (Kind.LAYOUT, name.replace(".h", ".c"))
    assert "layout 3" in finding.sentence


def test_a_wrong_number_in_the_code_is_found(new: Path) -> None:
    for table in ("empty-to-3", "loaded-to-3"):
        shutil.copy(OLD / f"{table}.json", new)
    content = (new / TABLE_FILE).read_text("ascii")
    assert "CategoryOf : ARRAY[0..1] OF INT := [5, 1];" in content
    (new / TABLE_FILE).write_text(content.replace("INT := [5, 1];", "INT := [1, 2];"), "ascii")
    (finding,) = verify(new, 100, 1).findings
    assert (finding.kind, finding.sentence) == (Kind.DISAGREES, "CategoryOf[0] is 1, but the table says 5")
