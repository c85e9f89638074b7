"""The self-test of a controller code in Structured Text: a block for the constants of each table, for the golden
questions, and for the choice; and the whole code as an export, whatever form it is laid out in.

Only questions that have a portable literal are in it: no NaN, no infinity, no denormal number (a controller may take
those for 0), no -0.0.
"""

from __future__ import annotations

import textwrap
from collections.abc import Callable, Iterator, Mapping
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from tuning_tables.category_number import comment_text
from tuning_tables.controller_code.c_self_test import test_stem
from tuning_tables.controller_code.code import BEFORE, ControllerCode, Questions, Rule, kinds_of
from tuning_tables.controller_code.st_code import WIDTH, head, load_of, st_names, st_units, table_type
from tuning_tables.controller_code.st_test_block import (
    TestBlock,
    check,
    choice_tests,
    compared,
    loop,
    odd_test,
    short_name,
    test_block,
    test_name,
)
from tuning_tables.export_names import ExportPrefix, generated
from tuning_tables.language.records import Kind, st_name
from tuning_tables.language.st_data import LONGEST_ARRAY, bool_array, int_array, is_portable, real_array
from tuning_tables.language.st_unit import Block, Declared, Export, Part, Variable, retold
from tuning_tables.language.structured_text import broken
from tuning_tables.language.tree import Parameter

HEAD: Final = (
    "Self-test of {tables}, for the controller that is to run it. {generated}",
    "Call one instance of {block} once a cycle until Done; Failed must be 0. It compares every constant with a second "
    "copy, and the answers of the blocks with those of the reference implementation. Questions that are not finite or "
    "denormal are left out, because they have no portable literal. REAL numbers are compared for equality on purpose: "
    "every bit is due. Remove the blocks after the test if memory is short.",
)

RUN_ALL: Final = """\
IF #Restart OR NOT #Begun THEN
    #Begun := TRUE;
    #Done := FALSE;
    #Number := 0;
    #Failed := 0;
    #FirstFailed := -1;
    #FirstFault := -1;
END_IF;
IF NOT #Done THEN
    #Faults := 0;
    #Fault := -1;
    CASE #Number OF
{cases}
    END_CASE;
    IF #Faults > 0 THEN
        IF #Failed = 0 THEN
            #FirstFailed := #Number;
            #FirstFault := #Fault;
        END_IF;
        #Failed := #Failed + 1;
    END_IF;
    #Done := #Number >= {last};
    #Number := #Number + 1;
END_IF;"""
RUN_ALL_OUTPUTS: Final = (
    Variable("Done", Kind.BOOL),
    Variable("Failed", Kind.INT, "blocks in which something is wrong; 0 when Done: all is as exported"),
    Variable("FirstFailed", Kind.INT, "the number of the first of them, -1: none"),
    Variable("FirstFault", Kind.INT, "FirstFailed of that block"),
)


def self_test_name(code: ControllerCode) -> str:
    """The block that runs all."""
    return f"RETARDER{code.ending.upper()}_SELF_TEST"


def st_test_units(code: ControllerCode, line_checks: int) -> list[Block]:
    """The blocks, none before one that it needs; `line_checks`: how many choices are compared by every number."""
    blocks = [
        *(constants_test(code, number) for number in range(len(code.tables))),
        *(test for questions in code.questions for test in questions_tests(code, questions)),
        *([odd_test(code)] if code.odd else []),
        *(choice_tests(code, line_checks) if code.commands else []),
    ]
    return [*(each.block for each in blocks), run_all(code, blocks)]


def constants_test(code: ControllerCode, number: int) -> TestBlock:
    """The numbers of a table once more."""
    table = code.tables[number]
    name = f"{test_name(code)}_{number}"
    constants, body = compared(code, table.values)
    note = f"Table {number}, {comment_text(table.id)}: its numbers once more."
    block = test_block(name, note, table_type(code), [Variable("Index", Kind.INT)], constants, body)
    return TestBlock(block, number)


def questions_tests(code: ControllerCode, questions: Questions) -> Iterator[TestBlock]:
    """The golden questions, those of a table in a block, no more in one than an array may hold."""
    kept = questions.rows[portable(questions)]
    tables = kept["table"] if "table" in (kept.dtype.names or ()) else np.zeros(len(kept), int)
    for number in dict.fromkeys(tables.tolist()):
        rows = kept[tables == number]
        for part, start in enumerate(range(0, len(rows), LONGEST_ARRAY)):
            name = f"{short_name(code)}_{questions.about.upper()}_{number}" + f"_{part}" * bool(part)
            block = questions_block(code, name, questions, rows[start : start + LONGEST_ARRAY], number)
            yield TestBlock(block, number)


def portable(questions: Questions) -> npt.NDArray[np.bool_]:
    """Which rows have portable numbers; where a state goes on from row to row, those of whole sequences that have."""
    names = [name for name in questions.rows.dtype.names or () if questions.rows.dtype[name].kind == "f"]
    # What nothing looks at may be anything.
    fine = np.ones(len(questions.rows), dtype=bool)
    for name in names:
        column = np.ascontiguousarray(questions.rows[name])
        fine &= is_portable(column) | (np.isnan(column).all() if name in questions.asked else False)
    if "begins" in (questions.rows.dtype.names or ()) and not questions.members_before:
        sequence = np.cumsum(questions.rows["begins"])
        whole = {each for each in np.unique(sequence) if fine[sequence == each].all()}
        fine = np.isin(sequence, list(whole))
    return fine


def questions_block(
    code: ControllerCode, name: str, questions: Questions, rows: npt.NDArray[np.void], number: int
) -> Block:
    """The block of some questions."""
    names, kinds = st_names(code), kinds_of(code, questions)
    programs = [code.program(rule) for rule in questions.rules]
    states = [each for each in code.states if any(each.record.name in program.records for program in programs)]
    constants = [ARRAYS[kind](held(each), rows[each]) for each, kind in kinds.items() if each != "table"]
    variables = [Variable(instance(rule), Declared(names.block(code.program(rule)))) for rule in questions.rules]
    body: list[str] = []
    for each in states:
        state = st_name(each.record.name)
        variables.append(Variable(state, Declared(names.types[each.record.name])))
        body += [f"#{state}.{st_name(name)} := #{held(BEFORE + name)}[#Index];" for name in questions.members_before]
        if "begins" in kinds:
            rule = code.beginning(each.record.name)
            variables.append(Variable(instance(rule), Declared(names.block(code.program(rule)))))
            body += ["IF #Begins[#Index] = 1 THEN", f"    #{instance(rule)}({state} := #{state});", "END_IF;"]
    for rule, program in zip(questions.rules, programs, strict=True):
        given = [text for parameter in program.parameters for text in asked(code, kinds, parameter)]
        body += broken(f"#{instance(rule)}({', '.join(given)});")
    body = loop(len(rows), [*body, *check("\n    OR ".join(differences(code, questions)))])
    of_table = f" of table {number}, {comment_text(code.tables[number].id)}" if "table" in kinds else ""
    note = f"{len(rows)} golden {questions.about}{of_table}."
    return test_block(name, note, table_type(code), [*variables, Variable("Index", Kind.INT)], constants, body)


def asked(code: ControllerCode, kinds: Mapping[str, Kind], parameter: Parameter) -> Iterator[str]:
    """What is handed over for a parameter of a rule; nothing for what is none in the block, or nothing looks at."""
    if parameter.name in st_names(code).arrays:
        return
    if parameter.record is not None:
        yield f"{st_name(parameter.name)} := #{st_name(parameter.name) if parameter.record.is_state else 'Table'}"
    elif parameter.name in kinds:
        is_number = parameter.kind is Kind.BOOL and kinds[parameter.name] is Kind.INT
        yield f"{st_name(parameter.name)} := #{held(parameter.name)}[#Index]" + " = 1" * is_number


def differences(code: ControllerCode, questions: Questions) -> Iterator[str]:
    """Whether an answer, or a member of the state, is another one than is due, each as a condition."""
    programs = [code.program(rule) for rule in questions.rules]
    for rule, program in zip(questions.rules, programs, strict=True):
        for answer in program.answers:
            sign = "XOR" if answer.kind is Kind.BOOL else "<>"
            yield f"(#{instance(rule)}.{st_name(answer.name)} {sign} #{held(answer.name)}[#Index])"
    told = {answer.name for program in programs for answer in program.answers}
    for state in code.states:
        if any(state.record.name in program.records for program in programs):
            for each in questions.expected:
                if each not in told:
                    yield f"(#{st_name(state.record.name)}.{st_name(each)} <> #{held(each)}[#Index])"


ARRAYS: Final[Mapping[Kind, Callable[[str, Any], Variable]]] = {
    Kind.REAL: real_array, Kind.INT: int_array, Kind.BOOL: bool_array,
}  # fmt: skip
"""How a column is written."""


def held(name: str) -> str:
    """The constant array of a column."""
    stem = st_name(name).partition("_")[0]
    return stem if stem.endswith("s") else f"{stem}s"


def instance(rule: Rule) -> str:
    """The instance of a rule's block."""
    return f"{st_name(rule.name)}Block"


def run_all(code: ControllerCode, blocks: list[TestBlock]) -> Block:
    """The block that runs one block a call."""
    cases: list[str] = []
    for number, each in enumerate(blocks):
        given = "" if each.table is None else "Table := #Table"
        load = [] if each.table is None else [f"#Loader(TableNo := {each.table}, Table := #Table);"]
        lines = [
            *load,
            f"#Test_{number}({given});",
            f"#Faults := #Test_{number}.Failed;",
            f"#Fault := #Test_{number}.FirstFailed;",
        ]
        cases += [f"        {number}:", *(f"            {line}" for line in lines)]
    return Block(
        self_test_name(code),
        "Call it once a cycle until Done: each call runs one block of the test.",
        tuple(RUN_ALL.format(cases="\n".join(cases), last=len(blocks) - 1).split("\n")),
        inputs=(Variable("Restart", Kind.BOOL, "begin again"),),
        outputs=RUN_ALL_OUTPUTS,
        own=(
            Variable("Loader", Declared(load_of(code))),
            *(Variable(f"Test_{number}", Declared(each.block.name)) for number, each in enumerate(blocks)),
            Variable("Table", Declared(table_type(code))),
            Variable("Number", Kind.INT),
            Variable("Begun", Kind.BOOL),
            Variable("Faults", Kind.INT),
            Variable("Fault", Kind.INT),
        ),
    )


def self_test_head(code: ControllerCode) -> tuple[str, ...]:
    """The lines of the comment at the beginning of the self-test."""
    names = {"tables": f"retarder_{code.stem}", "block": self_test_name(code), "generated": generated()}
    told = (text.format_map(names) for text in HEAD)
    return tuple(line for text in told for line in ("", *textwrap.wrap(text, WIDTH - 5)))[1:]


def calls(code: ControllerCode, line_checks: int) -> int:
    """How many calls the whole test takes."""
    return len(st_test_units(code, line_checks)) - 1


def st_export(code: ControllerCode, prefix: ExportPrefix, line_checks: int = 0) -> Export:
    """The tables with their blocks, and the self-test, with all names as `prefix` makes them.

    `line_checks`: how many choices the self-test compares by every number.
    """
    tables = Part(f"retarder_{code.stem}", head(code), tuple(st_units(code)))
    test_units = tuple(st_test_units(code, line_checks))
    self_test = Part(f"retarder_{test_stem(code)}", self_test_head(code), test_units, is_test=True)
    return tuple(
        Part(
            prefix.renamed(part.stem),
            tuple(map(prefix.renamed, part.head)),
            tuple(retold(unit, prefix.renamed) for unit in part.units),
            part.is_test,
        )
        for part in (tables, self_test)
    )
