"""The self-test of a controller code in C99: checksums, golden questions, golden choices, and what is no table."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Final

import numpy as np

from tuning_tables.controller_code.c_choice import select_of, table_type, tables_of
from tuning_tables.controller_code.c_code import (
    FOOT,
    GUARD,
    c_names,
    crc32_name,
    part,
    same_export,
)
from tuning_tables.controller_code.c_test_parts import choosing, golden_choices, odd_is_right
from tuning_tables.controller_code.code import BEFORE, ControllerCode, Questions, Rule, kinds_of
from tuning_tables.export_names import generated
from tuning_tables.language.c99 import wrapped
from tuning_tables.language.c99_data import c_comment
from tuning_tables.language.records import Kind
from tuning_tables.language.tree import Program

FIRST_ANSWER: Final = 4
"""The fault of the first kind of questions; before it: sound, the arithmetic of the checksum, a table, a choice."""


def test_stem(code: ControllerCode) -> str:
    """The stem of the self-test's names: retarder_self_test for tables with lines."""
    return f"{code.ending}_self_test".lstrip("_")


def c_test_header(code: ControllerCode) -> str:
    """The text of retarder_..._self_test.h."""
    stem = test_stem(code)
    macro = f"RETARDER_{stem.upper()}"
    asked = ", ".join(
        [*(f"{len(each.rows)} golden {each.about}" for each in code.questions),
         *([f"{len(code.commands)} golden choices"] if code.commands else [])]
    )  # fmt: skip
    faults = [
        ("SOUND", 0, ""),
        ("BAD_CRC", 1, 'the checksum of "123456789" is wrong'),
        ("BAD_TABLE", 2, "a table is not as exported"),
        *([("BAD_CHOICES", 3, "a golden choice is another")] if code.commands else []),
        *((f"BAD_{each.about.upper()}", FIRST_ANSWER + place, f"one of the golden {each.about} is another")
          for place, each in enumerate(code.questions)),
        ("BAD_NOTHING", FIRST_ANSWER + len(code.questions), "a function without a record answers otherwise"),
        *([("BAD_ODD", FIRST_ANSWER + len(code.questions) + 1, "a changed table answers otherwise")]
          if code.odd else []),
    ]  # fmt: skip
    return "\n".join(
        [
            *c_comment(
                f"Self-test of retarder_{code.stem}.c. {generated()} Proves on the processor at hand, with the "
                "compiler and switches at hand, that tables and rules are as exported: arithmetic of the checksum, "
                f"checksums of all tables, {asked}."
            ),
            GUARD.format(macro=f"{macro}_H").replace("#include <stdint.h>", f'#include "retarder_{code.stem}.h"'),
            *(
                f"#define {macro_prefix(code)}{name} ({number})" + f" /* {note} */" * bool(note)
                for name, number, note in faults
            ),
            "",
            "/* The first fault found; `*where`, unless null, becomes the number of the table, choice or question. */",
            f"int32_t retarder_{stem}(uint32_t *where);",
            "",
            FOOT,
        ]
    )


def macro_prefix(code: ControllerCode) -> str:
    """How the names of faults begin."""
    return f"RETARDER{code.ending.upper()}_"


def c_test_source(code: ControllerCode) -> str:
    """The text of retarder_..._self_test.c."""
    stem = test_stem(code)
    checks = [line for place, each in enumerate(code.questions) for line in asking(code, place, each)]
    return "\n".join(
        [
            *c_comment(f"Self-test of retarder_{code.stem}.c. {generated()} See retarder_{stem}.h."),
            f'#include "retarder_{stem}.h"',
            "",
            *same_export(code),
            part("float_bits.c"),
            *(row_type(code, place, each) for place, each in enumerate(code.questions)),
            *(golden_choices(code) if code.commands else []),
            part("found.c"),
            *(is_right(code, place, each) for place, each in enumerate(code.questions)),
            nothing_is_safe(code),
            *([odd_is_right(code)] if code.odd else []),
            f"int32_t retarder_{stem}(uint32_t *where)",
            "{",
            f"    static const unsigned char digits[9] = {{{', '.join(f'0x3{digit}u' for digit in range(1, 10))}}};",
            "    uint32_t number;",
            *(f"    retarder_{code.records[each.record.name]} {each.record.name} = {{{filling(each.record.members)}}};"
              for each in code.states),
            f"    if ({crc32_name(code)}(digits, 9u) != 0xCBF43926u) {{",
            f"        return found({macro_prefix(code)}BAD_CRC, 0u, where);",
            "    }",
            f"    for (number = 0u; number < {len(code.tables)}u; ++number) {{",
            f"        if ({table_type(code)}_intact(&{tables_of(code)}[number]) != 1) {{",
            f"            return found({macro_prefix(code)}BAD_TABLE, number, where);",
            "        }",
            "    }",
            *(choosing(code) if code.commands else []),
            *checks,
            "    if (nothing_is_safe() != 1) {",
            f"        return found({macro_prefix(code)}BAD_NOTHING, 0u, where);",
            "    }",
            *(["    if (odd_is_right() != 1) {",
               f"        return found({macro_prefix(code)}BAD_ODD, 0u, where);",
               "    }"] if code.odd else []),
            f"    return found({macro_prefix(code)}SOUND, 0u, where);",
            "}",
            "",
        ]
    )  # fmt: skip


def filling(members: Mapping[str, object]) -> str:
    """Numbers for a state that has not begun: what it forgets must be something."""
    return ", ".join(f"{place}.0f" for place in range(1, len(members) + 1))


def row_type(code: ControllerCode, place: int, questions: Questions) -> str:
    """The type of a question with its answers, and all of them; a REAL is its bits, as not every one has a literal."""
    kinds = kinds_of(code, questions)
    rows = [f"    {'uint32_t' if kind is Kind.REAL else 'int32_t'} {name};" for name, kind in kinds.items()]
    columns = [
        [f"0x{word:08x}u" for word in np.ascontiguousarray(questions.rows[name]).view(np.uint32)]
        if kind is Kind.REAL
        else [str(int(value)) for value in questions.rows[name]]
        for name, kind in kinds.items()
    ]
    lines = [f"    {{{', '.join(row)}}}" for row in zip(*columns, strict=True)]
    head = f"typedef struct golden_{place} {{\n" + "\n".join(rows) + f"\n}} golden_{place};\n"
    array = f"static const golden_{place} golden_{questions.about}[{len(lines)}] = {{"
    return "\n".join([f"/* Golden {questions.about}. */", head, array, ",\n".join(lines), "};", ""])


def is_right(code: ControllerCode, place: int, questions: Questions) -> str:
    """The function that asks one question and compares its answers."""
    kinds = kinds_of(code, questions)
    programs = [code.program(rule) for rule in questions.rules]
    states = [each for each in code.states if any(each.record.name in program.records for program in programs)]
    shared = "".join(f", retarder_{code.records[each.record.name]} *{each.record.name}" for each in states)
    lines, tests = [], []
    if any(code.declared[0].name in (each.name for each in program.records.values()) for program in programs):
        number = "golden->table" if "table" in kinds else "0"
        lines.append(f"    const {table_type(code)} *table = &{tables_of(code)}[{number}];")
    for each in states:
        state = each.record.name
        lines += [f"    {state}->{name} = float_of(golden->{BEFORE}{name});" for name in questions.members_before]
        if "begins" in kinds:
            begin = f"retarder_{code.beginning(state).name}({state});"
            lines += ["    if (golden->begins == 1) {", f"        {begin}", "    }"]
    for program in programs:
        call = call_of(code, program, kinds)
        if not program.answers:
            lines.append(wrapped(f"{call};", 1))
            continue
        (answer,) = program.answers
        tests.append(
            f"bits_of({call}) == golden->{answer.name}"
            if answer.kind is Kind.REAL
            else f"{call} == golden->{answer.name}"
        )
    told = {answer.name for program in programs for answer in program.answers}
    tests += [
        f"bits_of({state.record.name}->{name}) == golden->{name}"
        for state in states
        for name in questions.expected
        if name not in told
    ]
    joined = " && ".join(tests)
    return "\n".join(
        [
            f"static int is_right_{place}(const golden_{place} *golden{shared})",
            "{",
            *lines,
            wrapped(f"return {joined};", 1),
            "}",
            "",
        ]
    )


def call_of(code: ControllerCode, program: Program, kinds: Mapping[str, Kind]) -> str:
    """The call of a program with the numbers of a question."""
    names, given = c_names(code), []
    for taken in program.parameters:
        if taken.name in names.arrays:
            continue
        if taken.record is not None:
            given.append("table" if not taken.record.is_state else taken.name)
        elif taken.name not in kinds:
            given.append("0.0f" if taken.kind is Kind.REAL else "0")
        else:
            given.append(f"float_of(golden->{taken.name})" if taken.kind is Kind.REAL else f"golden->{taken.name}")
    return f"{names.function(program)}({', '.join(given)})"


def asking(code: ControllerCode, place: int, questions: Questions) -> Iterator[str]:
    """The loop over questions of one kind."""
    programs = [code.program(rule) for rule in questions.rules]
    states = [
        each.record.name for each in code.states if any(each.record.name in program.records for program in programs)
    ]
    given = "".join(f", &{name}" for name in states)
    yield f"    for (number = 0u; number < {len(questions.rows)}u; ++number) {{"
    yield f"        if (is_right_{place}(&golden_{questions.about}[number]{given}) == 0) {{"
    yield f"            return found({macro_prefix(code)}BAD_{questions.about.upper()}, number, where);"
    yield "        }"
    yield "    }"


def nothing_is_safe(code: ControllerCode) -> str:
    """The function that asks every rule without one of its records, and the choice and checksum without a table."""
    tests = [test for rule in code.rules for test in without_records(code, rule)]
    tests += [f"{table_type(code)}_intact(0) == 0", f"{table_type(code)}_intact(&changed) == 0"]
    if code.chooses:
        tests.append(f"{select_of(code)}(0, 0, 1.0f, 0) < 0")
    states = [f"    retarder_{code.records[each.record.name]} {each.record.name} = {{{filling(each.record.members)}}};"
              for each in code.states]  # fmt: skip
    joined = "\n        && ".join(tests)
    table = f"    const {table_type(code)} *const table = &{tables_of(code)}[0];"
    asked = [
        f"    {call};" for rule in code.rules if not code.program(rule).answers for call in without_each(code, rule)
    ]
    uses = [table] if "(table" in joined + "".join(asked) else []
    changed = [f"    {table_type(code)} changed = {tables_of(code)}[0];", *states, "    changed.crc32 ^= 1u;"]
    return "\n".join(
        ["static int nothing_is_safe(void)", "{", *uses, *changed, *asked, f"    return {joined};", "}", ""]
    )


def without_records(code: ControllerCode, rule: Rule) -> Iterator[str]:
    """What a rule must answer where one of its records is missing."""
    program = code.program(rule)
    if not program.answers:
        yield from kept_without(code, rule)
    if not rule.without:
        return
    safe = numbers_of(program).get(rule.without, rule.without)
    is_real = program.answers[0].kind is Kind.REAL
    for call in without_each(code, rule):
        yield f"bits_of({call}) == bits_of({safe})" if is_real else f"{call} == {safe}"


def kept_without(code: ControllerCode, rule: Rule) -> Iterator[str]:
    """Of a rule that changes a state and needs another record: the state is as it was filled."""
    program = code.program(rule)
    for state in (each.record for each in code.states if each.record.name in program.records):
        for place, name in enumerate(state.members, start=1) if len(program.records) > 1 else ():
            yield f"bits_of({state.name}.{name}) == bits_of({place}.0f)"


def without_each(code: ControllerCode, rule: Rule) -> Iterator[str]:
    """The calls of a rule without one of its records."""
    program, value = code.program(rule), numbers_of(code.program(rule))
    for missing in program.records:
        given = [
            value.get(each.name)
            or ("0" if each.name == missing else f"&{each.name}" if each.record and each.record.is_state else "table")
            for each in program.parameters
        ]
        yield f"retarder_{rule.name}({', '.join(given)})"


def numbers_of(program: Program) -> Mapping[str, str]:
    """The numbers that a rule is given where a record is missing: 1 each."""
    kinds = {each.name: each.kind for each in program.parameters if each.record is None}
    return {name: "1.0f" if kind is Kind.REAL else "1" for name, kind in kinds.items()}
