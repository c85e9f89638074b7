"""Programs as C99: freestanding, one rounding an operation, no name but those of the export."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from tuning_tables.language.c99_data import WIDTH, c_comment
from tuning_tables.language.records import Kind
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
    Room,
    Statement,
    While,
)
from tuning_tables.language.walking import (
    expressions_in,
    names_read,
    statements_in,
    states_changed,
    targets_in,
    variables_of,
)


@dataclass(frozen=True)
class CNames:
    """What a C export calls things: types by record, functions by program; other programs are static.

    `without`: what a function answers where a record is missing (a null pointer). `arrays`: by parameter, the array of
    all tables in which it finds its members, so that it is no parameter in C.
    """

    types: Mapping[str, str]
    functions: Mapping[str, str]
    without: Mapping[str, str]
    arrays: Mapping[str, str]

    def function(self, program: Program) -> str:
        """The name of the function."""
        return self.functions.get(program.name, program.name)


def c_prototype(program: Program, names: CNames) -> str:
    """The head of a function, without its semicolon."""
    changed = states_changed(program)
    taken = []
    for each in program.parameters:
        if each.name in names.arrays:
            continue
        if each.record is None:
            taken.append(f"{each.kind.c if each.kind else ''} {each.name}")
        else:
            const = "" if each.name in changed else "const "
            taken.append(f"{const}{names.types[each.record.name]} *{each.name}")
    if len(program.answers) == 1:
        kind = program.answers[0].kind.c
    else:
        kind = "void"
        taken += [f"{answer.kind.c} *{answer.name}_found" for answer in program.answers]
    static = "" if program.name in names.functions else "static "
    return wrapped(f"{static}{kind} {names.function(program)}({', '.join(taken) or 'void'})", 0)


def c_function(program: Program, names: CNames) -> str:
    """The function, with its docstring's first paragraph as comment where it is static."""
    return _Printer(program, names).text()


class _Printer:
    def __init__(self, program: Program, names: CNames) -> None:
        self.program = program
        self.names = names
        self.lines: list[str] = []
        self.assigned = Counter(targets_in(program.body))
        self.read = Counter(_reads(program.body))
        self.at_once: set[str] = set()

    def text(self) -> str:
        program = self.program
        paragraph = program.note.split("\n\n")[0].replace("\n", " ")
        head = [] if program.name in self.names.functions else c_comment(paragraph)
        parameters = {each.name for each in program.parameters}
        self.block(program.body, 1)
        late: dict[Kind, list[str]] = {}
        for name, kind in variables_of(program).items():
            if name not in self.at_once | parameters:
                late.setdefault(kind, []).append(name)
        declared = [f"    {kind.c} {', '.join(each)};" for kind, each in late.items()]
        read = {*self.read} | {answer.name for answer in program.answers}
        unused = [
            f"    (void){each.name};" for each in program.parameters if each.record is None and each.name not in read
        ]
        unused += [
            f"    (void){name};" for name in program.records if name not in {*self.used_records(), *self.names.arrays}
        ]
        end = [f"    return {program.answers[0].name};"] if len(program.answers) == 1 else [
            f"    *{answer.name}_found = {answer.name};" for answer in program.answers
        ]  # fmt: skip
        body = [*declared, *unused, *self.guard(), *self.lines, *end]
        return "\n".join([*head, c_prototype(program, self.names), "{", *body, "}", ""])

    def used_records(self) -> set[str]:
        """The record parameters that the body looks at."""
        found: set[str] = set()
        for each in expressions_in(self.program.body):
            if isinstance(each, Item):
                found.add(each.record)
        for statement in statements_in(self.program.body):
            if isinstance(statement, Ask):
                found.update(each for each in statement.arguments if isinstance(each, str))
            if isinstance(statement, Assign) and isinstance(statement.target, Item):
                found.add(statement.target.record)
        return found

    def guard(self) -> list[str]:
        """What a function of the export answers without its records."""
        records = [name for name in self.program.records if name not in self.names.arrays]
        if self.program.name not in self.names.functions or not records:
            return []
        missing = " || ".join(f"{name} == 0" for name in records)
        answer = self.names.without.get(self.program.name, "")
        return [f"    if ({missing}) {{", f"        return{' ' * bool(answer)}{answer};", "    }"]

    def put(self, depth: int, text: str) -> None:
        self.lines.append(wrapped(text, depth))

    def block(self, body: tuple[Statement, ...], depth: int) -> None:
        """Statements one after the other; a variable used nowhere else is declared where it is first assigned."""
        for place, statement in enumerate(body):
            if statement.comment:
                self.lines += c_comment(statement.comment, depth)
            match statement:
                case Assign(target=Name() as target, value=value):
                    self.put(depth, f"{self.declared(target, body, place, depth)}{target.name} = {self.bare(value)};")
                case Assign(target=target, value=value):
                    self.put(depth, f"{self.value(target)} = {self.bare(value)};")
                case Ask(targets=(target,)):
                    self.put(
                        depth, f"{self.declared(target, body, place, depth)}{target.name} = {self.call(statement)};"
                    )
                case Ask(targets=targets):
                    for each in targets:
                        declared = self.declared(each, body, place, depth)
                        if declared:
                            self.put(depth, f"{declared.removeprefix('const ')}{each.name};")
                    self.put(depth, f"{self.call(statement)};")
                case While(condition=condition, body=inner):
                    self.put(depth, f"while ({self.bare(condition)}) {{")
                    self.block(inner, depth + 1)
                    self.put(depth, "}")
                case If(branches=branches, otherwise=otherwise):
                    word = "if"
                    for condition, inner in branches:
                        self.put(depth, f"{word} ({self.bare(condition)}) {{")
                        self.block(inner, depth + 1)
                        word = "} else if"
                    if otherwise:
                        self.put(depth, "} else {")
                        self.block(otherwise, depth + 1)
                    self.put(depth, "}")

    def declared(self, target: Name, body: tuple[Statement, ...], place: int, depth: int) -> str:
        """The type before an assignment that declares its variable: the first, if no use is outside the block."""
        name = target.name
        if name in self.at_once or (depth > 1 and target in self.program.answers):
            return ""
        read, assigned = (Counter(each) for each in (_reads(body), targets_in(body)))
        before = {*_reads(body[:place]), *targets_in(body[:place]), *_reads(body[place : place + 1])}
        if name in before or read[name] < self.read[name] or assigned[name] < self.assigned[name]:
            return ""
        self.at_once.add(name)
        return f"{'const ' if assigned[name] == 1 else ''}{target.kind.c} "

    def call(self, statement: Ask) -> str:
        """A call of another program; several answers go to the addresses of their variables."""
        given = [each if isinstance(each, str) else self.bare(each) for each in statement.arguments
                 if each not in self.names.arrays]  # fmt: skip
        if len(statement.targets) != 1:
            given += [f"&{each.name}" for each in statement.targets]
        return f"{self.names.function(statement.program)}({', '.join(given)})"

    def bare(self, value: Expression) -> str:
        """An expression without parentheses around the whole."""
        text = self.value(value)
        return text[1:-1] if isinstance(value, Binary | Compare | Logic) and text.startswith("(") else text

    def value(self, value: Expression) -> str:
        """An expression; what is no operand by itself stands in parentheses."""
        match value:
            case Number(value=number, kind=Kind.REAL, name=name):
                return name or f"{number:.1f}f"
            case Number(value=number):
                return f"{int(number)}"
            case Name(name=name):
                return name
            case Item(record=record, member=member, indices=(number,)) if record in self.names.arrays:
                return f"{self.names.arrays[record]}[{self.bare(number)}].{member}"
            case Item(record=record, member=member, indices=indices):
                return f"{record}->{member}" + "".join(f"[{self.bare(each)}]" for each in indices)
            case Binary(sign=sign, left=left, right=right, kind=Kind.REAL):
                return f"rounded({self.value(left)} {sign} {self.value(right)})"
            case Binary(sign=sign, left=left, right=right):
                return f"({self.value(left)} {sign} {self.value(right)})"
            case Extreme(is_larger=is_larger, left=left, right=right):
                return f"{'larger' if is_larger else 'smaller'}({self.bare(left)}, {self.bare(right)})"
            case Convert(value=inner, kind=kind):
                return f"({kind.c}){self.value(inner)}"
            case Compare(sign="==", left=left, right=right) if left.kind is Kind.REAL:
                return f"is_equal({self.bare(left)}, {self.bare(right)})"
            case Compare(sign=sign, left=left, right=right):
                return f"({self.value(left)} {sign} {self.value(right)})"
            case Logic(is_all=is_all, values=values):
                joined = (" && " if is_all else " || ").join(self.operand(each) for each in values)
                return f"({joined})"
            case Not(value=inner):
                return f"!{self.value(inner)}"
            case Room():
                raise TypeError("the length of an axis is known once the program is folded")

    def operand(self, value: Expression) -> str:
        """A side of && or ||: comparisons need no parentheses there."""
        return self.bare(value) if isinstance(value, Compare) else self.value(value)


def wrapped(text: str, depth: int) -> str:
    """A line, broken behind commas and operators where it is too long."""
    pad = "    " * depth
    if len(pad) + len(text) <= WIDTH:
        return pad + text
    parts = [each.replace("\0", " ") for each in
             re.sub(r"(,|&&|\|\||=|\+|-|\*|/) ", "\\1\n", text).split("\n")]  # fmt: skip
    lines, more = [pad + parts[0]], pad + "        "
    for part in parts[1:]:
        if len(lines[-1]) + 1 + len(part) <= WIDTH:
            lines[-1] += f" {part}"
        else:
            lines.append(more + part)
    return "\n".join(lines)


def _reads(body: tuple[Statement, ...]) -> Iterator[str]:
    return (name for each in body for name in names_read(each))
