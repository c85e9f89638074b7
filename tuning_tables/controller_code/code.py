"""What is exported to a controller, whatever the language: records, rules, the tables of a book, golden questions."""

from __future__ import annotations

import zlib
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Final, Protocol

import numpy as np
import numpy.typing as npt

from tuning_tables.category_number import CategoryName, comment_text
from tuning_tables.language.folding import folded
from tuning_tables.language.reading import program_of
from tuning_tables.language.records import Kind, Record, SizedRecord
from tuning_tables.language.tree import Ask, Program
from tuning_tables.language.walking import looked_at, statements_in
from tuning_tables.provenance import Generator

BEFORE: Final = "before_"
"""How the name of a field begins that sets a member of the state before its question."""

Values = Mapping[str, Any]
"""Numbers and arrays by member, with the shapes of a sized record."""


@dataclass(frozen=True)
class Rule:
    """A rule of an export: the function, its name, and what it answers in C where a record is missing."""

    function: Callable[..., Any]
    name: str
    without: str = ""


@dataclass(frozen=True)
class HeldTable:
    """A table of an export: its id, for comments, and its numbers."""

    id: str
    values: Values


@dataclass(frozen=True, eq=False)
class Questions:
    """Questions to rules, one after the other, and the right answers: rows of a structured array.

    about: what they ask, in a word or two. rules: asked in this order at each row. Fields of `rows`: "table", the
    number of the table; "before_" and a member, what that member of the state is set to before; "begins", whether the
    state is forgotten then; the numbers that the rules take, by the names of their parameters; what they answer, by the
    names of their answers; and members of the state, as they stand afterwards.
    """

    about: str
    rules: tuple[Rule, ...]
    rows: npt.NDArray[np.void]

    def __post_init__(self) -> None:
        self.rows.setflags(write=False)

    @property
    def asked(self) -> tuple[str, ...]:
        """The parameters that are numbers, each once."""
        programs = [program_of(rule.function) for rule in self.rules]
        names = (each.name for program in programs for each in program.parameters if each.record is None)
        return tuple(dict.fromkeys(names))

    @property
    def expected(self) -> tuple[str, ...]:
        """The answers, and the members of the state."""
        names = self.rows.dtype.names or ()
        others = ("table", "begins", *self.asked)
        return tuple(name for name in names if name not in others and not name.startswith(BEFORE))

    @property
    def members_before(self) -> tuple[str, ...]:
        """The members of the state that each question sets, so that it stands for itself."""
        return tuple(name.removeprefix(BEFORE) for name in self.rows.dtype.names or () if name.startswith(BEFORE))


@dataclass(frozen=True)
class Commanded:
    """A cut for which a table is chosen: how that ends, and what is chosen; None for no table."""

    category: int
    axles: int
    commanded_m_s: np.float32
    status: int
    chosen: Values | None


class Made(Protocol):
    """A table of any kind, as far as it tells what made it."""

    @property
    def generator(self) -> Generator:
        """What made it."""
        ...

    @property
    def created(self) -> str:
        """When."""
        ...


Place = tuple[int, ...]
"""A place in the axes of a member."""


@dataclass(frozen=True)
class OddQuestion:
    """What is changed beforehand, and stays so: (member, place in its axes, number); then a rule, and its answer.

    `given`: the numbers that the rule is asked with. A state has just begun.
    """

    changes: tuple[tuple[str, Place, float], ...]
    rule: Rule
    given: Mapping[str, float]
    wanted: float


@dataclass(frozen=True, eq=False)
class ControllerCode:
    """An export: a book of tables of one kind.

    `stem`: of its files, "table" in retarder_table.c; tables with lines have it, and their names are the short ones.
    `head`: paragraphs for the head of each file. `records`: of the table, then of the states, each with the name of
    its type. A record `tables` has what a rule looks at of every table. `chooses`: the rule `choose`, and `blend`
    where there is something between two tables. `odd`: questions to a changed copy of table 0. `named`: numbers that
    have names in C, with what they mean. `empty`: the member that is 0 in what is no table.
    """

    stem: str
    title: str
    head: tuple[str, ...]
    origin: tuple[str, ...]
    categories: tuple[CategoryName, ...]
    records: Mapping[str, str]
    declared: tuple[Record, ...]
    room: Mapping[str, int]
    tables: tuple[HeldTable, ...]
    rules: tuple[Rule, ...]
    chooses: tuple[Rule, ...]
    questions: tuple[Questions, ...]
    commands: tuple[Commanded, ...]
    odd: tuple[OddQuestion, ...] = ()
    named: tuple[tuple[str, int, str], ...] = ()
    empty: str = "stages"

    @cached_property
    def sized(self) -> Mapping[str, SizedRecord]:
        """The records with the room of this export, by name."""
        return {each.name: each.sized(self.room) for each in self.declared}

    @property
    def table(self) -> SizedRecord:
        """The record of the table."""
        return self.sized[self.declared[0].name]

    @property
    def table_name(self) -> str:
        """The name of a table: "passage_table"."""
        return self.records[self.declared[0].name]

    @property
    def ending(self) -> str:
        """What tells names from those of tables with lines: "_passages" in retarder_select_passages; "" for these."""
        return "" if self.stem == "table" else f"_{self.stem}"

    @property
    def blends(self) -> bool:
        """Whether there is something between two tables."""
        return any(rule.name == "blend" for rule in self.chooses)

    @property
    def looks_at_all(self) -> bool:
        """Whether a rule looks at all tables."""
        return any(each.name == "tables" for each in self.declared)

    @property
    def states(self) -> tuple[SizedRecord, ...]:
        """The records of the states."""
        return tuple(self.sized[each.name] for each in self.declared if each.is_state)

    @cached_property
    def programs(self) -> tuple[Program, ...]:
        """All rules and those that they ask, folded, each once, none before one that it asks."""
        return programs_of((*self.chooses, *self.rules), self.sized)

    def beginning(self, state: str) -> Rule:
        """The rule that begins a state."""
        return next(
            each for each in self.rules if each.name.startswith("begin") and state in self.program(each).records
        )

    def program(self, rule: Rule) -> Program:
        """The folded program of a rule."""
        return next(each for each in self.programs if each.name == rule.function.__name__)

    @property
    def told_origin(self) -> tuple[str, ...]:
        """The lines of `origin`; what `tag` is, and the tables by number, where they are those of a cut or category."""
        if not self.categories:
            return self.origin
        return (
            *self.origin,
            "           retarder_configuration.toml beside this text, where there is one, is the configuration",
            f"content    CRC-32 {self.tag:08x} over categories and tables, the same in each language",
            *(f"table {number:<4} {comment_text(table.id)}" for number, table in enumerate(self.tables)),
        )

    @cached_property
    def tag(self) -> int:
        """A number that differs for exports whose files must not be mixed: CRC-32 over categories and all tables."""
        content = "\n".join(each.category for each in self.categories).encode("utf-8")
        for table in self.tables:
            content += words_of(self.table, table.values).astype("<u4").tobytes()
        return zlib.crc32(content)


def programs_of(rules: Sequence[Rule], sized: Mapping[str, SizedRecord]) -> tuple[Program, ...]:
    """The rules and those that they ask, folded for these records, each once, none before one that it asks."""
    found: dict[str, Program] = {}
    for rule in rules:
        for program in with_asked(folded(program_of(rule.function), sized)):
            if found.setdefault(program.name, program) != program:
                raise ValueError(f"{program.name} is a rule, and is asked with other parameters.")
    return tuple(found.values())


def with_asked(program: Program) -> list[Program]:
    """The programs that a program asks, each before who asks it, and the program itself."""
    found: list[Program] = []
    for statement in statements_in(program.body):
        if isinstance(statement, Ask):
            found += with_asked(statement.program)
    return [*found, program]


def words_of(record: SizedRecord, values: Values) -> npt.NDArray[np.uint32]:
    """The words of a record, uint32, without a checksum."""
    parts = []
    for name, member in record.members.items():
        kind = np.float32 if member.kind is Kind.REAL else np.int32
        array = np.asarray(values[name], dtype=kind)
        if array.shape != record.shape(name):
            raise ValueError(f"{name} has the shape {array.shape}, but {record.shape(name)} is its room.")
        parts.append(np.ascontiguousarray(array).ravel().view(np.uint32))
    return np.concatenate(parts)


def crc32_of(words: npt.NDArray[np.uint32]) -> int:
    """The checksum of words, each from its lowest byte to its highest."""
    return zlib.crc32(words.astype("<u4").tobytes())


def made_by(tables: Sequence[Made]) -> Iterator[str]:
    """How many tables there are, and what made them, in ASCII."""
    yield f"tables     {len(tables)}"
    for generator, created in dict.fromkeys((table.generator, table.created) for table in tables):
        yield f"made by    {comment_text(generator.name)} {comment_text(generator.version)}, {created}"
        yield f"           configuration {generator.config_sha256}"


def padded(array: npt.NDArray[Any], shape: Sequence[int]) -> npt.NDArray[Any]:
    """The array with zeros up to this shape."""
    found = np.zeros(shape, dtype=array.dtype)
    found[tuple(slice(length) for length in array.shape)] = array
    return found


def kinds_of(code: ControllerCode, questions: Questions) -> Mapping[str, Kind]:
    """The kinds of the fields of the rows, without parameters that nothing in this export looks at."""
    found = {}
    asked = {name for rule in questions.rules for name in looked_at(code.program(rule))}
    for name in questions.rows.dtype.names or ():
        if name not in questions.asked or name in asked:
            found[name] = KINDS.get(questions.rows.dtype[name].kind, Kind.INT)
    return found


KINDS: Final = {"f": Kind.REAL, "b": Kind.BOOL}
"""By the kind of a numpy type; all others are whole."""
