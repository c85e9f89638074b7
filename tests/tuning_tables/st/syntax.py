"""The parse tree of Structured Text, and what compilers make of one and the same text where they differ."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from enum import Enum
from functools import cache
from importlib import import_module
from typing import Any, Final, Protocol, TypeAlias

import numpy as np
import pytest

from tests.effort import sized

Real: TypeAlias = type[np.float32] | type[np.float64]


class Loops(Enum):
    """How often a FOR turns whose ends leave it one turn or none."""

    AS_IN_THE_STANDARD = "one turn where start and end are equal, none where the start is beyond the end"
    NONE_AT_EQUAL_ENDS = "no turn where start and end are equal"
    ONE_BEYOND_THE_END = "one turn where the start is beyond the end"


@dataclass(frozen=True)
class Compiler:
    """How a compiler runs a text. REAL variables and constants are float32 under each.

    `between`: what an operation on two REALs gives, until it is assigned. `literals`: what a real literal is inside an
    expression; an operation or comparison of a float64 and a float32 happens in float64. `fuses`: a product of REALs
    that is added or subtracted within the same expression is not rounded before. Product and sum are computed in
    float64 and rounded to float32 once: the product is exact then, the sum is not always, so a tie of the sum may
    fall otherwise than in a processor. That is good enough to find a text that lets a compiler fuse.
    """

    name: str
    between: Real = np.float32
    literals: Real = np.float32
    loops: Loops = Loops.AS_IN_THE_STANDARD
    fuses: bool = False


BINARY32: Final = Compiler("binary32")
DOUBLE: Final = Compiler("double rounded when assigned", between=np.float64, literals=np.float64)
LONG_LITERALS: Final = Compiler("literals are LREAL", literals=np.float64)
FUSING: Final = Compiler("fused multiplication and addition", fuses=True)
NO_TURN: Final = Compiler("no turn at equal ends", loops=Loops.NONE_AT_EQUAL_ENDS)
ONE_TURN_TOO_MANY: Final = Compiler("one turn beyond the end", loops=Loops.ONE_BEYOND_THE_END)
MATIEC: Final = Compiler("MATIEC of 2024", literals=np.float64, loops=Loops.NONE_AT_EQUAL_ENDS)
WORST: Final = Compiler(
    "LREAL literals, fused, one turn beyond the end",
    literals=np.float64,
    loops=Loops.ONE_BEYOND_THE_END,
    fuses=True,
)

ROUNDINGS: Final = (BINARY32, DOUBLE)
"""Those that differ in how operations among REALs are rounded, without a fault."""

COMPILERS: Final = (BINARY32, DOUBLE, LONG_LITERALS, FUSING, NO_TURN, ONE_TURN_TOO_MANY, MATIEC, WORST)
"""All under which every exported text must answer alike. CODESYS and STruC++ take literals as `LONG_LITERALS` does."""


ASKED_UNDER: Final = sized((BINARY32, WORST), COMPILERS)
"""Those under which hard questions are asked."""


def name_of(compiler: Compiler) -> str:
    """The name of a parametrised test."""
    return compiler.name


class Node(Protocol):
    """What of a tree-sitter node is used here; the parser is no dependency, so that its own types may be absent."""

    type: str
    text: bytes
    start_point: tuple[int, int]
    is_error: bool
    is_missing: bool
    is_named: bool
    has_error: bool
    children: Sequence[Node]
    named_children: Sequence[Node]

    def child_by_field_name(self, name: str, /) -> Node | None: ...

    def children_by_field_name(self, name: str, /) -> Sequence[Node]: ...


@cache
def parser() -> Any:
    """The parser, found when a text is parsed: what is beside it in a module of tests needs none.

    Where all tools are said to be there, a missing one is a failure.
    """
    find = import_module if os.environ.get("RETARDER_SYNTH_TOOLCHAIN") == "complete" else pytest.importorskip
    tree_sitter, grammar = find("tree_sitter"), find("tree_sitter_iec61131_3_st")
    return tree_sitter.Parser(tree_sitter.Language(grammar.language()))


def parse(text: bytes) -> Node:
    """The root node of the tree, errors included."""
    root: Node = parser().parse(text).root_node
    return root


def faults(node: Node) -> list[str]:
    """Where the text is no Structured Text: line and what stands there, from ERROR and MISSING nodes."""
    if node.is_error or node.is_missing:
        return [f"line {node.start_point[0] + 1}: {node.text[:60]!r}"]
    if not node.has_error:
        return []
    return [fault for child in node.children for fault in faults(child)] or ["a fault without a node"]


def walk(node: Node) -> Iterator[Node]:
    """`node` and all below it."""
    yield node
    for child in node.children:
        yield from walk(child)


def parts(node: Node, field: str) -> list[Node]:
    """The nodes in a field without comments, empty statements, commas and brackets."""
    return [
        child
        for child in node.children_by_field_name(field)
        if child.is_named and child.type not in ("comment", "empty_statement")
    ]


def part(node: Node, field: str) -> Node:
    """The node in a field that the grammar always fills."""
    found = node.child_by_field_name(field)
    assert found is not None, f"{node.type} without {field}"
    return found


def word(node: Node) -> str:
    """The text of a name in the one spelling that counts: Structured Text knows no capitals."""
    return node.text.decode("ascii").upper()
