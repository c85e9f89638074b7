"""Questions to tables that no book has, in the self-test in C99."""

from __future__ import annotations

import numpy as np

from tuning_tables.controller_code.c_choice import table_type, tables_of
from tuning_tables.controller_code.c_code import c_names
from tuning_tables.controller_code.code import ControllerCode, OddQuestion
from tuning_tables.language.c99_data import hex_float
from tuning_tables.language.records import Kind


def odd_is_right(code: ControllerCode) -> str:
    """The function that changes a copy of table 0, asks it, and tells whether all answers are right."""
    states = {each.record.name: f"retarder_{code.records[each.record.name]}" for each in code.states}
    asked = {
        name: kind for name, kind in states.items() if any(name in code.program(each.rule).records for each in code.odd)
    }
    lines = [
        "/* A copy of table 0 is changed into one in which every condition counts, then damaged. */",
        "static int odd_is_right(void)",
        "{",
        f"    {table_type(code)} table = {tables_of(code)}[0];",
        *(f"    {kind} {name};" for name, kind in asked.items()),
        "    int right = 1;",
    ]
    for each in code.odd:
        lines += [f"    {changed(code, *change)}" for change in each.changes]
        lines += [f"    retarder_{code.beginning(name).name}(&{name});" for name in asked
                  if name in code.program(each.rule).records]  # fmt: skip
        lines.append(f"    right = right && {question(code, each)};")
    lines.append(f"    return right && {table_type(code)}_intact(&table) == 0;")
    return "\n".join([*lines, "}", ""])


def changed(code: ControllerCode, member: str, place: tuple[int, ...], number: float) -> str:
    """The statement that changes a member."""
    value = hex_float(number) if code.table.members[member].kind is Kind.REAL else str(int(number))
    return f"table.{member}{''.join(f'[{each}]' for each in place)} = {value};"


def question(code: ControllerCode, odd: OddQuestion) -> str:
    """The comparison of an answer."""
    program = code.program(odd.rule)
    given = []
    for taken in program.parameters:
        if taken.record is not None:
            given.append(f"&{taken.name}")
        else:
            number = odd.given[taken.name]
            given.append(real(number) if taken.kind is Kind.REAL else str(int(number)))
    call = f"{c_names(code).function(program)}({', '.join(given)})"
    if program.answers[0].kind is Kind.REAL:
        return f"bits_of({call}) == bits_of({real(odd.wanted)})"
    return f"{call} == {int(odd.wanted)}"


def real(number: float) -> str:
    """A number, by its bits where no constant tells it."""
    return hex_float(number) if np.isfinite(number) else f"float_of(0x{int(np.float32(number).view(np.uint32)):08x}u)"
