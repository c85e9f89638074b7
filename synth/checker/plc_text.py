"""Code for PLCs in any of its forms, read as plain Structured Text: its types, its constants, its statements.

What the checker looks at is the same in each: members of a structure, arrays of constants, comments that name tables.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Final
from xml.etree import ElementTree

from synth.checker.content import text_of
from synth.checker.finding import DamagedError

PLCOPEN: Final = "{http://www.plcopen.org/xml/tc6_0201}"
XHTML: Final = "{http://www.w3.org/1999/xhtml}"
LAST_LINES: Final = ("END_FUNCTION_BLOCK\n", "END_TYPE\n")
SCL_COMMENTS: Final = re.compile(r"^( *)//(.*(?:\n\1//.*)*)", re.MULTILINE)
"""Whole lines of comment, one under the other."""
SCL_REMARK: Final = re.compile(r"//(.*)$", re.MULTILINE)
SCL_TYPE: Final = re.compile(r'^TYPE "(\w+)"\nVERSION : [\d.]+$', re.MULTILINE)
SCL_ARRAY: Final = re.compile(r"\bArray\[(.*?)\] of\b")
SCL_NAME: Final = re.compile(r'"(\w+)"')


def structured_text(file: Path) -> str:
    """The Structured Text in a file, whatever its form; `DamagedError` where it is none, or is not whole."""
    text = text_of(file)
    match file.suffix:
        case ".xml":
            return of_plcopen(text)
        case ".TcPOU" | ".TcDUT":
            return of_twincat(text)
        case ".scl":
            return of_scl(whole(text))
    return whole(text)


def whole(text: str) -> str:
    """The text, if it ends as a unit does."""
    if not text.endswith(LAST_LINES):
        raise DamagedError("it does not end as an export does")
    return text


def of_scl(text: str) -> str:
    """Plain text of SCL: other comments, no quotes around names, no # before them, types in capitals."""
    text = SCL_COMMENTS.sub(lambda found: f"(*{found[2].replace('//', '  ')} *)", text)
    text = SCL_REMARK.sub(r"(*\1 *)", text)
    text = SCL_TYPE.sub(r"TYPE \1 :", text)
    text = SCL_NAME.sub(r"\1", text).replace("#", "")
    text = SCL_ARRAY.sub(r"ARRAY[\1] OF", text)
    return re.sub(r"\b(?:Int|Real|Bool)\b", lambda found: found[0].upper(), text)


def of_twincat(text: str) -> str:
    """The text of an object of TwinCAT."""
    root = tree_of(text)
    declaration = root.findtext("./POU/Declaration") or root.findtext("./DUT/Declaration")
    if not declaration:
        raise DamagedError("it is no object of TwinCAT with a declaration")
    body = root.findtext("./POU/Implementation/ST")
    return declaration if body is None else f"{declaration}{body}END_FUNCTION_BLOCK\n"


def of_plcopen(text: str) -> str:
    """The types and blocks of a project of PLCopen, a declaration each variable."""
    root = tree_of(text)
    lines: list[str] = []
    for structure in root.iter(f"{PLCOPEN}dataType"):
        lines += [f"TYPE {structure.get('name')} : STRUCT", *declarations(structure), "END_STRUCT;", "END_TYPE"]
    for pou in root.iter(f"{PLCOPEN}pou"):
        body = pou.findtext(f"{PLCOPEN}body/{PLCOPEN}ST/{XHTML}p") or ""
        lines += [f"FUNCTION_BLOCK {pou.get('name')}", *declarations(pou), body, "END_FUNCTION_BLOCK"]
    return "\n".join([*lines, ""])


def declarations(owner: ElementTree.Element) -> Iterator[str]:
    """The variables of a block or the members of a structure, each behind what is said of it."""
    for variable in owner.iter(f"{PLCOPEN}variable"):
        note = variable.findtext(f"{PLCOPEN}documentation/{XHTML}p")
        if note:
            yield f"(* {note} *)"
        values = values_of(variable)
        yield f"{variable.get('name')} : {type_of(variable)}{f' := {values}' if values else ''};"


def type_of(variable: ElementTree.Element) -> str:
    """The name of a type; of an array with its bounds."""
    array = variable.find(f"{PLCOPEN}type/{PLCOPEN}array")
    if array is None:
        return first_name(variable.find(f"{PLCOPEN}type"))
    bounds = ", ".join(f"{each.get('lower')}..{each.get('upper')}" for each in array.iter(f"{PLCOPEN}dimension"))
    return f"ARRAY[{bounds}] OF {first_name(array.find(f'{PLCOPEN}baseType'))}"


def first_name(holder: ElementTree.Element | None) -> str:
    """The elementary type that an element holds, or the name of the derived one."""
    if holder is None or len(holder) == 0:
        raise DamagedError("a variable has no type")
    return holder[0].get("name") or holder[0].tag.removeprefix(PLCOPEN)


def values_of(variable: ElementTree.Element) -> str:
    """The initial value as it is written in text, "" for none; `DamagedError` for values told to be repeated."""
    initial = variable.find(f"{PLCOPEN}initialValue")
    if initial is None:
        return ""
    if any(each.attrib for each in initial.iter(f"{PLCOPEN}value")):
        raise DamagedError(f"the values of {variable.get('name')} have attributes, which no export gives them")
    values = ", ".join(each.get("value", "") for each in initial.iter(f"{PLCOPEN}simpleValue"))
    return f"[{values}]" if initial.find(f"{PLCOPEN}arrayValue") is not None else values


def tree_of(text: str) -> ElementTree.Element:
    """The root of an XML text; `DamagedError` where it is none, or declares what it consists of."""
    if "<!DOCTYPE" in text:  # entities that grow; no export has any
        raise DamagedError("it has a DOCTYPE, which no export has")
    try:
        return ElementTree.fromstring(text)
    except (ElementTree.ParseError, ValueError) as fault:
        raise DamagedError(f"it is no XML: {fault}") from None
