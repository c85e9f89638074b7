"""Controller code of every kind of tables in every form: sound exports pass, and every changed number is found."""

from __future__ import annotations

import random
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Final

import pytest

from synth.checker.code_export import FOLDERS, CodeFile, code_at, code_files
from synth.checker.code_records import plain
from synth.checker.exports import code_differences
from synth.checker.finding import Finding, Kind, findings_of
from synth.checker.source import Source, read_source
from synth.checker.verdict import verify
from synth.retarder.forms.code_options import CODE_NAMES, OPTIONS, CodeOptions
from synth.retarder.forms.table_forms import FORMS
from tests.controller_code.passage_tables import passage_book
from tests.controller_code.sample_book import approaching_book, surface_book
from tests.effort import every
from tests.tuning_tables.aim.made_tables import category_table, measured_table
from tuning_tables import to_json
from tuning_tables.document import AnyTable
from tuning_tables.export_names import RETARDER, ExportPrefix
from tuning_tables.language.records import Record, st_name
from tuning_tables.programs.aim_speed import AIM_GRID
from tuning_tables.programs.held import HELD_PASSAGES, LINE_TABLE
from tuning_tables.self_test_size import SMALL

LONG: Final = f"{'of a long name ' * 9}{'x' * 100}"
"""Comments break it into lines, each form at other places."""


def named(*tables: AnyTable) -> tuple[AnyTable, ...]:
    """The tables with long ids, by which they stand in another order than in the code."""
    return tuple(replace(table, id=f"{letter} {LONG}") for letter, table in zip("zyx", tables, strict=False))


KINDS: Final[Mapping[str, tuple[Record, tuple[AnyTable, ...]]]] = {
    "lines": (LINE_TABLE, named(*surface_book(approaching_book()).tables[:2])),
    "points": (HELD_PASSAGES, named(passage_book().tables[0], passage_book().tables[5])),
    "aim": (AIM_GRID, named(category_table(1.0), measured_table())),
}
LAYOUTS: Final = (*((form, False) for form in CODE_NAMES), *((form, True) for form in OPTIONS["--split"]))
"""Forms of code, in one piece or split."""
EXPORTS: Final = [
    pytest.param(kind, form, split, id=f"{kind}-{form}{'-split' * split}") for kind in KINDS for form, split in LAYOUTS
]
NUMBER: Final = r"-?(?:0x[01][0-9a-f.]*p[+-]\d+f|\d[\d.]*(?:E[+-]\d+)?)"


def written(folder: Path, kind: str, form: str, split: bool, prefix: ExportPrefix = RETARDER) -> Path:
    """The tables in `folder`, with their code in a folder of the form."""
    _, tables = KINDS[kind]
    files = {f"tables/{table.id[0]}.json": to_json(table) for table in tables}
    code = FORMS[form](tables, CodeOptions(prefix, SMALL, split))
    for name, content in {**files, **{f"{form}/{name}": content for name, content in code.items()}}.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_bytes(content)
    return folder


def found_in(code: CodeFile, source: Source) -> list[Finding]:
    """What the comparison of an export finds."""
    return list(findings_of(code.path.name, lambda: code_differences(code, source)))


def only_code(folder: Path) -> CodeFile:
    """The one export that there is."""
    (code,) = code_files(folder)
    return code


def number_of(member: str, is_array: bool, file: Path) -> re.Pattern[str]:
    """What finds the first number of a member in a file, as group 1."""
    if file.suffix == ".c":
        before = rf"/\* {member} \*/[\s{{]*({NUMBER})" if is_array else rf"({NUMBER}), /\* {member}(?::| \*/)"
        return re.compile(before)
    stem = st_name(member).partition("_")[0]
    name = f"{stem}_0" if is_array else f"{stem}Of"
    if file.suffix == ".xml":
        return re.compile(rf'<variable name="{name}">.*?<simpleValue value="({NUMBER})"', re.DOTALL)
    return re.compile(rf"\b{name} : (?i:ARRAY)\S+ (?i:OF) \w+ := \[\s*({NUMBER})")


def changed_numbers(record: Record, file: Path) -> Iterator[tuple[str, str]]:
    """Each member, and the text of the file with another first number of it."""
    text = file.read_text(encoding="ascii")
    for member, declared in record.members.items():
        found = number_of(member, bool(declared.axes), file).search(text)
        assert found is not None, member
        new = "0x1.8p+7f" if "p" in found[1] else "7.5" if "." in found[1] else str(int(found[1]) + 1)
        yield plain(member), text[: found.start(1)] + new + text[found.end(1) :]


@pytest.mark.parametrize("prefix", every(2, [ExportPrefix("PARK_2"), RETARDER]), ids=["prefix", "plain"])
@pytest.mark.parametrize(("kind", "form", "split"), EXPORTS)
def test_a_sound_export_is_compared_and_confirmed(
    tmp_path: Path, kind: str, form: str, split: bool, prefix: ExportPrefix
) -> None:
    verdict = verify(written(tmp_path, kind, form, split, prefix), 2, 1)
    assert [each for each in verdict.findings if each.kind is not Kind.CLAIM] == []
    assert form in FOLDERS
    code = [name for name in verdict.files if name.startswith(f"{form}/") and not name.endswith(".csv")]
    assert code == [f"{form}/{only_code(tmp_path).path.name}"]
    assert code_at(tmp_path) == code_at(tmp_path / code[0]) == (only_code(tmp_path),)


@pytest.mark.requirement("VERIFY-05")
@pytest.mark.parametrize(("kind", "form", "split"), EXPORTS)
def test_a_changed_number_of_any_member_is_found(tmp_path: Path, kind: str, form: str, split: bool) -> None:
    source = read_source(written(tmp_path, kind, form, split))
    code, (record, tables) = only_code(tmp_path), KINDS[kind]
    for member, text in changed_numbers(record, code.path):
        code.path.write_text(text, encoding="ascii")
        found = found_in(code, source)
        of_member = [each for each in found if re.search(rf": {member}(\[0\])? of table 0 is ", each.sentence)]
        assert [each.about for each in of_member] == [tables[0].id], member
        assert (form == "c") == any("the crc32 of table 0 is " in each.sentence for each in found)


@pytest.mark.parametrize(("kind", "form", "split"), EXPORTS)
def test_a_cut_file_is_damaged(tmp_path: Path, kind: str, form: str, split: bool) -> None:
    source = read_source(written(tmp_path, kind, form, split))
    for file in only_code(tmp_path).files():
        whole = file.read_bytes()
        for end in (*(len(whole) * eighths // 8 for eighths in range(8)), len(whole) - 2):
            file.write_bytes(whole[:end])
            assert [each.kind for each in found_in(only_code(tmp_path), source)] == [Kind.DAMAGED], (file.name, end)
        file.write_bytes(whole)


@pytest.mark.parametrize(("kind", "form", "split"), EXPORTS)
def test_broken_bytes_never_raise(tmp_path: Path, kind: str, form: str, split: bool) -> None:
    source, chance = read_source(written(tmp_path, kind, form, split)), random.Random(kind + form)
    code = only_code(tmp_path)
    whole, faulty = code.path.read_bytes(), 0
    for _ in range(30):
        broken = bytearray(whole)
        for _ in range(40):
            broken[chance.randrange(len(broken))] = chance.choice(b'0123456789-+eE.,:"{}[]<>/nN\x00\xff')
        code.path.write_bytes(bytes(broken))
        faulty += bool(found_in(code, source))
    assert faulty > 25


@pytest.mark.parametrize("form", ["plcopen", "twincat"])
def test_xml_that_declares_what_it_consists_of_is_refused(tmp_path: Path, form: str) -> None:
    source = read_source(written(tmp_path, "aim", form, False))
    code = only_code(tmp_path)
    head, rest = code.path.read_text(encoding="ascii").split("\n", 1)
    code.path.write_text(f'{head}\n<!DOCTYPE x [<!ENTITY one "1">]>\n{rest}', encoding="ascii")
    (finding,) = found_in(code, source)
    assert (finding.kind, finding.sentence) == (Kind.DAMAGED, "it has a DOCTYPE, which no export has")


def test_values_that_stand_for_several_are_refused(tmp_path: Path) -> None:
    source = read_source(written(tmp_path, "aim", "plcopen", False))
    code = only_code(tmp_path)
    text = code.path.read_text(encoding="ascii")
    code.path.write_text(text.replace("<value>", '<value repetitionValue="2">', 1), encoding="ascii")
    (finding,) = found_in(code, source)
    assert finding.kind is Kind.DAMAGED
    assert "have attributes" in finding.sentence


def test_somebody_elses_files_are_no_exports(tmp_path: Path) -> None:
    for name in ("my_table.c", "my_table.xml", "TABLE.xml", "my_passages.scl", "LOAD.TcPOU", "0001_LOAD.st"):
        (tmp_path / name).write_text("nothing of ours", encoding="ascii")
    assert names_of(code_files(tmp_path)) == []
    (tmp_path / "retarder_table.xml").mkdir()
    assert names_of(code_files(tmp_path)) == ["retarder_table.xml"]


def names_of(files: Iterator[CodeFile]) -> Sequence[str]:
    """The names of exports."""
    return [code.path.name for code in files]
