"""The XML of PLCopen: valid against the schema where that is there, and the same program to another reader."""

from __future__ import annotations

import os
import sys
from importlib import import_module
from pathlib import Path
from xml.etree import ElementTree

import pytest

from tests.effort import every
from tests.tuning_tables.plc_forms.exports import KINDS, PARK, exported, failed, self_test_of
from tests.tuning_tables.plc_forms.plcopen_reader import TC6, structured_text
from tests.tuning_tables.st.syntax import faults, parse
from tuning_tables.language.st_layout import unit_text
from tuning_tables.language.st_unit import Block, Structure, units_of
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
    text = structured_text(content_of(kind)).encode("ascii")
    assert faults(parse(text)) == []
    assert failed(text, self_test_of(exported(kind))) == 0


@EACH
def test_the_xml_says_what_the_text_says(kind: str) -> None:
    """Token by token, whatever the white space and the comments are."""
    units = [*units_of(exported(kind))]
    ordered = [each for group in (Structure, Block) for each in units if isinstance(each, group)]
    text = "\n".join(map(unit_text, ordered)).encode("ascii")
    assert tokens(structured_text(content_of(kind)).encode("ascii")) == tokens(text)


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
