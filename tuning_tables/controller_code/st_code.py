"""A controller code as Structured Text: types, a block for each rule, the tables as constants, and the choice."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import partial
from typing import Any, Final

import numpy as np

from tuning_tables.category_number import comment_text
from tuning_tables.controller_code.code import ControllerCode
from tuning_tables.export_names import generated
from tuning_tables.language.records import Kind, Member, st_name
from tuning_tables.language.st_data import int_array, of_tables, pieces, place_of, real_array
from tuning_tables.language.st_unit import Block, Declared, Unit, Variable, local, retold, st_structure
from tuning_tables.language.structured_text import StNames, st_block

WIDTH: Final = 110

ARITHMETIC: Final = (
    "Arithmetic. Every operation on REAL stands in a statement of its own, so that its result is rounded to REAL "
    "(binary32) before the next. A controller that calculates in double precision and rounds when it assigns gives the "
    "same results: rounding + - * / of binary32 numbers to 53 bits first and to 24 afterwards never differs from "
    "rounding once, as 53 >= 2 * 24 + 2 (Figueroa 1995). Constants that are compared or calculated with stand in VAR "
    "CONSTANT as REAL, because many compilers hold a bare literal in double precision. Loops are WHILE loops, because "
    "compilers differ in a FOR of one pass, or of none.",
    "Which compilers have run it, and which have not, stands in docs/reference/structured-text.md. Run the self-test "
    "on the controller.",
)

SELECT_NOTE: Final = (
    "The table for a cut. Candidates are the tables of its category and number of axles; of several masses the "
    "largest. {between} the table of the next target below the command: the cut never leaves faster than commanded."
)
SELECT: Final = """\
#Chooser(Category := #Category, Axles := #Axles, Commanded_m_s := #Commanded_m_s);
#Status := #Chooser.Status;
#Table.Stages := 0;
IF #Status >= 0 THEN
    #Loader(TableNo := #Chooser.Slower, Table := #Table);
END_IF;
IF #Status = 1 THEN
{between}
END_IF;"""

BLENDED_NOTE: Final = "Between two targets: what lies between the two tables, where they are of one family. Otherwise"
BLENDED: Final = """\
    #Loader(TableNo := #Chooser.Faster, Table := #Faster);
    #Blender(Table := #Table, Faster := #Faster, Commanded_m_s := #Commanded_m_s);
    IF #Blender.IsBetween THEN
        #Table.Target_m_s := #Commanded_m_s;
    ELSE
        #Status := 2;
    END_IF;"""
SLOWER_NOTE: Final = "The command equal to a target: that table. Otherwise"
SLOWER: Final = """\
    #Status := 2;"""


def st_names(code: ControllerCode) -> StNames:
    """The names of the export."""
    prefix = f"RETARDER{code.ending.upper()}_"
    arrays = choice_arrays(code) if code.looks_at_all else ()
    return StNames(
        types={record: f"RETARDER_{name.upper()}" for record, name in code.records.items()},
        blocks={rule.function.__name__: f"RETARDER_{rule.name.upper()}" for rule in code.rules},
        prefix=prefix,
        arrays={"tables": arrays},
    )


def load_of(code: ControllerCode) -> str:
    """The block that fills a table."""
    return f"RETARDER_LOAD{code.ending.upper()}"


def select_block_of(code: ControllerCode) -> str:
    """The block that chooses a table."""
    return f"RETARDER_SELECT{code.ending.upper()}"


def table_type(code: ControllerCode) -> str:
    """The type of a table."""
    return st_names(code).types[code.declared[0].name]


def st_units(code: ControllerCode) -> list[Unit]:
    """Types and blocks, none before one that it needs."""
    names = st_names(code)
    programs = [st_block(program, names, code.sized) for program in code.programs]
    types = [st_structure(record, names.types[record.record.name]) for record in (code.table, *code.states)]
    choice = [select_block(code)] if code.chooses else []
    # Tables with lines alone have it, so that others fit into the same controller.
    categories = [categories_block(code)] if code.stem == "table" else []
    units: list[Unit] = [*types, *categories, load_block(code), *programs, *choice]
    return [retold(unit, partial(named, code)) for unit in units]


def select_block(code: ControllerCode) -> Block:
    """The block that chooses a table."""
    prefix, table = st_names(code).prefix, Declared(table_type(code))
    own = [Variable("Chooser", Declared(f"{prefix}CHOOSE")), Variable("Loader", Declared(load_of(code)))]
    if code.blends:
        blenders = {"Blender": f"{prefix}BLEND", "Faster": table.name}
        own += [Variable(name, Declared(kind)) for name, kind in blenders.items()]
    statuses = "0 tuned, 1 between two tables, 2 slower; no table: -1 no such class, -2 none slow enough"
    return Block(
        select_block_of(code),
        SELECT_NOTE.format(between=BLENDED_NOTE if code.blends else SLOWER_NOTE),
        tuple(SELECT.format(between=BLENDED if code.blends else SLOWER).split("\n")),
        inputs=(
            Variable("Category", Kind.INT, "number of the weight category"),
            Variable("Axles", Kind.INT),
            Variable("Commanded_m_s", Kind.REAL, "exit speed wanted, m/s"),
        ),
        in_outs=(Variable("Table", table, "filled; without a table its Stages become 0: nothing is commanded"),),
        outputs=(Variable("Status", Kind.INT, statuses),),
        own=tuple(own),
    )


def head(code: ControllerCode) -> tuple[str, ...]:
    """The lines of the comment at the beginning."""
    names = st_names(code)
    blocks = [f"{names.block(code.program(rule))}: {first_sentence(code.program(rule).note)}" for rule in code.rules]
    if code.chooses:
        told = "once for a cut, when its class and exit speed are known: fills a"
        blocks.insert(0, f"{select_block_of(code)}: {told} {table_type(code)}")
    categories = [f"{each.number:9d}  {each.macro}, {comment_text(each.category)}" for each in code.categories]
    categories[:0] = ["categories, whose numbers are the same in every export:"] if categories else []
    listed = [line for text in blocks for line in textwrap.wrap(text, WIDTH - 5, subsequent_indent="    ")]
    first = (
        f"{code.title} IEC 61131-3 Structured Text. {generated()} This text may be used, "
        "changed and passed on without any condition."
    )
    paragraphs = [
        textwrap.wrap(first, WIDTH - 5),
        [*code.told_origin, *categories],
        ["Blocks", *listed],
        *(textwrap.wrap(text, WIDTH - 5) for text in (*code.head, *ARITHMETIC)),
    ]
    return tuple(named(code, line) for paragraph in paragraphs for line in ("", *paragraph))[1:]


def named(code: ControllerCode, text: str) -> str:
    """The text with the names in backquotes as they are here: blocks of rules, and members."""
    blocks = {rule.function.__name__: f"RETARDER_{rule.name.upper()}" for rule in code.rules}
    blocks["select"] = select_block_of(code)
    return re.sub(r"`(\w+)`", lambda found: blocks.get(found[1]) or st_name(found[1]), text)


def first_sentence(note: str) -> str:
    """The first paragraph of a docstring."""
    return note.split("\n\n")[0].replace("\n", " ")


def categories_block(code: ControllerCode) -> Block:
    """RETARDER_CATEGORIES: an output for every category, with its number from the start on."""
    numbers = {f"Category_{each.macro}": each for each in code.categories}
    return Block(
        "RETARDER_CATEGORIES",
        "Names for the numbers of the weight categories, the same in every export. One instance does, and it need not "
        "be called.",
        tuple(f"{local(name)} := {each.number};" for name, each in numbers.items()),
        outputs=tuple(
            Variable(name, Kind.INT, comment_text(each.category), (f"{each.number}",)) for name, each in numbers.items()
        ),
    )


def choice_arrays(code: ControllerCode) -> tuple[Variable, ...]:
    """What the choice looks at of every table, as constant arrays."""
    looked_at = next(each for each in code.declared if each.name == "tables").members
    return tuple(scalar_array(code, name, member) for name, member in looked_at.items())


def scalar_array(code: ControllerCode, name: str, member: Member) -> Variable:
    """A number of every table as a constant array."""
    values = [table.values[name] for table in code.tables]
    return real_array(of_tables(name), values) if member.kind is Kind.REAL else int_array(of_tables(name), values)


def member_arrays(code: ControllerCode, name: str, place: int, values: Any) -> Iterator[Variable]:
    """An array of a table as constant arrays of one axis, a row of its last axis a line."""
    array = np.asarray(values)
    row = array.shape[-1] if array.ndim > 1 else 0
    for ending, start, count in pieces(array.size):
        stem = f"{st_name(name).partition('_')[0]}_{place}{ending}"
        yield member_array(stem, code.table.members[name], array.ravel()[start : start + count], row)


def member_array(name: str, member: Member, values: Any, row: int = 0) -> Variable:
    """Numbers of a member as a constant array."""
    return real_array(name, values, row) if member.kind is Kind.REAL else int_array(name, values)


def load_block(code: ControllerCode) -> Block:
    """The block that fills a table from constants: numbers by table; arrays once, however many tables share them."""
    members, empty = code.table.members, st_name(code.empty)
    numbers = {name: member for name, member in members.items() if not member.axes}
    declared = [scalar_array(code, name, member) for name, member in numbers.items()]
    body = [f"#Table.{st_name(name)} := #{of_tables(name)}[#TableNo];" for name in numbers]
    for part in dict.fromkeys(member.part for member in members.values() if member.axes):
        group = [name for name, member in members.items() if member.axes and member.part == part]
        more, cases = part_of_tables(code, part or "table", group)
        declared += more
        body += cases
    last = len(code.tables) - 1
    lines = [
        f"#Found := (#TableNo >= 0) AND (#TableNo <= {last});",
        f"#Table.{empty} := {'0' if members[code.empty].kind is Kind.INT else '0.0'};",
        "IF #Found THEN",
        *(f"    {line}" for line in body),
        "END_IF;",
    ]
    filled = f"filled; where there is no such table its {empty} becomes 0"
    return Block(
        load_of(code),
        "A table of the book as it stands.",
        tuple(lines),
        inputs=(Variable("TableNo", Kind.INT, f"0 to {last}"),),
        in_outs=(Variable("Table", Declared(table_type(code)), filled),),
        outputs=(Variable("Found", Kind.BOOL, "there is such a table"),),
        own=(Variable("Index", Kind.INT),),
        constants=tuple(declared),
    )


def part_of_tables(code: ControllerCode, part: str, group: Sequence[str]) -> tuple[list[Variable], list[str]]:
    """Declarations and statements for arrays that tables share or not: each content once, by its number."""
    found: dict[bytes, int] = {}
    number_of: list[int] = []
    declared: list[Variable] = []
    cases: list[str] = []
    for table in code.tables:
        content = b"".join(np.ascontiguousarray(table.values[name]).tobytes() for name in group)
        if content not in found:
            place = found[content] = len(found)
            first, *others = (array for name in group for array in member_arrays(code, name, place, table.values[name]))
            declared += [replace(first, note=f"{place}: {comment_text(table.id)}"), *others]
            cases += [f"{place}:", *(f"    {line}" for line in copied(code, group, place))]
        number_of.append(found[content])
    name = f"{part.capitalize()}Part"
    return [int_array(name, number_of), *declared], [
        f"CASE #{name}[#TableNo] OF",
        *(f"    {line}" for line in cases),
        "END_CASE;",
    ]


def copied(code: ControllerCode, group: Sequence[str], place: int) -> Iterator[str]:
    """Loops that copy the arrays of a group, those of one length together."""
    loops: dict[tuple[int, int], list[str]] = {}
    for name in group:
        stem = f"{st_name(name).partition('_')[0]}_{place}"
        for ending, start, count in pieces(code.table.length(name)):
            statement = f"    #Table.{st_name(name)}[{place_of(start)}] := #{stem}{ending}[#Index];"
            loops.setdefault((start, count), []).append(statement)
    for (_, count), statements in loops.items():
        yield from (
            "#Index := 0;",
            f"WHILE #Index < {count} DO",
            *statements,
            "    #Index := #Index + 1;",
            "END_WHILE;",
        )
