"""The sources in SCL: of the subset that a reader of its own knows, and the same program when that reads them."""

from __future__ import annotations

import re

import pytest

from tests.effort import every
from tests.tuning_tables.plc_forms.exports import KINDS, exported, failed, self_test_of
from tests.tuning_tables.plc_forms.scl_reader import structured_text
from tests.tuning_tables.st.syntax import faults, parse
from tuning_tables.plc_forms.scl import scl_files

EACH = pytest.mark.parametrize("kind", KINDS)


def source_of(kind: str) -> str:
    return b"\n".join(scl_files(exported(kind)).values()).decode("ascii")


@pytest.mark.requirement("CODE-04")
@pytest.mark.parametrize("kind", every(3, KINDS))
def test_the_self_test_in_the_sources_finds_nothing(kind: str) -> None:
    text = structured_text(source_of(kind)).encode("ascii")
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
        structured_text(source.replace(right, wrong, 1))
