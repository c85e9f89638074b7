"""Questions to tables that no book has, in the self-test in Structured Text."""

from __future__ import annotations

import textwrap

import numpy as np

from tuning_tables.controller_code.code import ControllerCode
from tuning_tables.controller_code.st_code import WIDTH, st_names, table_type
from tuning_tables.controller_code.st_test_block import TestBlock, check, test_block, test_name
from tuning_tables.language.records import Kind, SizedRecord, st_name
from tuning_tables.language.st_unit import Declared, Variable
from tuning_tables.language.walking import looked_at
from tuning_tables.st_literals import is_portable, real_array


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
