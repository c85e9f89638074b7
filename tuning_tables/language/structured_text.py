"""Programs as IEC 61131-3 Structured Text that every compiler runs alike.

One operation on REAL a statement; WHILE and no FOR; every REAL constant that is not exact in any precision stands in
VAR CONSTANT; arrays of one axis; no RETURN, no EXIT, no index that only the other side of an AND keeps in range.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from tuning_tables.language.records import Kind, SizedRecord, st_name
from tuning_tables.language.st_data import WIDTH, of_tables, real, st_comment
from tuning_tables.language.st_unit import MARK, Block, Declared, Variable, local, plain
from tuning_tables.language.tree import (
    Ask,
    Assign,
    Binary,
    Compare,
    Convert,
    Expression,
    Extreme,
    If,
    Item,
    Logic,
    Name,
    Not,
    Number,
    Program,
    Statement,
    While,
)
from tuning_tables.language.walking import (
    ArrayPlaces,
    Row,
    expressions_in,
    names_in,
    statements_in,
    sum_of,
    targets_in,
    variables_of,
)

COMPARISONS: Mapping[str, str] = {"==": "=", "!=": "<>"}


@dataclass(frozen=True)
class StNames:
    """What an export calls things: types by record, function blocks by program.

    Where no block is told its name is `prefix` and that of the program. `arrays`: by parameter, constant arrays,
    `CategoryOf` for its member `category`, so that it is no parameter here.
    """

    types: Mapping[str, str]
    blocks: Mapping[str, str]
    prefix: str
    arrays: Mapping[str, tuple[Variable, ...]]

    def block(self, program: Program) -> str:
        """The name of the function block."""
        return self.blocks.get(program.name, f"{self.prefix}{program.name.upper()}")


HELD = local("Held_")
"""How variables begin for what is not finished."""


def st_block(program: Program, names: StNames, sized: Mapping[str, SizedRecord]) -> Block:
    """The program as a function block."""
    return _Printer(program, names, sized).printed()


class _Printer:
    """One program while it is printed; `sized`: the records of the export by their names."""

    def __init__(self, program: Program, names: StNames, sized: Mapping[str, SizedRecord]) -> None:
        self.program = program
        self.names = names
        self.sized = {name: sized[record.name] for name, record in program.records.items()}
        self.lines: list[str] = []
        self.parts = 0
        self.most_parts = 0
        self.places = ArrayPlaces(self.atom, lambda item: self.sized[item.record].shape(item.member))
        self.rows: dict[str, Row] = {}
        self.all_rows = 0

    def printed(self) -> Block:
        """The whole block."""
        program = self.program
        self.block(program.body, 0)
        answers = {answer.name: answer.kind for answer in program.answers}
        own = {name: kind for name, kind in variables_of(program).items() if name not in answers}
        asked = {
            self.instance(each.program): each.program for each in statements_in(program.body) if isinstance(each, Ask)
        }
        inputs = [each for each in program.parameters if each.kind is not None]
        shared = [each for each in program.parameters if each.record and each.name not in self.names.arrays]
        held = [each for name in program.records for each in self.names.arrays.get(name, ())]
        return Block(
            self.names.block(program),
            program.note.split("\n\n")[0].replace("\n", " "),
            tuple(self.lines),
            inputs=tuple(Variable(st_name(each.name), each.kind, each.meaning) for each in inputs if each.kind),
            in_outs=tuple(Variable(st_name(each.name), Declared(self.names.types[each.record.name]))
                          for each in shared if each.record),
            outputs=tuple(Variable(st_name(name), kind) for name, kind in answers.items()),
            own=(
                *(Variable(name, Declared(self.names.block(each))) for name, each in asked.items()),
                *(Variable(st_name(name), kind) for name, kind in own.items()),
                *(Variable(f"Row_{place + 1}", Kind.INT) for place in range(self.all_rows)),
                *(Variable(f"{plain(HELD)}{place + 1}", Kind.REAL) for place in range(self.most_parts)),
            ),
            constants=(
                *(Variable(st_name(name.lower()), Kind.REAL, values=(real(value),))
                  for name, value in self.constants().items()),
                *held,
            ),
        )  # fmt: skip

    def constants(self) -> Mapping[str, float]:
        """The named constants of this program alone."""
        found = (each for each in expressions_in(self.program.body) if isinstance(each, Number))
        return {each.name: each.value for each in found if each.name}

    def instance(self, program: Program) -> str:
        """The instance of another program's block."""
        return f"{st_name(program.name)}Block"

    def put(self, depth: int, text: str) -> None:
        """A line, broken where it is too long."""
        pad = "    " * depth
        if len(pad) + len(plain(text)) <= WIDTH:
            self.lines.append(pad + text)
        else:
            self.lines += broken(text, pad)

    def block(self, body: tuple[Statement, ...], depth: int) -> None:
        """Statements one after the other."""
        outside = self.rows
        for place, statement in enumerate(body):
            self.hold_rows(body[place:], depth)
            if statement.comment:
                if MARK in statement.comment:
                    raise ValueError(f"{self.program.name}: no {MARK} may stand in a comment: {statement.comment}")
                self.lines += st_comment(statement.comment, "    " * depth)
            self.parts = 0
            match statement:
                case Assign(target=target, value=value):
                    self.assign(self.atom(target), target, value, depth)
                case Ask():
                    self.ask(statement, depth)
                case While(condition=condition, body=inner):
                    before = len(self.lines)
                    text = self.bare(condition, depth)
                    if len(self.lines) > before:
                        raise ValueError(f"{self.program.name}: the condition of a while must not calculate with REAL")
                    self.put(depth, f"WHILE {text} DO")
                    self.block(inner, depth + 1)
                    self.put(depth, "END_WHILE;")
                case If():
                    self.branches(statement, depth)
        self.rows = outside

    def hold_rows(self, body: tuple[Statement, ...], depth: int) -> None:
        """Put into variables, before the first statement, where rows begin that a loop asks for again and again."""
        assigned = {*targets_in(body[:1])}
        self.rows = {text: row for text, row in self.rows.items() if not row.names & assigned}
        for text, names in self.places.asked_again(body).items():
            if text not in self.rows:
                self.all_rows += 1
                row = local(f"Row_{self.all_rows}")
                self.rows = {**self.rows, text: Row(row, names)}
                self.put(depth, f"{row} := {text};")

    def branches(self, statement: If, depth: int) -> None:
        """IF, ELSIF, ELSE; what the conditions calculate stands before them."""
        tests = [self.bare(condition, depth) for condition, _ in statement.branches]
        for place, (test, (_, body)) in enumerate(zip(tests, statement.branches, strict=True)):
            self.put(depth, f"{'ELSIF' if place else 'IF'} {test} THEN")
            self.block(body, depth + 1)
        if statement.otherwise:
            self.put(depth, "ELSE")
            self.block(statement.otherwise, depth + 1)
        self.put(depth, "END_IF;")

    def ask(self, statement: Ask, depth: int) -> None:
        """A call of another block, and its answers."""
        instance = local(self.instance(statement.program))
        given = []
        for each, parameter in zip(statement.arguments, statement.program.parameters, strict=True):
            value = local(st_name(each)) if isinstance(each, str) else self.atom_of(each, depth)
            given.append(f"{st_name(parameter.name)} := {value}")
        self.put(depth, f"{instance}({', '.join(given)});")
        for target, answer in zip(statement.targets, statement.program.answers, strict=bool(statement.targets)):
            self.put(depth, f"{local(st_name(target.name))} := {instance}.{st_name(answer.name)};")

    def assign(self, text: str, target: Name | Item, value: Expression, depth: int) -> None:
        """target := value, one REAL operation a statement; the target holds what is not finished, if it may."""
        if not _calculates(value):
            if value != target:
                self.put(depth, f"{text} := {self.bare(value, depth)};")
            return
        assert isinstance(value, Binary | Extreme)
        later = {*names_in(value.right)} if isinstance(target, Name) else None
        holds = later is not None and isinstance(target, Name) and target.name not in later
        if isinstance(value, Extreme):
            right = self.atom_of(value.right, depth)
            held = text if holds else self.part()
            self.assign(held, target if holds else Name(held, Kind.REAL), value.left, depth)
            self.put(depth, f"IF {held} {'<' if value.is_larger else '>'} {right} THEN")
            self.put(depth + 1, f"{held} := {right};")
            self.put(depth, "END_IF;")
            if not holds:
                self.put(depth, f"{text} := {held};")
            return
        if _calculates(value.left) and holds and not _calculates(value.right):
            self.assign(text, target, value.left, depth)
            left = text
        else:
            left = self.atom_of(value.left, depth)
        right = self.atom_of(value.right, depth)
        self.put(depth, f"{text} := {left} {value.sign} {right};")

    def atom_of(self, value: Expression, depth: int) -> str:
        """An expression as an operand: what calculates with REAL goes into a part of its own first."""
        if not _calculates(value):
            return self.atom(value)
        part = self.part()
        self.assign(part, Name(part, Kind.REAL), value, depth)
        return part

    def part(self) -> str:
        """A variable for what is not finished."""
        self.parts += 1
        self.most_parts = max(self.most_parts, self.parts)
        return f"{HELD}{self.parts}"

    def bare(self, value: Expression, depth: int) -> str:
        """A whole expression: an operand, or a condition, or what calculates with whole numbers."""
        match value:
            case Compare(sign=sign, left=left, right=right):
                return f"{self.atom_of(left, depth)} {COMPARISONS.get(sign, sign)} {self.atom_of(right, depth)}"
            case Logic(is_all=is_all, values=values):
                return (" AND " if is_all else " OR ").join(self.operand(each, depth) for each in values)
            case Not(value=inner):
                return f"NOT {self.operand(inner, depth)}"
        return self.atom(value)[1:-1] if isinstance(value, Binary) else self.atom_of(value, depth)

    def operand(self, value: Expression, depth: int) -> str:
        """A side of AND or OR."""
        text = self.bare(value, depth)
        return f"({text})" if isinstance(value, Compare | Logic | Not) else text

    def atom(self, value: Expression) -> str:
        """An operand that needs no calculation with REAL."""
        match value:
            case Number(value=number, kind=Kind.REAL, name=name):
                return local(st_name(name.lower())) if name else f"{number:.1f}"
            case Number(value=number, kind=Kind.BOOL):
                return "TRUE" if number else "FALSE"
            case Number(value=number):
                return f"{int(number)}"
            case Name(name=name):
                return name if name.startswith(HELD) else local(st_name(name))
            case Convert(value=inner, kind=kind):
                return f"{'INT_TO_REAL' if kind is Kind.REAL else 'REAL_TO_INT'}({self.atom(inner)})"
            case Binary(sign=sign, left=left, right=right):
                return f"({self.atom(left)} {sign} {self.atom(right)})"
            case Item(record=record, member=member, indices=(number,)) if record in self.names.arrays:
                return f"{local(of_tables(member))}[{self.atom(number)}]"
            case Item(record=record, member=member, indices=indices):
                text = f"{local(st_name(record))}.{st_name(member)}"
                return text if not indices else f"{text}[{self.index(value)}]"
        raise ValueError(f"{self.program.name}: {value} is no operand")

    def index(self, item: Item) -> str:
        """The place in an array of one axis."""
        row = self.places.row(item)
        text = sum_of(self.rows[row].name if row in self.rows else row, self.atom(item.indices[-1]))
        return text[1:-1] if text.startswith("(") and text.endswith(")") and text.count("(") == 1 else text


def _calculates(value: Expression) -> bool:
    """Whether an expression is an operation on REAL."""
    return isinstance(value, Binary | Extreme) and value.kind is Kind.REAL


def broken(text: str, pad: str = "") -> Iterator[str]:
    """A statement in as many lines as it needs, broken before AND and OR and behind commas."""
    parts = re.sub(r", | (?=AND |OR )", lambda found: found[0].rstrip() + "\n", text).split("\n")
    line = pad + parts[0]
    for part in parts[1:]:
        if len(plain(f"{line} {part}")) <= WIDTH:
            line += f" {part}"
        else:
            yield line
            line = f"{pad}    {part}"
    yield line
