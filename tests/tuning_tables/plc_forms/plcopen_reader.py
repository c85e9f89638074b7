"""A reader of PLCopen XML that shares nothing with what wrote it: it makes the Structured Text that a tool shows."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final
from xml.etree import ElementTree
from xml.etree.ElementTree import Element

TC6: Final = "{http://www.plcopen.org/xml/tc6_0201}"
PARAGRAPH: Final = "{http://www.w3.org/1999/xhtml}p"
SECTIONS: Final = {"inputVars": "VAR_INPUT", "inOutVars": "VAR_IN_OUT", "outputVars": "VAR_OUTPUT", "localVars": "VAR"}


def one(parent: Element, path: str) -> Element:
    """The one element at a path of names of the schema."""
    (found,) = parent.findall("/".join(TC6 + name for name in path.split("/")))
    return found


def structured_text(content: bytes) -> str:
    """All types and blocks of a file, in their order."""
    root = ElementTree.fromstring(content)
    assert root.tag == f"{TC6}project"
    types = [data_type(each) for each in one(root, "types/dataTypes")]
    return "\n".join([*types, *(pou(each) for each in one(root, "types/pous"))])


def data_type(element: Element) -> str:
    """A structure."""
    members = "".join(f"{line}\n" for each in one(element, "baseType/struct") for line in variable(each))
    return f"TYPE {element.get('name')} : STRUCT\n{members}END_STRUCT; END_TYPE\n"


def pou(element: Element) -> str:
    """A function block."""
    assert element.get("pouType") == "functionBlock"
    lines = [f"FUNCTION_BLOCK {element.get('name')}"]
    for section in one(element, "interface"):
        is_constant = " CONSTANT" if section.get("constant") == "true" else ""
        lines.append(SECTIONS[section.tag.removeprefix(TC6)] + is_constant)
        lines += [line for each in section for line in variable(each)]
        lines.append("END_VAR")
    (text,) = one(element, "body/ST")
    assert text.tag == PARAGRAPH
    return "\n".join([*lines, text.text or "", "END_FUNCTION_BLOCK", ""])


def variable(element: Element) -> Iterator[str]:
    """A declaration, with its documentation as a comment."""
    (kind,) = one(element, "type")
    text = f"{element.get('name')} : {type_text(kind)}"
    if (initial := element.find(f"{TC6}initialValue")) is not None:
        (value,) = initial
        text += f" := {value_text(value)}"
    yield f"{text};"
    if (note := element.find(f"{TC6}documentation/{PARAGRAPH}")) is not None:
        yield f"(* {note.text} *)"


def type_text(element: Element) -> str:
    """A type."""
    name = element.tag.removeprefix(TC6)
    if name == "derived":
        return str(element.get("name"))
    if name == "array":
        bounds = one(element, "dimension")
        (of,) = one(element, "baseType")
        return f"ARRAY[{bounds.get('lower')}..{bounds.get('upper')}] OF {type_text(of)}"
    assert name in ("REAL", "INT", "BOOL")
    return name


def value_text(element: Element) -> str:
    """An initial value."""
    if element.tag == f"{TC6}simpleValue":
        return str(element.get("value"))
    assert element.tag == f"{TC6}arrayValue"
    return f"[{', '.join(value_text(value) for each in element for value in each)}]"
