"""An export as one XML file of PLCopen (TC6 XML, version 2.01), which CODESYS, Beremiz, OpenPLC and others import.

Structures are data types, blocks are POUs; notes are documentation. Nothing else is in it: no program, no task.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Final
from xml.sax.saxutils import escape, quoteattr

from tuning_tables.export_names import EXPORTER, exporting_version
from tuning_tables.language.records import Kind
from tuning_tables.language.st_layout import statements
from tuning_tables.language.st_unit import ArrayOf, Block, Export, Structure, Variable, VariableType, units_of

NAMESPACE: Final = "http://www.plcopen.org/xml/tc6_0201"
XHTML: Final = "http://www.w3.org/1999/xhtml"
NO_DAY: Final = "1970-01-01T00:00:00"
"""The schema wants a day. Equal exports give equal bytes, so it is always this."""

SCALES: Final = tuple(f'            <{each}><scaling x="1" y="1"/></{each}>' for each in ("fbd", "ld", "sfc"))


def plcopen_files(export: Export) -> Mapping[str, bytes]:
    """One file for all parts, ASCII with LF."""
    stem = export[0].stem
    lines = [
        '<?xml version="1.0" encoding="utf-8"?>',
        f"<project xmlns={quoteattr(NAMESPACE)} xmlns:xhtml={quoteattr(XHTML)}>",
        f'    <fileHeader companyName="{EXPORTER}" productName="{EXPORTER}" productVersion="{exporting_version()}"'
        f' creationDateTime="{NO_DAY}"/>',
        f"    <contentHeader name={quoteattr(stem)}>",
        f"        <Comment>{escape(comment(export))}</Comment>",
        "        <coordinateInfo>",
        *SCALES,
        "        </coordinateInfo>",
        "    </contentHeader>",
        "    <types>",
        "        <dataTypes>",
        *(line for unit in units_of(export) if isinstance(unit, Structure) for line in data_type(unit)),
        "        </dataTypes>",
        "        <pous>",
        *(line for unit in units_of(export) if isinstance(unit, Block) for line in pou(unit)),
        "        </pous>",
        "    </types>",
        "    <instances><configurations/></instances>",
        "</project>",
        "",
    ]
    return {f"{stem}.xml": "\n".join(lines).encode("ascii")}


def comment(export: Export) -> str:
    """What stands at the head of each part."""
    return "\n\n".join("\n".join(part.head) for part in export)


def data_type(structure: Structure) -> Iterator[str]:
    """A structure."""
    yield f'            <dataType name="{structure.name}">'
    yield "                <baseType>"
    yield "                    <struct>"
    for member in structure.members:
        yield from variable_lines(member, 24)
    yield "                    </struct>"
    yield "                </baseType>"
    yield from documentation(structure.note, 16)
    yield "            </dataType>"


def pou(block: Block) -> Iterator[str]:
    """A function block."""
    sections = (
        ("inputVars", "inputVars", block.inputs),
        ("inOutVars", "inOutVars", block.in_outs),
        ("outputVars", "outputVars", block.outputs),
        ("localVars", "localVars", block.own),
        ('localVars constant="true"', "localVars", block.constants),
    )
    yield f'            <pou name="{block.name}" pouType="functionBlock">'
    yield "                <interface>"
    for begin, end, variables in sections:
        if variables:
            yield f"                    <{begin}>"
            for each in variables:
                yield from variable_lines(each, 24)
            yield f"                    </{end}>"
    yield "                </interface>"
    yield "                <body>"
    yield f"                    <ST><xhtml:p>{escape(statements(block))}</xhtml:p></ST>"
    yield "                </body>"
    yield from documentation(block.note, 16)
    yield "            </pou>"


def variable_lines(variable: Variable, depth: int) -> Iterator[str]:
    """A variable of a section, or a member of a structure."""
    pad = " " * depth
    yield f'{pad}<variable name="{variable.name}">'
    yield f"{pad}    <type>{type_element(variable.type)}</type>"
    if variable.values:
        values = [f"<simpleValue value={quoteattr(each)}/>" for each in variable.values]
        if isinstance(variable.type, ArrayOf):
            yield f"{pad}    <initialValue><arrayValue>"
            yield from (f"<value>{each}</value>" for each in values)  # thousands: an indentation would double the file
            yield f"{pad}    </arrayValue></initialValue>"
        else:
            yield f"{pad}    <initialValue>{values[0]}</initialValue>"
    yield from documentation(variable.note, depth + 4)
    yield f"{pad}</variable>"


def type_element(kind: VariableType) -> str:
    """A type."""
    match kind:
        case Kind():
            return f"<{kind.st}/>"
        case ArrayOf(kind=element, length=length):
            bounds = f'<dimension lower="0" upper="{length - 1}"/>'
            return f"<array>{bounds}<baseType><{element.st}/></baseType></array>"
    return f'<derived name="{kind.name}"/>'


def documentation(note: str, depth: int) -> Iterator[str]:
    """What a thing means."""
    if note:
        yield f"{' ' * depth}<documentation><xhtml:p>{escape(note)}</xhtml:p></documentation>"
