"""Golden choices of a controller code in Structured Text: by status and target, and some by every number."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from tuning_tables.controller_code.code import Commanded, ControllerCode
from tuning_tables.controller_code.st_code import select_block_of, table_type
from tuning_tables.controller_code.st_test_block import (
    TestBlock,
    check,
    compared,
    loop,
    short_name,
    test_block,
    test_name,
)
from tuning_tables.language.records import Kind
from tuning_tables.language.st_unit import Block, Declared, Variable
from tuning_tables.st_literals import LONGEST_ARRAY, int_array, is_portable, real_array


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
