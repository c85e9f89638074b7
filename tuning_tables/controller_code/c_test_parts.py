"""Parts of the self-test in C99: golden choices, each by its status and by the checksum of the chosen table, and
questions to tables that no book has.
"""

from __future__ import annotations

import numpy as np

from tuning_tables.controller_code.c_choice import select_of, table_type, tables_of
from tuning_tables.controller_code.c_code import c_names
from tuning_tables.controller_code.code import Commanded, ControllerCode, OddQuestion, crc32_of, words_of
from tuning_tables.language.c99_data import hex_float
from tuning_tables.language.records import Kind


def golden_choices(code: ControllerCode) -> list[str]:
    """The choices, and the function that compares one: its status, and the checksum of the chosen table."""
    rows = [choice_row(code, each) for each in code.commands]
    return [
        "/* A choice: how it ends, and the checksum of the chosen table (0: none). */",
        "typedef struct golden_choice {",
        "    int32_t category;",
        "    int32_t axles;",
        "    uint32_t commanded_m_s;",
        "    int32_t status;",
        "    uint32_t crc32;",
        "} golden_choice;",
        "",
        f"static const golden_choice golden_choices[{len(rows)}] = {{",
        ",\n".join(rows),
        "};",
        "",
        "static int is_chosen_right(const golden_choice *golden)",
        "{",
        f"    {table_type(code)} chosen = {tables_of(code)}[0];",
        "    const float commanded_m_s = float_of(golden->commanded_m_s);",
        f"    const int32_t status = {select_of(code)}(golden->category, golden->axles, commanded_m_s, &chosen);",
        "    if (status != golden->status) {",
        "        return 0;",
        "    }",
        "    if (status < 0) {",
        "        return chosen.stages == 0;",
        "    }",
        f"    return chosen.crc32 == golden->crc32 && {table_type(code)}_intact(&chosen) == 1;",
        "}",
        "",
    ]


def choice_row(code: ControllerCode, commanded: Commanded) -> str:
    """A golden choice as initialiser."""
    bits = int(commanded.commanded_m_s.view(np.uint32))
    crc32 = 0 if commanded.chosen is None else crc32_of(words_of(code.table, commanded.chosen))
    return f"    {{{commanded.category}, {commanded.axles}, 0x{bits:08x}u, {commanded.status}, 0x{crc32:08x}u}}"


def choosing(code: ControllerCode) -> list[str]:
    """The loop over choices."""
    return [
        f"    for (number = 0u; number < {len(code.commands)}u; ++number) {{",
        "        if (is_chosen_right(&golden_choices[number]) == 0) {",
        f"            return found(RETARDER{code.ending.upper()}_BAD_CHOICES, number, where);",
        "        }",
        "    }",
    ]


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
