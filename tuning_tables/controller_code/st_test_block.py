"""Blocks of the self-test in Structured Text: their frame (what is counted, loops, checks of a whole table),
golden choices by status and target, and questions to tables that no book has.
"""

from __future__ import annotations

import textwrap
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

import numpy as np

from tuning_tables.controller_code.code import Commanded, ControllerCode, Values
from tuning_tables.controller_code.st_code import WIDTH, member_array, select_block_of, st_names, table_type
from tuning_tables.language.records import Kind, SizedRecord, st_name
from tuning_tables.language.st_data import LONGEST_ARRAY, int_array, is_portable, pieces, place_of, real_array
from tuning_tables.language.st_unit import Block, Declared, Variable
from tuning_tables.language.walking import looked_at

CHECK: Final = """\
IF {differs} THEN
    IF #Failed = 0 THEN
        #FirstFailed := #Number;
    END_IF;
    #Failed := #Failed + 1;
END_IF;
#Number := #Number + 1;"""

OUTPUTS: Final = (
    Variable("Failed", Kind.INT, "checks that are wrong"),
    Variable("FirstFailed", Kind.INT, "the first of them, counted from 0; -1: none"),
)


@dataclass(frozen=True)
class TestBlock:
    """A block of the self-test, and the table that it takes, None for none."""

    block: Block
    table: int | None


def test_name(code: ControllerCode) -> str:
    """How the names of the self-test's blocks begin."""
    return f"RETARDER{code.ending.upper()}_TEST"


def short_name(code: ControllerCode) -> str:
    """How the names of blocks with questions begin: with all that follows they have 30 characters at most."""
    return test_name(code) if not code.ending else f"RETARDER{code.ending.upper()}"


def test_block(
    name: str, note: str, table: str, variables: list[Variable], constants: list[Variable], body: list[str]
) -> Block:
    """A block of the test; `table`: the type of the one that it takes, "" for none."""
    return Block(
        name,
        note,
        ("#Failed := 0;", "#FirstFailed := -1;", "#Number := 0;", *body),
        in_outs=(Variable("Table", Declared(table)),) if table else (),
        outputs=OUTPUTS,
        own=(*variables, Variable("Number", Kind.INT)),
        constants=tuple(constants),
    )


def check(differs: str, depth: int = 0) -> list[str]:
    """A check that counts."""
    return [" " * 4 * depth + line for line in CHECK.format(differs=differs).split("\n")]


def loop(length: int, body: list[str]) -> list[str]:
    """A loop over Index from 0."""
    return [
        "#Index := 0;",
        f"WHILE #Index < {length} DO",
        *(f"    {line}" for line in body),
        "    #Index := #Index + 1;",
        "END_WHILE;",
    ]


def compared(code: ControllerCode, values: Values) -> tuple[list[Variable], list[str]]:
    """Constants and checks of all numbers of `Table`."""
    constants: list[Variable] = []
    numbers: list[str] = []
    body: list[str] = []
    for name, member in code.table.members.items():
        array = np.atleast_1d(np.asarray(values[name])).ravel()
        # With a word behind it, because Step and Limit alone are words of the language.
        twin = f"{st_name(name).partition('_')[0]}Due"
        for ending, start, count in pieces(len(array)):
            constants.append(member_array(f"{twin}{ending}", member, array[start : start + count]))
            if member.axes:
                differs = f"#Table.{st_name(name)}[{place_of(start)}] <> #{twin}{ending}[#Index]"
                body += loop(count, check(differs))
        if not member.axes:
            numbers.append(f"(#Table.{st_name(name)} <> #{twin}[0])")
    return constants, [*check("\n    OR ".join(numbers)), *body]


def choice_tests(code: ControllerCode, line_checks: int) -> Iterator[TestBlock]:
    """The golden choices by status and target, and some of those between two tables by every number."""
    known = [each for each in code.commands if is_portable(np.array([each.commanded_m_s]))[0]]
    for part, start in enumerate(range(0, len(known), LONGEST_ARRAY)):
        name = f"{short_name(code)}_CHOICES" + f"_{part}" * bool(part)
        yield TestBlock(choices_block(code, name, known[start : start + LONGEST_ARRAY]), None)
    between = [each for each in known if each.status == 1][::3][:line_checks]
    for place, each in enumerate(between):
        name = f"{test_name(code)}_BETWEEN_{place}"
        yield TestBlock(between_block(code, name, each), None)


def choices_block(code: ControllerCode, name: str, commands: list[Commanded]) -> Block:
    """The block of choices by status and target speed."""
    targets = [np.float32(0.0 if each.chosen is None else each.chosen["target_m_s"]) for each in commands]
    constants = [
        int_array("Categories", [each.category for each in commands]),
        int_array("AxleNumbers", [each.axles for each in commands]),
        real_array("Commands", [each.commanded_m_s for each in commands]),
        int_array("Statuses", [each.status for each in commands]),
        real_array("Targets", targets),
    ]
    variables = [
        Variable("Selector", Declared(select_block_of(code))),
        Variable("Chosen", Declared(table_type(code))),
        Variable("Target", Kind.REAL),
        Variable("Index", Kind.INT),
    ]
    body = [
        "#Selector(Category := #Categories[#Index], Axles := #AxleNumbers[#Index], Commanded_m_s := #Commands[#Index],",
        "    Table := #Chosen);",
        "#Target := 0.0;",
        "IF #Chosen.Stages > 0 THEN",
        "    #Target := #Chosen.Target_m_s;",
        "END_IF;",
        *check("(#Selector.Status <> #Statuses[#Index]) OR (#Target <> #Targets[#Index])"),
    ]
    note = f"{len(commands)} choices by status and target speed."
    return test_block(name, note, "", variables, constants, loop(len(commands), body))


def between_block(code: ControllerCode, name: str, command: Commanded) -> Block:
    """The block of one choice by every number of the table."""
    assert command.chosen is not None
    constants, body = compared(code, command.chosen)
    constants.append(real_array("Command", [command.commanded_m_s]))
    cut = f"Category := {command.category}, Axles := {command.axles}"
    asked = f"#Selector({cut}, Commanded_m_s := #Command[0], Table := #Table);"
    variables = [
        Variable("Selector", Declared(select_block_of(code))),
        Variable("Table", Declared(table_type(code))),
        Variable("Index", Kind.INT),
    ]
    note = f"The table between two, for {float(command.commanded_m_s):.6g} m/s, by every number."
    return test_block(name, note, "", variables, constants, [asked, *check("#Selector.Status <> 1"), *body])


def odd_test(code: ControllerCode) -> TestBlock:
    """The block that changes table 0, asks it, and compares the answers."""
    names, name = st_names(code), f"{test_name(code)}_ODD"
    rules = {each.rule.name: each.rule for each in code.odd}
    begun = [each for each in code.states if any(each.record.name in code.program(r).records for r in rules.values())]
    variables = [
        Variable(f"{st_name(rule.name)}Block", Declared(names.block(code.program(rule)))) for rule in rules.values()
    ]
    body: list[str] = []
    due: list[float] = []
    for state in begun:
        rule = code.beginning(state.record.name)
        variables += [Variable(f"{st_name(rule.name)}Block", Declared(names.block(code.program(rule)))),
                      Variable(st_name(state.record.name), Declared(names.types[state.record.name]))]  # fmt: skip
    for each in code.odd:
        program = code.program(each.rule)
        body += [changed(code.table, change, due) for change in each.changes]
        if not is_portable(np.array([*each.given.values(), each.wanted], np.float32)).all():
            continue
        given = []
        for taken in program.parameters:
            if taken.record is not None:
                given.append(f"{st_name(taken.name)} := #{st_name(taken.name)}")
                if taken.record.is_state:
                    begin = f"#{st_name(code.beginning(taken.name).name)}Block"
                    body.append(f"{begin}({st_name(taken.name)} := #{st_name(taken.name)});")
            elif taken.name in looked_at(program):
                number = each.given[taken.name]
                given.append(f"{st_name(taken.name)} := {handed_over(taken.kind or Kind.INT, number, due)}")
        block = f"#{st_name(each.rule.name)}Block"
        (answer,) = program.answers
        wanted = str(int(each.wanted))
        if answer.kind is Kind.REAL:  # a bare literal is LREAL for many compilers
            wanted = f"#Due[{len(due)}]"
            due.append(each.wanted)
        body += textwrap.wrap(f"{block}({', '.join(given)});", WIDTH, subsequent_indent="    ")
        body += [*check(f"{block}.{st_name(answer.name)} <> {wanted}")]
    constants = [real_array("Due", due)] if due else []
    note = "Table 0, changed into one in which every condition counts, then damaged."
    return TestBlock(test_block(name, note, table_type(code), variables, constants, body), 0)


def handed_over(kind: Kind, number: float, due: list[float]) -> str:
    """How a number is written that is handed over; a bare literal of REAL is LREAL for many compilers."""
    if kind is Kind.REAL:
        due.append(number)
        return f"#Due[{len(due) - 1}]"
    return str(int(number)) if kind is Kind.INT else "TRUE" if number else "FALSE"


def changed(record: SizedRecord, change: tuple[str, tuple[int, ...], float], due: list[float]) -> str:
    """The statement that changes a member; an array is one row of numbers."""
    member, place, number = change
    index = 0
    for length, at in zip(record.shape(member), place, strict=True):
        index = index * length + at
    value = handed_over(record.members[member].kind, number, due)
    return f"#Table.{st_name(member)}{f'[{index}]' if place else ''} := {value};"
