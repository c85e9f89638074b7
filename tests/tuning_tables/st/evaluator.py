"""An evaluator of Structured Text: it reads the parse tree alone, and runs it for many inputs (lanes) at once.

It runs a text as a given `Compiler` does; variables of REAL are float32, INT has 16 bits. It knows nothing of tables.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TypeVar

import numpy as np

from tests.tuning_tables.st.expressions import Arithmetic, compile_expression
from tests.tuning_tables.st.statements import Execute, StatementCompiler
from tests.tuning_tables.st.storage import Array, Fault, Frame, Initial, Kind, Record, Scalar, Value, variable
from tests.tuning_tables.st.syntax import BINARY32, Compiler, Node, faults, parse, part, parts, word

Entry = TypeVar("Entry")
SECTIONS = ("var_input", "var_in_out", "var_output", "var_block")


@dataclass(frozen=True)
class Block:
    """A function block: types of its inputs and in-outs, its own variables as a record, and its statements."""

    inputs: Mapping[str, Scalar]
    references: Mapping[str, Kind]
    record: Record
    run: Execute


class Program:
    """All types and function blocks of a text, as `compiler` runs them; the order of declaration counts.

    Raises `Fault`.
    """

    def __init__(self, text: bytes, compiler: Compiler = BINARY32) -> None:
        root = parse(text)
        if faults(root):
            raise Fault(f"this is no Structured Text: {faults(root)}")
        self.arithmetic = Arithmetic(compiler)
        self.types: dict[str, Kind] = {kind: Scalar(kind) for kind in ("REAL", "INT", "BOOL")}
        self.blocks: dict[str, Block] = {}
        for node in root.named_children:
            if node.type == "type_declaration":
                for definition in (child for child in node.named_children if child.type == "type_definition"):
                    self._declare_type(definition)
            elif node.type == "function_block_declaration":
                self._declare_block(node)
            elif node.type != "comment":
                raise Fault(f"{node.type} is not understood")

    @property
    def done(self) -> Counter[str]:
        """How often which operation was executed so far, in any lane."""
        return self.arithmetic.done

    def new(self, name: str) -> Frame:
        """A new variable of a declared type, or a new instance of a function block."""
        made = variable(self.types[name.upper()])
        if not isinstance(made, dict):
            raise Fault(f"{name} is neither a record nor a block")
        return made

    def call(self, name: str, instance: Frame, **arguments: Value) -> None:
        """Call the block `name`: arrays or numbers for its inputs, variables of `new` for its in-outs."""
        block = self.blocks[name.upper()]
        given = {key.upper(): value for key, value in arguments.items()}
        if set(given) != set(block.inputs) | set(block.references):
            raise Fault(f"{name} wants {[*block.inputs, *block.references]}, not {[*given]}")
        # What is wrong is found by its result; a NaN that is compared, or not used in any lane, is not wrong.
        with np.errstate(all="ignore"):
            for key in block.inputs:
                instance[key].store(given[key], None)
            block.run({**instance, **{key: given[key] for key in block.references}}, None)

    def _declare_type(self, node: Node) -> None:
        name, definition = word(part(node, "name")), part(node, "definition")
        if definition.type != "structure_type_inline":
            raise Fault(f"{definition.type} is not understood")
        members: dict[str, tuple[Kind, Initial]] = {}
        for member in (child for child in definition.named_children if child.type == "structure_field"):
            if member.child_by_field_name("default") is not None:
                raise Fault(f"{name} has an initial value inside the STRUCT")
            _add(members, word(part(member, "name")), (self._type(part(member, "type")), None))
        _add(self.types, name, Record(name, members))

    def _declare_block(self, node: Node) -> None:
        name = word(part(node, "name"))
        scope: dict[str, Kind] = {}
        own: dict[str, tuple[Kind, Initial]] = {}
        inputs: dict[str, Scalar] = {}
        references: dict[str, Kind] = {}
        constants: set[str] = set()
        for section in (child for child in node.named_children if child.type in SECTIONS):
            is_constant = any(child.type == "var_qualifier_list" for child in section.children)
            for declaration in (child for child in section.named_children if child.type == "variable_declaration"):
                kind, initial = self._type(part(declaration, "type")), self._initial(declaration)
                for variable_name in map(word, parts(declaration, "names")):
                    _add(scope, variable_name, kind)
                    if section.type == "var_in_out":
                        references[variable_name] = kind
                    else:
                        own[variable_name] = (kind, initial)
                    if section.type == "var_input":
                        if not isinstance(kind, Scalar):
                            raise Fault(f"the input {variable_name} is no number")
                        inputs[variable_name] = kind
                    if is_constant or section.type == "var_input":
                        constants.add(variable_name)
        compiler = StatementCompiler(scope, frozenset(constants), self.arithmetic, self.blocks.__getitem__)
        run = compiler.sequence(parts(node, "body"))
        record = Record(name, own, is_block=True)
        _add(self.types, name, record)
        self.blocks[name] = Block(inputs, references, record, run)

    def _type(self, node: Node) -> Kind:
        if node.type == "array_type":
            (bounds,) = parts(node, "range")
            low, high = (int(word(part(bounds, end))) for end in ("lower", "upper"))
            element = self._type(part(node, "element_type"))
            if not isinstance(element, Scalar) or low > high:
                raise Fault(f"{node.text!r} is not understood")
            return Array(low, high, element)
        if word(node) not in self.types:
            raise Fault(f"the type {word(node)} is not declared")
        return self.types[word(node)]

    def _initial(self, declaration: Node) -> Initial:
        """The initial value of a variable, a list for an array, None where none is given."""
        nodes = parts(declaration, "initial_value")
        if not nodes:
            return None
        kind = self._type(part(declaration, "type"))
        values = []
        for node in nodes:
            literal = compile_expression(node, {}, Arithmetic())
            element = kind.element if isinstance(kind, Array) else kind
            if Scalar(literal.kind) != element:
                raise Fault(f"{node.text!r} is {literal.kind}")
            values.append(literal.run({}, None))
        return values if isinstance(kind, Array) else values[0]


def _add(names: dict[str, Entry], name: str, entry: Entry) -> None:
    if name in names:
        raise Fault(f"{name} is declared twice")
    names[name] = entry
