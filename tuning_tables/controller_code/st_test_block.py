"""The frame of a block of the self-test in Structured Text: what it counts, its loops, checks of a whole table."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from tuning_tables.controller_code.code import ControllerCode, Values
from tuning_tables.controller_code.st_code import member_array
from tuning_tables.language.records import Kind, st_name
from tuning_tables.language.st_unit import Block, Declared, Variable
from tuning_tables.st_literals import pieces, place_of

CHECK: Final = """\
IF {differs} THEN
    IF #Failed = 0 THEN
        #FirstFailed := #Number;
    END_IF;
    #Failed := #Failed + 1;
END_IF;
#Number := #Number + 1;"""

OUTPUTS: Final = (
    Variable("Failed", Kind.INT, "checks that are wrong"),
    Variable("FirstFailed", Kind.INT, "the first of them, counted from 0; -1: none"),
)


@dataclass(frozen=True)
class TestBlock:
    """A block of the self-test, and the table that it takes, None for none."""

    block: Block
    table: int | None


def test_name(code: ControllerCode) -> str:
    """How the names of the self-test's blocks begin."""
    return f"RETARDER{code.ending.upper()}_TEST"


def short_name(code: ControllerCode) -> str:
    """How the names of blocks with questions begin: with all that follows they have 30 characters at most."""
    return test_name(code) if not code.ending else f"RETARDER{code.ending.upper()}"


def test_block(
    name: str, note: str, table: str, variables: list[Variable], constants: list[Variable], body: list[str]
) -> Block:
    """A block of the test; `table`: the type of the one that it takes, "" for none."""
    return Block(
        name,
        note,
        ("#Failed := 0;", "#FirstFailed := -1;", "#Number := 0;", *body),
        in_outs=(Variable("Table", Declared(table)),) if table else (),
        outputs=OUTPUTS,
        own=(*variables, Variable("Number", Kind.INT)),
        constants=tuple(constants),
    )


def check(differs: str, depth: int = 0) -> list[str]:
    """A check that counts."""
    return [" " * 4 * depth + line for line in CHECK.format(differs=differs).split("\n")]


def loop(length: int, body: list[str]) -> list[str]:
    """A loop over Index from 0."""
    return [
        "#Index := 0;",
        f"WHILE #Index < {length} DO",
        *(f"    {line}" for line in body),
        "    #Index := #Index + 1;",
        "END_WHILE;",
    ]


def compared(code: ControllerCode, values: Values) -> tuple[list[Variable], list[str]]:
    """Constants and checks of all numbers of `Table`."""
    constants: list[Variable] = []
    numbers: list[str] = []
    body: list[str] = []
    for name, member in code.table.members.items():
        array = np.atleast_1d(np.asarray(values[name])).ravel()
        # With a word behind it, because Step and Limit alone are words of the language.
        twin = f"{st_name(name).partition('_')[0]}Due"
        for ending, start, count in pieces(len(array)):
            constants.append(member_array(f"{twin}{ending}", member, array[start : start + count]))
            if member.axes:
                differs = f"#Table.{st_name(name)}[{place_of(start)}] <> #{twin}{ending}[#Index]"
                body += loop(count, check(differs))
        if not member.axes:
            numbers.append(f"(#Table.{st_name(name)} <> #{twin}[0])")
    return constants, [*check("\n    OR ".join(numbers)), *body]
