"""Readers of PLCopen XML, TwinCAT objects and SCL that share nothing with what wrote them: each makes Structured
Text.

Of SCL the reader checks the subset: every variable of a block must have its # in statements, and nothing else may have
one; types and blocks of the export must have quotes.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
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


def plcopen_text(content: bytes) -> str:
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


@dataclass(frozen=True)
class TcObject:
    """What a file holds: its name and id, the declaration, and the statements, None for a structure."""

    name: str
    id: str
    declaration: str
    statements: str | None

    def text(self) -> str:
        """The object as Structured Text."""
        if self.statements is not None:
            return f"{self.declaration}\n{self.statements}\nEND_FUNCTION_BLOCK\n"
        # The evaluator wants what the standard has behind a structure, and TwinCAT leaves out.
        return re.sub(r"\bEND_STRUCT\b(?!;)", "END_STRUCT;", self.declaration)


def objects(files: Mapping[str, bytes]) -> list[TcObject]:
    """The objects of a folder, structures first; each file is called as its object is."""
    found = []
    for path, content in files.items():
        root = ElementTree.fromstring(content)
        assert root.tag == "TcPlcObject"
        (element,) = root
        name, ending = path.rpartition("/")[2].split(".")
        assert (element.tag, element.get("Name")) == ({"TcPOU": "POU", "TcDUT": "DUT"}[ending], name)
        body = element.findtext("Implementation/ST")
        assert (body is None) == (ending == "TcDUT")
        found.append(TcObject(name, str(element.get("Id")), str(element.findtext("Declaration")), body))
    return sorted(found, key=lambda each: each.statements is not None)


def twincat_text(files: Mapping[str, bytes]) -> str:
    """All objects in an order in which none needs a later one: TwinCAT looks for it itself."""
    rest, text, known = objects(files), "", set[str]()
    names = {each.name for each in rest}
    while rest:
        for each in rest:
            used = set(re.findall(r"\w+", re.sub(r"\(\*.*?\*\)", "", each.declaration, flags=re.DOTALL))) & names
            if used <= known | {each.name}:
                text += each.text() + "\n"
                known.add(each.name)
                rest.remove(each)
                break
        else:
            raise AssertionError(f"{[each.name for each in rest]} need each other")
    return text


TOKEN: Final = re.compile(
    r"""(?P<comment>\(\*.*?\*\)|//[^\n]*)|(?P<quoted>"\w+")|(?P<local>\#\w+)|(?P<name>[A-Za-z_]\w*)
    |(?P<number>-?\d+(?:\.\d+(?:E[+-]\d+)?)?)|(?P<attribute>\{[^}]*\})|(?P<space>\s+)|(?P<sign>:=|<>|<=|>=|\.\.|[-+*/=<>();:,.\[\]])""",
    re.VERBOSE | re.DOTALL,
)
WORDS: Final = frozenset(
    """AND ARRAY BEGIN BOOL CASE CONSTANT DO ELSE ELSIF END_CASE END_FUNCTION_BLOCK END_IF END_STRUCT END_TYPE END_VAR
    END_WHILE FALSE FUNCTION_BLOCK IF INT INT_TO_REAL NOT OF OR REAL REAL_TO_INT STRUCT THEN TRUE TYPE VAR VAR_IN_OUT
    VAR_INPUT VAR_OUTPUT VERSION WHILE XOR""".split()  # noqa: SIM905
)
ATTRIBUTE: Final = "{ S7_Optimized_Access := 'TRUE' }"


@dataclass(frozen=True)
class Token:
    """A piece of a source: its kind, as `TOKEN` names it, and its text."""

    kind: str
    text: str


def tokens(source: str) -> Iterator[Token]:
    """The pieces of a source but space; whatever is no SCL of the subset is an error."""
    place = 0
    while place < len(source):
        found = TOKEN.match(source, place)
        assert found is not None, f"no SCL: {source[place : place + 40]!r}"
        place = found.end()
        if found.lastgroup not in ("space", "comment"):
            yield Token(str(found.lastgroup), found[0])


def scl_text(source: str) -> str:
    """A source as Structured Text, a line each token: for a program, not for the eye."""
    return "\n".join(_Reader(list(tokens(source))).units())


class _Reader:
    """The tokens of a source, from the first to the last."""

    def __init__(self, given: list[Token]) -> None:
        self.given = given
        self.at = 0

    def take(self, *texts: str) -> str:
        """The next token, which must be one of `texts`, if any are told; words count without capitals."""
        token = self.given[self.at]
        self.at += 1
        assert not texts or token.text.upper() in texts, f"{token.text} where {texts} is due"
        return token.text

    def peek(self) -> str:
        """The next token."""
        return self.given[self.at].text.upper()

    def quoted(self) -> str:
        """A name in quotes, without them."""
        assert self.given[self.at].kind == "quoted", f"{self.given[self.at].text} has no quotes"
        return self.take().strip('"')

    def units(self) -> Iterator[str]:
        """All units."""
        while self.at < len(self.given):
            yield from self.structure() if self.take("TYPE", "FUNCTION_BLOCK").upper() == "TYPE" else self.block()

    def version(self) -> None:
        """VERSION : 0.1"""
        for each in ("VERSION", ":", "0.1"):
            self.take(each)

    def structure(self) -> Iterator[str]:
        """A structure."""
        yield f"TYPE {self.quoted()} :"
        self.version()
        yield self.take("STRUCT")
        while self.peek() != "END_STRUCT":
            yield from self.declaration(set())
        yield self.take("END_STRUCT") + self.take(";")
        yield self.take("END_TYPE")

    def block(self) -> Iterator[str]:
        """A function block."""
        name, own = self.quoted(), set[str]()
        yield f"FUNCTION_BLOCK {name}"
        assert self.take() == ATTRIBUTE
        self.version()
        while self.peek() != "BEGIN":
            yield self.take("VAR", "VAR_INPUT", "VAR_OUTPUT", "VAR_IN_OUT")
            is_constant = self.peek() == "CONSTANT"
            if is_constant:
                yield self.take()
            while self.peek() != "END_VAR":
                lines = list(self.declaration(own))
                assert not is_constant or "Array" not in lines, "VAR CONSTANT takes no array"
                yield from lines
            yield self.take()
        self.take("BEGIN")
        while self.peek() != "END_FUNCTION_BLOCK":
            yield self.statement_token(own)
        yield self.take()

    def declaration(self, own: set[str]) -> Iterator[str]:
        """A declaration up to its semicolon."""
        own.add(self.peek())
        assert self.given[self.at].kind == "name"
        yield self.take()
        while self.peek() != ";":
            token = self.given[self.at]
            assert token.kind != "local", token.text
            assert token.kind != "name" or token.text.upper() in WORDS, token.text
            yield self.take().strip('"')
        yield self.take()

    def statement_token(self, own: set[str]) -> str:
        """A token of a statement, without its #."""
        before, token, after = self.given[self.at - 1], self.given[self.at], self.given[self.at + 1]
        self.at += 1
        assert token.kind != "quoted", f"{token.text}: no statement names a block or a type"
        if token.kind == "local":
            assert token.text[1:].upper() in own, f"{token.text} is not declared"
            assert before.text != ".", f"{token.text} is a member"
            assert before.text not in ("(", ",") or after.text != ":=", f"{token.text} is a parameter"
        elif token.kind == "name":
            is_member = before.text == "."
            is_parameter = before.text in ("(", ",") and after.text == ":="
            assert is_member or is_parameter or token.text.upper() in WORDS, f"{token.text} has no #"
        return token.text.removeprefix("#")
