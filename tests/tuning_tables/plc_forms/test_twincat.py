"""The objects of TwinCAT: well-formed, each with an id of its own, and the same program to another reader."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import uuid
from dataclasses import replace
from pathlib import Path

import pytest

from tests.effort import every
from tests.tuning_tables.plc_forms.exports import KINDS, PARK, exported, failed, self_test_of
from tests.tuning_tables.plc_forms.twincat_reader import objects, structured_text
from tests.tuning_tables.st.syntax import faults, parse
from tuning_tables.language.st_unit import Part, units_of
from tuning_tables.plc_forms.twincat import twincat_files

EACH = pytest.mark.parametrize("kind", KINDS)


@pytest.mark.requirement("CODE-04")
@pytest.mark.parametrize("kind", every(3, KINDS))
def test_the_self_test_in_the_objects_finds_nothing(kind: str) -> None:
    text = structured_text(twincat_files(exported(kind))).encode("ascii")
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
