"""Every name of every export is one that each tool takes; two positions in one project share no name, file or id."""

from __future__ import annotations

import re
from dataclasses import replace

import pytest

from synth.frame.faults import InputError
from synth.retarder.forms.code_options import PLC_FORMS, PLC_NAMES, CodeOptions
from tests.tuning_tables.plc_forms.exports import KINDS, LONGEST, PARK, exported, failed, self_test_of
from tests.tuning_tables.plc_forms.readers import plcopen_text, scl_text, twincat_text
from tuning_tables.errors import IllegalName
from tuning_tables.export_names import RETARDER, ExportPrefix
from tuning_tables.language.records import Kind
from tuning_tables.language.st_unit import Block, Declared, Export, Part, Variable, retold, units_of
from tuning_tables.plc_forms.makers import scl_files, twincat_files
from tuning_tables.plc_forms.names import CODESYS, IEC, MATIEC, TIA, TOOLS, TWINCAT, Tool, names_in, require_legal
from tuning_tables.plc_forms.plcopen import plcopen_files

EACH_TOOL = pytest.mark.parametrize("tool", TOOLS, ids=lambda tool: tool.title)


def with_variable(name: str) -> Export:
    """An export of one block with one variable."""
    return (Part("retarder_table", ("",), (Block("A_BLOCK", "A block.", (), own=(Variable(name, Kind.INT),)),)),)


@EACH_TOOL
@pytest.mark.parametrize("prefix", [RETARDER, PARK, LONGEST], ids=lambda prefix: prefix.text)
@pytest.mark.parametrize("kind", KINDS)
def test_each_tool_takes_every_name(kind: str, prefix: ExportPrefix, tool: Tool) -> None:
    export = exported(kind, prefix)
    assert len({*names_in(export)}) > 50
    require_legal(export, tool)


@pytest.mark.parametrize(
    ("tool", "word"),
    [(IEC, "Limit"), (IEC, "End_Step"), (CODESYS, "Pointer"), (TWINCAT, "FB_init"), (MATIEC, "Ramp"), (TIA, "Region"),
     (TIA, "Get_AlarmState"), (TIA, "begin"), (CODESYS, "a__b"), (MATIEC, "Held_")],
)  # fmt: skip
def test_a_word_of_a_tool_is_refused(tool: Tool, word: str) -> None:
    with pytest.raises(IllegalName, match=f"^{word} is a word that {tool.title.partition(' (')[0]}"):
        require_legal(with_variable(word), tool)


@EACH_TOOL
def test_a_name_that_is_too_long_is_refused(tool: Tool) -> None:
    require_legal(with_variable("a" * tool.longest), tool)
    with pytest.raises(IllegalName, match=f"has {tool.longest + 1} characters, but .* takes {tool.longest} at most"):
        require_legal(with_variable("a" * (tool.longest + 1)), tool)


@pytest.mark.parametrize("form", PLC_NAMES)
def test_a_prefix_that_makes_a_word_is_refused_in_one_sentence(form: str) -> None:
    """No name of today ends so; a rule that is called `step` would make END_STEP of the prefix END."""
    options = CodeOptions(ExportPrefix("END"))
    tables, tests = exported("book", options.prefix)
    first = retold(tables.units[0], lambda text: text.replace("END_TABLE", "END_STEP"))
    export = (replace(tables, units=(first, *tables.units[1:])), tests)
    with pytest.raises(InputError, match=r"^--prefix END: END_STEP is a word that .*; give another prefix$"):
        PLC_FORMS[form].files(export, options)
    assert PLC_FORMS[form].files((tables, tests), options)


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
        "\n".join(plcopen_text(content) for each in both for content in plcopen_files(each).values()),
        twincat_text({name: content for each in both for name, content in twincat_files(each).items()}),
        "\n".join(scl_text(content.decode("ascii")) for each in both for content in scl_files(each).values()),
    ]
    for text in texts:
        assert len(re.findall(r"FUNCTION_BLOCK\s+PARK_2_\w+", text)) > 10
        assert [failed(text.encode("ascii"), self_test_of(each)) for each in both] == [0, 0]
