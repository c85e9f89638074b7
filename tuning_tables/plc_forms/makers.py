"""An export in the forms of two makers: external sources in SCL, which the TIA Portal makes blocks of (S7-1200,
S7-1500), and objects of TwinCAT 3.

What SCL has otherwise than IEC 61131-3, all of it: names of types and blocks stand in quotes; names of variables of a
block begin with # in statements; `VERSION`, the attribute of optimised access and `BEGIN` are there; what is said of a
declaration stands behind //; types are written Int, Real, Bool, Array[0..9] of Int; and VAR CONSTANT takes no array, so
that an array of constants is a static variable with initial values, which no statement writes.

Of TwinCAT 3 there is a `.TcDUT` each structure, a `.TcPOU` each block, those of the self-test apart. Declarations and
statements are those of the `.st` files, each in a CDATA section of its own.
"""

from __future__ import annotations

import textwrap
import uuid
from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from typing import Final

from tuning_tables.language.records import Kind
from tuning_tables.language.st_data import WIDTH, st_comment
from tuning_tables.language.st_layout import (
    block_head,
    declared,
    file_comment,
    is_array,
    section,
    statements,
    with_values,
)
from tuning_tables.language.st_unit import ArrayOf, Block, Export, Part, Structure, Unit, Variable, VariableType

HEAD: Final = (
    "SCL for the TIA Portal, made from the Structured Text of the export: docs/how-to/plc.md states what differs.",
    "",
)
STATIC: Final = "Constants. VAR CONSTANT takes no arrays, so they are variables that nothing writes."


def scl_files(export: Export) -> Mapping[str, bytes]:
    """A file each part, ASCII with LF: the tables with their blocks, and the self-test."""
    return {f"{part.stem}.scl": part_text(part).encode("ascii") for part in export}


def part_text(part: Part) -> str:
    """A source: what it is, and its units."""
    return "\n".join([*(f"// {line}".rstrip() for line in (*HEAD, *part.head)), "", *map(unit_text, part.units)])


def unit_text(unit: Unit) -> str:
    """A unit."""
    if isinstance(unit, Structure):
        rows = [row for member in unit.members for row in scl_variable(member, 2)]
        head = [f'TYPE "{unit.name}"', "VERSION : 0.1", *line_comment(unit.note), "    STRUCT"]
        return "\n".join([*head, *rows, "    END_STRUCT;", "END_TYPE", ""])
    head = [f'FUNCTION_BLOCK "{unit.name}"', "{ S7_Optimized_Access := 'TRUE' }", "VERSION : 0.1"]
    sections = list(section_lines(unit))
    body = [f"    {line}" for line in unit.body]
    return "\n".join([*head, *line_comment(unit.note), *sections, "", "BEGIN", *body, "END_FUNCTION_BLOCK", ""])


def section_lines(block: Block) -> Iterator[str]:
    """The sections of a block."""
    layout = partial(scl_variable, depth=2)
    arrays = [each for each in block.constants if is_array(each)]
    constants = [each for each in block.constants if not is_array(each)]
    yield from section("    VAR_INPUT", block.inputs, layout, "    END_VAR")
    yield from section("    VAR_OUTPUT", block.outputs, layout, "    END_VAR")
    yield from section("    VAR_IN_OUT", block.in_outs, layout, "    END_VAR")
    yield from section("    VAR", block.own, layout, "    END_VAR")
    if arrays:
        yield from line_comment(STATIC, "    ")
    yield from section("    VAR", arrays, layout, "    END_VAR")
    yield from section("    VAR CONSTANT", constants, layout, "    END_VAR")


def scl_variable(variable: Variable, depth: int) -> Sequence[str]:
    """A declaration with what it means beside it, or above it where there is no room."""
    pad = " " * 4 * depth
    lines = with_values(f"{pad}{variable.name} : {type_text(variable.type)}", variable)
    beside = f"{lines[0]} // {variable.note}".rstrip()
    if not variable.note:
        return lines
    is_beside = not is_array(variable) and len(beside) <= WIDTH
    return [beside] if is_beside else [*line_comment(variable.note, pad), *lines]


def type_text(kind: VariableType) -> str:
    """A type by its name."""
    match kind:
        case Kind():
            return kind.st.capitalize()
        case ArrayOf(kind=element, length=length):
            return f"Array[0..{length - 1}] of {element.st.capitalize()}"
    return f'"{kind.name}"'


def line_comment(text: str, pad: str = "") -> list[str]:
    """The text as comments of a line each."""
    return [f"{pad}// {line}" for line in textwrap.wrap(text, WIDTH - 3 - len(pad))]


NAMESPACE: Final = uuid.UUID("6ba6f1a5-7a54-5d0f-8f0c-6d0f0d4a4a55")
"""Of the ids of all objects that are exported."""

TEST_FOLDER: Final = "self_test"

OBJECT: Final = """\
<?xml version="1.0" encoding="utf-8"?>
<TcPlcObject Version="1.1.0.1" ProductVersion="3.1.4024.12">
{content}
</TcPlcObject>
"""
POU: Final = """\
  <POU Name="{name}" Id="{{{id}}}" SpecialFunc="None">
    <Declaration>{declaration}</Declaration>
    <Implementation>
      <ST>{statements}</ST>
    </Implementation>
  </POU>"""
DUT: Final = """\
  <DUT Name="{name}" Id="{{{id}}}">
    <Declaration>{declaration}</Declaration>
  </DUT>"""


def twincat_files(export: Export) -> Mapping[str, bytes]:
    """A file each unit, ASCII with LF; the first one has the comment at the head of the tables."""
    return {
        f"{TEST_FOLDER}/{name}" if part.is_test else name: content
        for part in export
        for name, content in part_objects(part).items()
    }


def part_objects(part: Part) -> Mapping[str, bytes]:
    """The objects of a part; its head is the comment of the last one where it is a self-test, else of the first."""
    told = part.units[-1 if part.is_test else 0]
    files = {}
    for unit in part.units:
        head = f"{file_comment(part.head)}\n" if unit is told else ""
        ending = "TcDUT" if isinstance(unit, Structure) else "TcPOU"
        files[f"{unit.name}.{ending}"] = OBJECT.format(content=tc_object(unit, head)).encode("ascii")
    return files


def tc_object(unit: Unit, head: str) -> str:
    """The element of a unit."""
    if isinstance(unit, Structure):
        text = head + structure_declaration(unit)
        return DUT.format(name=unit.name, id=object_id(unit, text), declaration=cdata(text))
    text, body = f"{head}{block_head(unit)}\n", f"{statements(unit)}\n"
    return POU.format(name=unit.name, id=object_id(unit, text + body), declaration=cdata(text), statements=cdata(body))


def structure_declaration(structure: Structure) -> str:
    """A structure as TwinCAT writes it."""
    rows = [row for member in structure.members for row in declared(member)]
    note = st_comment(structure.note)
    return "\n".join([*note, f"TYPE {structure.name} :", "STRUCT", *rows, "END_STRUCT", "END_TYPE", ""])


def object_id(unit: Structure | Block, text: str) -> uuid.UUID:
    """The id of an object: the same for the same name and text."""
    return uuid.uuid5(NAMESPACE, f"{unit.name}\n{text}")


def cdata(text: str) -> str:
    """The text in a CDATA section."""
    parts = text.split("]]>")
    return f"<![CDATA[{']]]]><![CDATA[>'.join(parts)}]]>"
