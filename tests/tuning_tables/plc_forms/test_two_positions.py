"""Two exports in one project of a PLC: with prefixes of their own they share no name, no file, and no id."""

from __future__ import annotations

import re

import pytest

from synth.retarder.forms.code_options import PLC_NAMES, CodeOptions
from synth.retarder.forms.plc_forms import PLC_FORMS
from tests.tuning_tables.plc_forms.exports import KINDS, PARK, exported, failed, self_test_of
from tests.tuning_tables.plc_forms.plcopen_reader import structured_text as read_plcopen
from tests.tuning_tables.plc_forms.scl_reader import structured_text as read_scl
from tests.tuning_tables.plc_forms.twincat_reader import structured_text as read_twincat
from tuning_tables.export_prefix import RETARDER
from tuning_tables.language.st_unit import Declared, units_of
from tuning_tables.plc_forms.plcopen import plcopen_files
from tuning_tables.plc_forms.scl import scl_files
from tuning_tables.plc_forms.twincat import twincat_files


@pytest.mark.parametrize("form", PLC_NAMES)
@pytest.mark.parametrize("kind", KINDS)
def test_no_file_has_the_same_name(kind: str, form: str) -> None:
    one, other = (PLC_FORMS[form].files(exported(kind, each), CodeOptions(each)) for each in (RETARDER, PARK))
    assert one.keys().isdisjoint(other)
    assert {name.lower() for name in one}.isdisjoint(name.lower() for name in other)


@pytest.mark.parametrize("kind", KINDS)
def test_no_type_or_block_has_the_same_name_and_each_uses_its_own(kind: str) -> None:
    one, other = ([*units_of(exported(kind, prefix))] for prefix in (RETARDER, PARK))
    names = [{unit.name.upper() for unit in units} for units in (one, other)]
    assert names[0].isdisjoint(names[1])
    for units, own in zip((one, other), names, strict=True):
        used = {each.type.name for unit in units for each in unit.variables if isinstance(each.type, Declared)}
        assert len(used) > 2
        assert {each.upper() for each in used} <= own


def test_all_kinds_of_one_position_go_into_one_project() -> None:
    """Tables with lines, for point sensors, aim tables and the correction: none declares what another one does."""
    kinds = ("book", "point sensors", "aim", "correction")
    names = [unit.name for kind in kinds for unit in units_of(exported(kind, PARK))]
    assert len(names) == len(set(names)) > 60


def test_two_books_run_in_one_program_in_each_form() -> None:
    both = [exported("two classes", prefix) for prefix in (RETARDER, PARK)]
    texts = [
        "\n".join(read_plcopen(content) for each in both for content in plcopen_files(each).values()),
        read_twincat({name: content for each in both for name, content in twincat_files(each).items()}),
        "\n".join(read_scl(content.decode("ascii")) for each in both for content in scl_files(each).values()),
    ]
    for text in texts:
        assert len(re.findall(r"FUNCTION_BLOCK\s+PARK_2_\w+", text)) > 10
        assert [failed(text.encode("ascii"), self_test_of(each)) for each in both] == [0, 0]
