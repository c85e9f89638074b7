"""Every name of every export is one that each tool takes, and what is none is refused in one sentence."""

from __future__ import annotations

from dataclasses import replace

import pytest

from synth.frame.input_error import InputError
from synth.retarder.forms.code_options import PLC_NAMES, CodeOptions
from synth.retarder.forms.plc_forms import PLC_FORMS
from tests.tuning_tables.plc_forms.exports import KINDS, LONGEST, PARK, exported
from tests.tuning_tables.st.test_text import KEYWORDS
from tuning_tables.errors import IllegalName
from tuning_tables.export_prefix import RETARDER, ExportPrefix
from tuning_tables.language.records import Kind
from tuning_tables.language.st_unit import Block, Export, Part, Variable, retold
from tuning_tables.plc_forms.names import CODESYS, IEC, MATIEC, TIA, TOOLS, TWINCAT, Tool, names_in, require_legal

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


def test_the_lists_have_what_the_tests_of_structured_text_avoid() -> None:
    assert set(KEYWORDS.split()) <= set().union(*(tool.words for tool in TOOLS))
    for tool in TOOLS:
        assert all(word == word.upper() and word.isascii() for word in tool.words)
        assert len(tool.words) > 200


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
