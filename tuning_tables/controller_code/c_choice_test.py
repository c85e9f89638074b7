"""Golden choices of a controller code in C99: each by its status and by the checksum of the chosen table."""

from __future__ import annotations

import numpy as np

from tuning_tables.controller_code.c_choice import select_of, table_type, tables_of
from tuning_tables.controller_code.code import Commanded, ControllerCode, crc32_of, words_of


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
