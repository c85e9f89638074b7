"""PLCopen XML, SCL and TwinCAT objects: well-formed, and the same program to another reader."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import uuid
from dataclasses import replace
from importlib import import_module
from pathlib import Path
from xml.etree import ElementTree

import pytest

from tests.effort import every
from tests.tuning_tables.plc_forms.exports import KINDS, PARK, exported, failed, self_test_of
from tests.tuning_tables.plc_forms.readers import TC6, objects, plcopen_text, scl_text, twincat_text
from tests.tuning_tables.st.syntax import faults, parse
from tuning_tables.language.st_layout import unit_text
from tuning_tables.language.st_unit import Block, Part, Structure, units_of
from tuning_tables.plc_forms.makers import scl_files, twincat_files
from tuning_tables.plc_forms.plcopen import plcopen_files

EACH = pytest.mark.parametrize("kind", KINDS)
SCHEMA = Path(os.environ.get("RETARDER_SYNTH_TC6_XSD", Path(sys.prefix) / "share" / "tc6_xml_v201.xsd"))
"""The schema may not lie in the repository; `scripts/setup_toolchain` fetches it."""


def content_of(kind: str) -> bytes:
    (content,) = plcopen_files(exported(kind)).values()
    return content


@pytest.mark.requirement("CODE-04")
@pytest.mark.parametrize("kind", every(3, KINDS))
def test_the_self_test_in_the_xml_finds_nothing(kind: str) -> None:
    text = plcopen_text(content_of(kind)).encode("ascii")
    assert faults(parse(text)) == []
    assert failed(text, self_test_of(exported(kind))) == 0


@EACH
def test_the_xml_says_what_the_text_says(kind: str) -> None:
    """Token by token, whatever the white space and the comments are."""
    units = [*units_of(exported(kind))]
    ordered = [each for group in (Structure, Block) for each in units if isinstance(each, group)]
    text = "\n".join(map(unit_text, ordered)).encode("ascii")
    assert tokens(plcopen_text(content_of(kind)).encode("ascii")) == tokens(text)


def tokens(text: bytes) -> list[bytes]:
    """The leaves of the parse tree but comments."""
    found, rest = [], [parse(text)]
    while rest:
        node = rest.pop()
        if node.type != "comment":
            rest += reversed(node.children)
            found += [] if node.children else [node.text]
    assert len(found) > 100
    return found


@EACH
def test_each_note_is_in_the_xml(kind: str) -> None:
    told = {each.text for each in ElementTree.fromstring(content_of(kind)).iter("{http://www.w3.org/1999/xhtml}p")}
    notes = {each.note for unit in units_of(exported(kind)) for each in (unit, *unit.variables)} - {""}
    assert len(notes) > 10
    assert notes <= told


def test_one_file_is_called_as_the_tables_are() -> None:
    assert list(plcopen_files(exported("book", PARK))) == ["park_2_table.xml"]
    assert list(plcopen_files(exported("correction"))) == ["retarder_correction.xml"]


def test_the_head_is_the_comment_of_the_project() -> None:
    root = ElementTree.fromstring(content_of("book"))
    comment = root.findtext(f"{TC6}contentHeader/{TC6}Comment") or ""
    assert all(line in comment.split("\n") for part in exported("book") for line in part.head)


@pytest.mark.parametrize("kind", every(6, KINDS))
def test_the_schema_takes_the_xml(kind: str, tmp_path: Path) -> None:
    if os.environ.get("RETARDER_SYNTH_TOOLCHAIN") != "complete":
        pytest.importorskip("xmlschema")
        if not SCHEMA.is_file():
            pytest.skip(f"no schema at {SCHEMA}")
    xmlschema = import_module("xmlschema")
    schema = xmlschema.XMLSchema(str(SCHEMA))
    file = tmp_path / "export.xml"
    file.write_bytes(content_of(kind))
    schema.validate(str(file))
    for right, wrong in ((b' pouType="functionBlock"', b""), (b"<INT/>", b"<Int/>"), (b"<body>", b"<body><ST/>")):
        assert right in content_of(kind)
        file.write_bytes(content_of(kind).replace(right, wrong, 1))
        assert not schema.is_valid(str(file))


def source_of(kind: str) -> str:
    return b"\n".join(scl_files(exported(kind)).values()).decode("ascii")


@pytest.mark.requirement("CODE-04")
@pytest.mark.parametrize("kind", every(3, KINDS))
def test_the_self_test_in_the_sources_finds_nothing(kind: str) -> None:
    text = scl_text(source_of(kind)).encode("ascii")
    assert faults(parse(text)) == []
    assert failed(text, self_test_of(exported(kind))) == 0


@EACH
def test_the_sources_are_plain(kind: str) -> None:
    for text in scl_files(exported(kind)).values():
        lines = text.decode("ascii").split("\n")
        assert lines[-1] == ""
        assert all(line == line.rstrip() and line.isprintable() for line in lines)
        assert all(len(line) <= 140 for line in lines if "<U+" not in line)
        assert not re.search(rb'//[^\n]*"', text), "a quote in a comment would be read as a name"


def test_two_sources_are_called_as_the_tables_and_the_self_test_are() -> None:
    assert list(scl_files(exported("book"))) == ["retarder_table.scl", "retarder_self_test.scl"]
    assert list(scl_files(exported("aim"))) == ["aim_table.scl", "aim_self_test.scl"]


@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        ("#Status := -1;", "Status := -1;"),
        ("#Table.Stages := 0;", "#Table.#Stages := 0;"),
        ('"RETARDER_LOAD";', "RETARDER_LOAD;"),
        ('FUNCTION_BLOCK "RETARDER_BEGIN"', "FUNCTION_BLOCK RETARDER_BEGIN"),
        ("BEGIN\n", "\n"),
        ("VERSION : 0.1\n", "\n"),
        ("{ S7_Optimized_Access := 'TRUE' }\n", "\n"),
        ("Commanded_m_s := #Commanded_m_s", "#Commanded_m_s := #Commanded_m_s"),
        ("    VAR\n        CategoryOf", "    VAR CONSTANT\n        CategoryOf"),
        ("    VAR CONSTANT\n        LargestNumber", "    VAR CONSTANT\n        OtherNumber"),
    ],
)
def test_the_reader_finds_what_is_no_scl(right: str, wrong: str) -> None:
    source = source_of("book")
    assert right in source
    with pytest.raises((AssertionError, IndexError)):
        scl_text(source.replace(right, wrong, 1))


@pytest.mark.requirement("CODE-04")
@pytest.mark.parametrize("kind", every(3, KINDS))
def test_the_self_test_in_the_objects_finds_nothing(kind: str) -> None:
    text = twincat_text(twincat_files(exported(kind))).encode("ascii")
    assert faults(parse(text)) == []
    assert failed(text, self_test_of(exported(kind))) == 0


@EACH
def test_each_unit_is_a_file_and_has_an_id(kind: str) -> None:
    files = twincat_files(exported(kind))
    found = objects(files)
    assert {each.name for each in found} == {each.name for each in units_of(exported(kind))}
    assert len({each.id for each in found}) == len(found) == len(files)
    assert all(each.id == f"{{{uuid.UUID(each.id)}}}" for each in found)


def test_what_belongs_to_the_self_test_lies_in_a_folder_of_its_own() -> None:
    files = twincat_files(exported("book"))
    assert {"RETARDER_TABLE.TcDUT", "RETARDER_SELECT.TcPOU", "self_test/RETARDER_SELF_TEST.TcPOU"} < set(files)
    assert {name for name in files if "_TEST" in name} == {name for name in files if name.startswith("self_test/")}


def test_equal_exports_have_equal_ids_and_others_have_others() -> None:
    once, again = (objects(twincat_files(exported("book"))) for _ in range(2))
    assert once == again
    tables, tests = exported("book")
    changed = replace(tables.units[0], note="another note")
    other = objects(twincat_files((Part(tables.stem, tables.head, (changed, *tables.units[1:])), tests)))
    assert {each.id for each in once} - {each.id for each in other} == {
        each.id for each in once if each.name == changed.name
    }
    park = {each.id for each in objects(twincat_files(exported("book", PARK)))}
    assert not park & {each.id for each in once}


def test_the_head_is_a_comment_before_the_first_type() -> None:
    text = twincat_files(exported("book"))["RETARDER_TABLE.TcDUT"].decode("ascii")
    for line in exported("book")[0].head:
        assert line.strip() in text
    assert text.index("configuration") < text.index("TYPE RETARDER_TABLE :")


def test_blark_parses_the_smallest_objects(tmp_path: Path) -> None:
    """A parser of TwinCAT, as a program of its own, since its licence is not ours; it takes minutes for larger ones."""
    blark = shutil.which("blark", path=f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}")
    if blark is None and os.environ.get("RETARDER_SYNTH_TOOLCHAIN") != "complete":
        pytest.skip("no blark")
    assert blark is not None
    files = twincat_files(exported("book"))
    chosen = {path: files[path] for path in ("RETARDER_TABLE.TcDUT", "RETARDER_SELECT.TcPOU")}
    broken = files["RETARDER_SELECT.TcPOU"].replace(b"END_IF;", b"END;", 1)
    for path, content in {"wrong/RETARDER_SELECT.TcPOU": broken, **chosen}.items():
        file = tmp_path / path
        file.parent.mkdir(exist_ok=True)
        file.write_bytes(content)
        ran = subprocess.run([blark, "parse", "-s", file], capture_output=True, text=True, timeout=120, check=False)
        found = re.search(rf"name: {file.stem}$", ran.stdout, re.MULTILINE) is not None
        assert found == (content is not broken), f"{path}: {ran.stdout[-500:]}{ran.stderr[-500:]}"
