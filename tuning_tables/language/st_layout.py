"""Units as IEC 61131-3 writes them: declarations, statements, comments; and an export as bare Structured Text, a
file each part or a file each unit.
"""

from __future__ import annotations

import textwrap
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Final, TypeAlias

from tuning_tables.language.records import Kind
from tuning_tables.language.st_data import WIDTH, st_comment
from tuning_tables.language.st_unit import (
    ArrayOf,
    Block,
    Export,
    Structure,
    Unit,
    Variable,
    VariableType,
    plain,
    units_of,
)

LINE_LENGTH: Final = 100
"""Of the values of an array."""


def unit_text(unit: Unit) -> str:
    """A unit as a text of its own."""
    if isinstance(unit, Structure):
        rows = [row for member in unit.members for row in declared(member, 2)]
        note = st_comment(unit.note, "    ")
        return "\n".join(["TYPE", *note, f"    {unit.name} : STRUCT", *rows, "    END_STRUCT;", "END_TYPE", ""])
    return "\n".join([block_head(unit), "", statements(unit), "END_FUNCTION_BLOCK", ""])


def block_head(block: Block) -> str:
    """What stands before the statements of a block."""
    sections = (
        ("VAR_INPUT", block.inputs),
        ("VAR_IN_OUT", block.in_outs),
        ("VAR_OUTPUT", block.outputs),
        ("VAR", block.own),
        ("VAR CONSTANT", block.constants),
    )
    rows = [line for word, variables in sections for line in section(word, variables, declared)]
    return "\n".join([f"FUNCTION_BLOCK {block.name}", *st_comment(block.note), *rows])


def section(
    begin: str, variables: Sequence[Variable], layout: Callable[[Variable], Sequence[str]], end: str = "END_VAR"
) -> Iterator[str]:
    """A section of declarations; nothing where there is none."""
    if variables:
        yield begin
        for each in variables:
            yield from layout(each)
        yield end


def statements(block: Block) -> str:
    """The statements of a block."""
    return "\n".join(map(plain, block.body))


def declared(variable: Variable, depth: int = 1) -> list[str]:
    """A declaration with what it means beside it, or above it where there is no room."""
    pad = " " * 4 * depth
    lines = with_values(f"{pad}{variable.name} : {type_text(variable.type)}", variable)
    if not variable.note:
        return lines
    beside = f"{lines[0]} (* {variable.note} *)"
    return [beside] if not is_array(variable) and len(beside) <= WIDTH else [*st_comment(variable.note, pad), *lines]


def is_array(variable: Variable) -> bool:
    """Whether a variable is an array that begins with values."""
    return isinstance(variable.type, ArrayOf) and bool(variable.values)


def with_values(head: str, variable: Variable) -> list[str]:
    """The declaration `head` with the initial value of the variable; an array in as many lines as it needs."""
    if is_array(variable):
        return array_lines(head, variable)
    return [f"{head} := {variable.values[0]};" if variable.values else f"{head};"]


def type_text(kind: VariableType) -> str:
    """A type by its name."""
    match kind:
        case Kind():
            return kind.st
        case ArrayOf(kind=element, length=length):
            return f"ARRAY[0..{length - 1}] OF {element.st}"
    return kind.name


def array_lines(head: str, variable: Variable) -> list[str]:
    """The declaration `head` with the values of an array, in as many lines as it needs."""
    values = variable.values
    whole = f"{head} := [{', '.join(values)}];"
    if len(whole) <= LINE_LENGTH:
        return [whole]
    row = variable.row or len(values)
    rows = [", ".join(values[start : start + row]) for start in range(0, len(values), row)]
    ends = [","] * (len(rows) - 1) + ["];"]
    wrapped = (textwrap.wrap(text + end, LINE_LENGTH, initial_indent=" " * 8, subsequent_indent=" " * 8)
               for text, end in zip(rows, ends, strict=True))  # fmt: skip
    return [f"{head} := [", *(line for lines in wrapped for line in lines)]


def file_comment(lines: Sequence[str]) -> str:
    """The comment at the beginning of a file, and the empty line behind it."""
    first, *others = lines
    return "\n".join([f"(* {first}", *(f"   {line}".rstrip() for line in others)]) + " *)\n"


Layout: TypeAlias = Callable[[Export], Mapping[str, bytes]]
"""A form of an export: its files, by name. Equal exports give equal bytes."""


def part_files(export: Export) -> Mapping[str, bytes]:
    """A file for the tables with their blocks, and one for the self-test, ASCII with LF."""
    return {
        f"{part.stem}.st": "\n".join([file_comment(part.head), *map(unit_text, part.units)]).encode("ascii")
        for part in export
    }


def unit_files(export: Export) -> Mapping[str, bytes]:
    """Each unit as a file; by their names in the order in which they need each other."""
    first, *others = units_of(export)
    texts = {first.name: "\n".join([file_comment(export[0].head), unit_text(first)])}
    texts |= {unit.name: unit_text(unit) for unit in others}
    return {f"{place:04d}_{name}.st": texts[name].encode("ascii") for place, name in enumerate(texts, start=1)}
