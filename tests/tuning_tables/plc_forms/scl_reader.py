"""A reader of SCL that shares nothing with what wrote it: it checks the subset, and makes Structured Text of it again.

Every variable of a block must have its # in statements, and nothing else may have one; types and blocks of the export
must have quotes.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

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


def structured_text(source: str) -> str:
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
