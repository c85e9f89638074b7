"""The estimators of a book as constants of RETARDER_LOAD, and the blocks that use them."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping
from string import Template
from typing import Final

import numpy as np
import numpy.typing as npt

from tuning_tables.c_estimator import alarm_bits, estimator_limits
from tuning_tables.distinct_estimators import distinct_estimators
from tuning_tables.estimator import Estimator
from tuning_tables.held_numbers import HELD_NUMBERS, held_numbers
from tuning_tables.st_estimate import BEGIN, HAND_ON, OBSERVE_INTERFACE, TABLE_MEMBERS, WORK
from tuning_tables.st_literals import int_array, real, real_array
from tuning_tables.st_observe import OBSERVE
from tuning_tables.table_block import BlockSize
from tuning_tables.table_book import TableBook

ROWS: Final = ("BreakPath", "Drive", "Brake")

ST_NUMBERS: Final = tuple(each for each in HELD_NUMBERS if each.place is not None)
"""What an estimator holds beside the touch pressure, which every table has."""


def estimator_blanks(book: TableBook, size: BlockSize) -> Mapping[str, str]:
    """What the templates ask for about estimators; nothing much if no table has one."""
    limits = estimator_limits()
    blanks = {f"{name}_REAL": real(value) for name, value in limits.items()}
    blanks |= {name: f"{value:g}" for name, value in limits.items()}
    blanks |= {name: str(value) for name, value in alarm_bits().items()}
    blanks |= {"BREAKS": str(size.breaks), "LAST_BREAK": str(size.breaks - 1)}
    if not size.breaks:
        return {
            **blanks, "ESTIMATOR_MEMBERS": "", "SAME_ESTIMATOR": "", "LOAD_VARIABLES": "",
            "LOAD_ESTIMATOR": "    Table.Touch_kpa := 0.0;",
        }  # fmt: skip
    members = "\n".join(f"        {each.st} : REAL; (* {each.meaning} *)" for each in ST_NUMBERS)
    numbers = "\n".join(f"        Table.{each.st} := {each.st}Of[Estimator];" for each in ST_NUMBERS)
    cases = "\n".join(
        Template(_CASE).substitute(blanks, NUMBER=number) for number in range(len(distinct_estimators(book).estimators))
    )
    return {
        **blanks,
        "ESTIMATOR_MEMBERS": TABLE_MEMBERS.replace("$NUMBER_MEMBERS", members),
        "SAME_ESTIMATOR": "\n                AND (Table.Estimator = Faster.Estimator)",
        "LOAD_VARIABLES": "\n    Estimator : INT;",
        "LOAD_ESTIMATOR": Template(_LOAD).substitute(NUMBERS=numbers, CASES=textwrap.indent(cases, " " * 4)),
    }


def estimator_constants(book: TableBook, size: BlockSize) -> list[str]:
    """Declarations: number and touch pressure by table, all else by number of the estimator; none if none has one."""
    if not size.breaks:
        return []
    found = distinct_estimators(book)
    numbers = np.array([held_numbers(estimator) for estimator in found.estimators])
    declarations = [
        int_array("EstimatorOf", found.of_table),
        real_array("TouchOf", [touch_kpa(book, number) for number in range(len(book.tables))]),
        int_array("BreaksOf", [len(estimator.s_m) for estimator in found.estimators]),
    ]
    declarations += [
        real_array(f"{each.st}Of", numbers[:, place])
        for place, each in enumerate(HELD_NUMBERS)
        if each.place is not None  # the touch pressure stands by table
    ]
    for number, estimator in enumerate(found.estimators):
        for name, row in zip(ROWS, padded_work(estimator, size), strict=True):
            declarations.append(real_array(f"{name}_{number}", row))
    return declarations


def observe_blocks(blanks: Mapping[str, str]) -> list[str]:
    """RETARDER_BEGIN and RETARDER_OBSERVE, and what they need; `blanks` of the book."""
    interface = Template(OBSERVE_INTERFACE).substitute(blanks)
    if blanks["BREAKS"] == "0":
        return [BEGIN, interface + Template(HAND_ON).substitute(blanks)]
    return [BEGIN, Template(WORK).substitute(blanks), interface + Template(OBSERVE).substitute(blanks)]


def padded_work(estimator: Estimator, size: BlockSize) -> npt.NDArray[np.float32]:
    """Path, D and W at the breaks, zeros behind the last, float32 (3, breaks of `size`)."""
    work = np.zeros((3, size.breaks), dtype=np.float32)
    work[:, : estimator.work.shape[1]] = estimator.work
    return work


def touch_kpa(book: TableBook, number: int) -> np.float32:
    """The touch pressure of table `number`, 0 without estimator."""
    estimator = book.tables[number].estimator
    return np.float32(0.0 if estimator is None else estimator.touch_pressure_kpa)


_LOAD: Final = """\
    Estimator := EstimatorOf[TableNo];
    Table.Touch_kpa := TouchOf[TableNo];
    Table.Estimator := Estimator;
    Table.Breaks := 0;
    IF Estimator >= 0 THEN
        Table.Breaks := BreaksOf[Estimator];
$NUMBERS
    END_IF;
    CASE Estimator OF
$CASES
    END_CASE;"""

_CASE: Final = """\
$NUMBER:
    FOR Index := 0 TO $LAST_BREAK DO
        Table.BreakPath_m[Index] := BreakPath_$NUMBER[Index];
        Table.Drive[Index] := Drive_$NUMBER[Index];
        Table.Brake[Index] := Brake_$NUMBER[Index];
    END_FOR;"""
