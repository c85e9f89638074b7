"""An export as objects of TwinCAT 3: a `.TcDUT` each structure, a `.TcPOU` each block, those of the self-test apart.

Declarations and statements are those of the `.st` files, each in a CDATA section of its own.
"""

from __future__ import annotations

import uuid
from collections.abc import Mapping
from typing import Final

from tuning_tables.language.st_data import st_comment
from tuning_tables.language.st_layout import block_head, declared, file_comment, statements
from tuning_tables.language.st_unit import Block, Export, Part, Structure, Unit

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
