"""The parse tree of Structured Text, and what is wrong with a text that has none; tests skip without the parser."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from functools import cache
from importlib import import_module
from typing import Any, Protocol

import pytest


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
