"""Statements of Structured Text as functions of (frame, mask), where the mask says in which lanes they are executed."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterable, Mapping
from enum import Enum
from typing import Final, Protocol, TypeAlias

import numpy as np

from tests.tuning_tables.st.expressions import Arithmetic, Evaluate, Scope, compile_element, compile_expression, resolve
from tests.tuning_tables.st.storage import INT_LIMITS, Fault, Frame, Kind, Mask, Record, Scalar, Value
from tests.tuning_tables.st.syntax import Loops, Node, part, parts, word

Execute: TypeAlias = Callable[[Frame, Mask], None]


class Nowhere(Enum):
    """The mask without any lane."""

    NOWHERE = 0


NOWHERE: Final = Nowhere.NOWHERE


class Callee(Protocol):
    """What a call needs to know of a function block."""

    @property
    def inputs(self) -> Mapping[str, Scalar]: ...

    @property
    def references(self) -> Mapping[str, Kind]: ...

    @property
    def run(self) -> Execute: ...


def narrowed(mask: Mask, condition: Value) -> Mask | Nowhere:
    """`mask` where `condition` (one for all lanes, or one each) is true too."""
    if np.ndim(condition) == 0:
        return mask if condition else NOWHERE
    both = condition if mask is None else mask & condition
    return NOWHERE if not both.any() else None if both.all() else both


class StatementCompiler:
    """Statements in one scope; `blocks` finds the function (frame, mask) and inputs of a function block by its name."""

    def __init__(
        self, scope: Scope, constants: frozenset[str], arithmetic: Arithmetic, blocks: Callable[[str], Callee]
    ) -> None:
        self.scope = scope
        self.constants = constants
        self.arithmetic = arithmetic
        self.blocks = blocks

    def sequence(self, nodes: Iterable[Node]) -> Execute:
        """The statements `nodes` one after the other."""
        steps = [self.statement(node) for node in nodes]

        def run(frame: Frame, mask: Mask) -> None:
            for step in steps:
                step(frame, mask)

        return run

    def statement(self, node: Node) -> Execute:
        """The statement at `node` of the parse tree."""
        compilers = {
            "assignment_statement": self.assignment,
            "if_statement": self.branches,
            "case_statement": self.cases,
            "for_statement": self.loop,
            "while_statement": self.repeated,
            "invocation_statement": self.invocation,
        }
        if node.type not in compilers:
            raise Fault(f"{node.type} is not understood")
        return compilers[node.type](node)

    def expression(self, node: Node, kind: str) -> Evaluate:
        """The expression at `node`, which must be of `kind`."""
        compiled = compile_expression(node, self.scope, self.arithmetic)
        if compiled.kind != kind:
            raise Fault(f"{node.text!r} is {compiled.kind}, not {kind}")
        return compiled.run

    def assignment(self, node: Node) -> Execute:
        """variable := expression"""
        target = part(node, "left")
        done = self.arithmetic.done
        self._require_variable(target)
        if target.type == "index_expression":
            row, index = compile_element(target, self.scope, self.arithmetic)
            value = self.expression(part(node, "right"), row.kind)

            def store(frame: Frame, mask: Mask) -> None:
                done["assignment"] += 1
                row.find(frame).store(index(frame, mask), value(frame, mask), mask)

            return store
        kind, find = resolve(target, self.scope)
        if not isinstance(kind, Scalar):
            raise Fault(f"{target.text!r} is assigned as a whole")
        value = self.expression(part(node, "right"), kind.kind)

        def assign(frame: Frame, mask: Mask) -> None:
            done["assignment"] += 1
            find(frame).store(value(frame, mask), mask)

        return assign

    def branches(self, node: Node) -> Execute:
        """IF, ELSIF, ELSE"""
        arms = [(node, "consequence")] + [(child, "body") for child in node.children if child.type == "elsif_clause"]
        compiled = [
            (self.expression(part(arm, "condition"), "BOOL"), self.sequence(parts(arm, body))) for arm, body in arms
        ]
        otherwise = self._otherwise(node)

        def run(frame: Frame, mask: Mask) -> None:
            rest = mask
            for condition, body in compiled:
                value = condition(frame, rest)
                chosen = narrowed(rest, value)
                if chosen is not NOWHERE:
                    body(frame, chosen)
                remaining = narrowed(rest, np.logical_not(value))
                if remaining is NOWHERE:
                    return
                rest = remaining
            otherwise(frame, rest)

        return run

    def cases(self, node: Node) -> Execute:
        """CASE of whole numbers and ranges, with ELSE"""
        subject = self.expression(part(node, "subject"), "INT")
        clauses = [
            ([_range(value) for value in clause.children if value.type == "case_value"], parts(clause, "body"))
            for clause in node.children
            if clause.type == "case_clause"
        ]
        compiled = [(ranges, self.sequence(body)) for ranges, body in clauses]
        otherwise = self._otherwise(node)

        def run(frame: Frame, mask: Mask) -> None:
            value, rest = subject(frame, mask), mask
            for ranges, body in compiled:
                chosen = np.any([(low <= value) & (value <= high) for low, high in ranges], axis=0)
                here = narrowed(rest, chosen)
                if here is not NOWHERE:
                    body(frame, here)
                remaining = narrowed(rest, np.logical_not(chosen))
                if remaining is NOWHERE:
                    return
                rest = remaining
            otherwise(frame, rest)

        return run

    def loop(self, node: Node) -> Execute:
        """FOR ... TO ... BY ... DO"""
        kind, control = resolve(part(node, "control"), self.scope)
        self._require_variable(part(node, "control"))
        if kind != Scalar("INT"):
            raise Fault("a FOR loop counts an INT")
        start, end = (self.expression(part(node, field), "INT") for field in ("start", "end"))
        step_node = node.child_by_field_name("step")
        step = 1 if step_node is None else int(word(step_node))
        body = self.sequence(parts(node, "body"))
        done, loops = self.arithmetic.done, self.arithmetic.compiler.loops

        def run(frame: Frame, mask: Mask) -> None:
            count, last, rest = start(frame, mask), end(frame, mask), mask
            turns: Value = (last - count) // step + 1
            if loops is Loops.NONE_AT_EQUAL_ENDS:
                turns = np.where(count == last, 0, turns)
            if loops is Loops.ONE_BEYOND_THE_END:
                turns = np.maximum(turns, 1)
            for turn in itertools.count():
                done["turn"] += 1
                here = narrowed(rest, turn < turns)
                if here is NOWHERE:
                    return
                rest = here
                control(frame).store(count, rest)
                body(frame, rest)
                count = count + step

        return run

    def repeated(self, node: Node) -> Execute:
        """WHILE ... DO; one that turns more often than an INT counts is a fault."""
        condition = self.expression(part(node, "condition"), "BOOL")
        body = self.sequence(parts(node, "body"))
        done = self.arithmetic.done

        def run(frame: Frame, mask: Mask) -> None:
            rest = mask
            for _ in range(INT_LIMITS[1] + 1):
                done["turn"] += 1
                here = narrowed(rest, condition(frame, rest))
                if here is NOWHERE:
                    return
                rest = here
                body(frame, rest)
            raise Fault("a WHILE loop does not end")

        return run

    def invocation(self, node: Node) -> Execute:
        """instance(Input := expression, InOut := variable); an input that is not given keeps its value, 0 at first."""
        call = next(child for child in node.children if child.type == "call_expression")
        kind, find = resolve(part(call, "function"), self.scope)
        if not isinstance(kind, Record) or not kind.is_block:
            raise Fault(f"{call.text!r} calls no function block")
        block = self.blocks(kind.name)
        given = {
            word(part(child, "name")): part(child, "value")
            for child in part(call, "arguments").named_children
            if child.type == "named_argument"
        }
        if not set(block.references) <= set(given) <= set(block.inputs) | set(block.references):
            raise Fault(f"{kind.name} wants {[*block.inputs, *block.references]}, not {[*given]}")
        inputs = {name: self.expression(given[name], block.inputs[name].kind) for name in block.inputs if name in given}
        references = {name: resolve(given[name], self.scope) for name in block.references}
        if any(block.references[name] != found for name, (found, _) in references.items()):
            raise Fault(f"{call.text!r} hands over a variable of another type")
        done = self.arithmetic.done

        def run(frame: Frame, mask: Mask) -> None:
            done["call"] += 1
            inner = find(frame)
            values = {name: value(frame, mask) for name, value in inputs.items()}
            for name, value in values.items():
                inner[name].store(value, mask)
            block.run({**inner, **{name: found(frame) for name, (_, found) in references.items()}}, mask)

        return run

    def _otherwise(self, node: Node) -> Execute:
        clauses = [child for child in node.children if child.type == "else_clause"]
        return self.sequence(parts(clauses[0], "body") if clauses else [])

    def _require_variable(self, target: Node) -> None:
        name = word(target).partition("[")[0].partition(".")[0].strip()
        if name in self.constants:
            raise Fault(f"{name} is a constant or an input, and assigned to")


def _range(node: Node) -> tuple[int, int]:
    value = node.named_children[0]
    if value.type == "subrange":
        return int(word(part(value, "lower"))), int(word(part(value, "upper")))
    return int(word(value)), int(word(value))
