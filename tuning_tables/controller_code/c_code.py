"""A controller code as C99: header and source. Freestanding, no heap, no library call, no state but the caller's.
What no rule of Python gives are the files `c99/*.in`.
"""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterator
from importlib.resources import files
from typing import Final

from tuning_tables.category_number import comment_text
from tuning_tables.controller_code.c_choice import STATUSES, select, select_note, select_of, table_type, tables_of
from tuning_tables.controller_code.code import ControllerCode, HeldTable, Rule, crc32_of, words_of
from tuning_tables.export_names import generated
from tuning_tables.language.c99 import CNames, c_function, c_prototype
from tuning_tables.language.c99_data import c_comment, c_constants, c_content, c_type
from tuning_tables.language.tree import Program
from tuning_tables.language.walking import constants_of


def part(name: str) -> str:
    """The text of the file `name` as it stands."""
    return (files("tuning_tables") / "c99" / f"{name}.in").read_text("ascii")


WIDTH: Final = 116

GUARD: Final = """\
#ifndef {macro}
#define {macro}

#include <stdint.h>

#ifdef __cplusplus
extern "C" {{
#endif
"""
FOOT: Final = """\
#ifdef __cplusplus
}
#endif

#endif
"""

HELPERS: Final = {
    "larger(": """\
/* A NaN as first argument stays: so does the reference. */
static float larger(float value, float least)
{
    return least > value ? least : value;
}
""",
    "smaller(": """\
static float smaller(float value, float most)
{
    return most < value ? most : value;
}
""",
    "is_equal(": """\
static int is_equal(float one, float other)
{
    return one >= other && one <= other;
}
""",
}
"""What some programs use of the language, by how it begins where it is used."""

CATEGORIES_NOTE = (
    "/* Weight categories: their numbers are the same in every export, and so they may be kept elsewhere. */"
)


def c_names(code: ControllerCode) -> CNames:
    """The names of the export."""
    return CNames(
        types={record: f"retarder_{name}" for record, name in code.records.items()},
        functions={rule.function.__name__: f"retarder_{rule.name}" for rule in code.rules},
        without={rule.function.__name__: rule.without for rule in code.rules},
        arrays={"tables": tables_of(code)} if code.looks_at_all else {},
    )


def named(code: ControllerCode, text: str) -> str:
    """The text with the names in backquotes as they are here: functions of rules, and members."""
    functions = {rule.function.__name__: f"retarder_{rule.name}" for rule in code.rules}
    functions["select"] = select_of(code)
    return re.sub(r"`(\w+)`", lambda found: functions.get(found[1]) or found[1], text)


def c_header(code: ControllerCode) -> str:
    """The text of retarder_STEM.h."""
    names, macro = c_names(code), f"RETARDER_{code.stem.upper()}_H"
    text = "\n".join(
        [
            *head_comment(code),
            GUARD.format(macro=macro),
            *(STATUSES.split("\n") if code.chooses else []),
            *(f"#define RETARDER_{name} ({value}) /* {meaning} */" for name, value, meaning in code.named),
            *([""] if code.named else []),
            *([CATEGORIES_NOTE] if code.categories else []),
            *(f"#define RETARDER_CATEGORY_{each.macro} {each.number} /* {comment_text(each.category)} */"
              for each in code.categories),
            "",
            "/* Of all files of one export, so that they cannot be mixed. */",
            f"#define {tag_name(code)} 0x{code.tag:08x}u",
            "",
            *record_types(code),
            f"extern const int32_t {table_type(code)}_count;",
            f"extern const {table_type(code)} {tables_of(code)}[];",
            "",
            *(line for rule in code.rules for line in declared(code, rule, names)),
            *([*c_comment(select_note(code)),
               f"int32_t {select_of(code)}(int32_t category, int32_t axles, float commanded_m_s, "
               f"{table_type(code)} *chosen);", ""] if code.chooses else []),
            "/* 1 if the checksum of the table is right, in ROM or of a copy, else 0. */",
            f"int32_t {table_type(code)}_intact(const {table_type(code)} *table);",
            "",
            '/* CRC-32 (ISO 3309; zlib, Ethernet) of `count` bytes; the bytes "123456789" give 0xCBF43926. */',
            f"uint32_t {crc32_name(code)}(const unsigned char *bytes, uint32_t count);",
            "",
            FOOT,
        ]
    )  # fmt: skip
    return named(code, text)


def crc32_name(code: ControllerCode) -> str:
    """The name of the checksum."""
    return f"retarder{code.ending}_crc32"


def tag_name(code: ControllerCode) -> str:
    """The macro that tells one export from another."""
    return f"RETARDER_{code.stem.upper()}_EXPORT"


def head_comment(code: ControllerCode) -> list[str]:
    """The comment at the head of the header."""
    first = f"{code.title} {generated()} This text may be used, changed and passed on without any condition."
    paragraphs = [first, None, *code.head]
    lines: list[str] = []
    for paragraph in paragraphs:
        rows = list(code.told_origin) if paragraph is None else textwrap.wrap(paragraph, WIDTH - 3)
        lines += [*([""] if lines else []), *rows]
    return [f"/* {lines[0]}", *(f" * {line}".rstrip() for line in lines[1:]), " */"]


def record_types(code: ControllerCode) -> Iterator[str]:
    """The types of the table and of the states."""
    for record in (code.table, *code.states):
        yield from c_comment(f"{record.record.meaning} Every member is 32 bits wide.")
        text = c_type(record, f"retarder_{code.records[record.record.name]}")
        if record is code.table:
            checksum = (
                "    uint32_t crc32; /* CRC-32 of all words before it, each from its lowest byte to its highest */\n}"
            )
            text = text.replace("\n}", f"\n{checksum}")
        yield text


def declared(code: ControllerCode, rule: Rule, names: CNames) -> Iterator[str]:
    """A function of the header, with its docstring and what its parameters mean."""
    program = code.program(rule)
    yield from note_lines(program, rule.without)
    yield f"{c_prototype(program, names)};"
    yield ""


def note_lines(program: Program, without: str) -> Iterator[str]:
    """The docstring as a comment, a paragraph after the other, then the parameters."""
    lines: list[str] = []
    for paragraph in program.note.split("\n\n"):
        lines += [*([""] if lines else []), *textwrap.wrap(paragraph.replace("\n", " "), WIDTH - 3)]
    taken = [each for each in program.parameters if each.record is None]
    if taken:
        width = max(len(each.name) for each in taken)
        lines += ["", *(f"{each.name:{width}}  {each.meaning}" for each in taken)]
    if without:
        lines += ["", f"Without a record (a null pointer): {without}."]
    rows = [f"/* {lines[0]}", *(f" * {line}".rstrip() for line in lines[1:])]
    yield from [*rows[:-1], f"{rows[-1]} */"]


def c_source(code: ControllerCode) -> str:
    """The text of retarder_STEM.c."""
    names = c_names(code)
    functions = [c_function(program, names) for program in code.programs]
    text = named(code, "\n".join(functions))
    words = code.table.words() + 1
    return "\n".join(
        [
            *c_comment(f"{code.title} {generated()} See retarder_{code.stem}.h."),
            f'#include "retarder_{code.stem}.h"',
            "",
            "#include <float.h>",
            "",
            *same_export(code),
            part("binary32.c"),
            "#define CRC_START 0xFFFFFFFFu",
            f"#define TABLE_WORDS {words}u",
            f"typedef char {table_type(code)}_has_no_gaps[(sizeof({table_type(code)}) == 4u * TABLE_WORDS) ? 1 : -1];",
            "",
            c_constants(constants_of(code.programs)),
            "",
            f"const int32_t {table_type(code)}_count = {len(code.tables)};",
            "",
            f"const {table_type(code)} {tables_of(code)}[] = {{",
            ",\n".join(initialiser(code, number, table) for number, table in enumerate(code.tables)),
            "};",
            "",
            part("rounded.c"),
            *(helper for begin, helper in HELPERS.items() if begin in text),
            part("crc32.c").replace("retarder_table", table_type(code)).replace("retarder_crc32", crc32_name(code)),
            text,
            *([select(code)] if code.chooses else []),
            f"int32_t {table_type(code)}_intact(const {table_type(code)} *table)",
            "{",
            "    return table != 0 && table_crc32(table) == table->crc32;",
            "}",
            "",
        ]
    )  # fmt: skip


def same_export(code: ControllerCode) -> list[str]:
    """What refuses a header of another export."""
    return [
        f"#if {tag_name(code)} != 0x{code.tag:08x}u",
        f'#error "retarder_{code.stem}.h is of another export: take all files from one"',
        "#endif",
        "",
    ]


def initialiser(code: ControllerCode, number: int, table: HeldTable) -> str:
    """A table of the array."""
    rows = c_content(code.table, table.values)
    crc32 = crc32_of(words_of(code.table, table.values))
    lines = [*rows, f"0x{crc32:08x}u /* crc32 */"]
    return "\n".join(
        [f"    /* {number}: {comment_text(table.id)} */", "    {", *(f"        {line}" for line in lines), "    }"]
    )
