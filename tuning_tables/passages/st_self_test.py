"""The Structured Text self-test of tables for point sensors: a block a table, and one that runs them, one a cycle.

Only rows that have a portable literal are in it: no NaN, no infinity, no denormal number.
"""

from __future__ import annotations

from collections.abc import Iterator
from string import Template
from typing import Final

import numpy as np
import numpy.typing as npt

from tuning_tables.category_names import comment_text
from tuning_tables.passages.c_source import Ask
from tuning_tables.passages.golden_pulses import WHOLE
from tuning_tables.passages.golden_selections import golden_selections
from tuning_tables.passages.passage_block import PassageBlockSize, passage_block_size
from tuning_tables.passages.passage_book import PassageBook
from tuning_tables.passages.passage_table import PassageTable
from tuning_tables.passages.st_members import COUNTS, NUMBERS, arrays_of, counts_of, numbers_of, parts_of
from tuning_tables.passages.st_select import CHOICE_ASKED, CHOICE_HEAD
from tuning_tables.st_literals import constants, int_array, is_portable, real_array, real_constant
from tuning_tables.st_loops import without_single_turns

SELF_TEST_HEAD: Final = """\
(* Self-test of retarder_passages.st, for the controller that is to run it. Generated: do not edit, export again.

   Call one instance of RETARDER_PASSAGES_SELF_TEST once a cycle until Done; Failed must be 0. It compares every
   constant with a second copy, and what RETARDER_WANTED_STAGE, RETARDER_BELIEVED_PASSAGE and RETARDER_AT_PULSE do with
   what the reference implementation does. Questions that are not finite or denormal are left out, because they have no
   portable literal. Remove the blocks after the test if memory is short. *)
"""

TEST_HEAD: Final = """\
FUNCTION_BLOCK RETARDER_PASSAGES_TEST_$NUMBER
(* Table $NUMBER, $NAME: all constants, then $STAGE_ROWS stages, $PAIR_ROWS pairs and $PULSE_ROWS pulses. *)
VAR_IN_OUT
    Table : RETARDER_PASSAGE_TABLE; (* as RETARDER_LOAD_PASSAGES gives it for TableNo $NUMBER *)
END_VAR
VAR_OUTPUT
    Failed : INT; (* groups of constants, and rows, that are wrong *)
    FirstFailed : INT; (* the first of them, counted from 0 in this order, -1: none *)
END_VAR
VAR
    Wanter : RETARDER_WANTED_STAGE;
    Believer : RETARDER_BELIEVED_PASSAGE;
    Stepper : RETARDER_AT_PULSE;
    Tracker : RETARDER_TRACKER;
    Index : INT;
    Number : INT;
    Agrees : BOOL;
END_VAR
"""

TEST_BEGIN: Final = """\
Failed := 0;
FirstFailed := -1;
Number := 0;
"""

TOLD: Final = """\
${INDENT}IF NOT Agrees THEN
$INDENT    IF Failed = 0 THEN
$INDENT        FirstFailed := Number;
$INDENT    END_IF;
$INDENT    Failed := Failed + 1;
${INDENT}END_IF;
${INDENT}Number := Number + 1;
"""

STAGE_ASKED: Final = """\
    Wanter(Passage := Stage_passage_$PART[Index], Stage := Stage_stage_$PART[Index],
        Speed_m_s := Stage_v_m_s_$PART[Index], Table := Table);
    Agrees := Wanter.Wanted = Stage_answer_$PART[Index];
"""

BEFORE: Final = """\
    Tracker.Passage := $KIND_passage_$PART[Index];
    Tracker.Speed_m_s := $KIND_v_m_s_$PART[Index];
    Tracker.Time_s := $KIND_time_s_$PART[Index];
    Tracker.Rival := $KIND_rival_$PART[Index];
    Tracker.RivalSpeed_m_s := $KIND_rival_m_s_$PART[Index];
    Tracker.RivalTime_s := $KIND_rival_s_$PART[Index];
"""

PAIR_ASKED: Final = """\
    Believer(Sensor := Pair_sensor_$PART[Index], Since_s := Pair_since_s_$PART[Index],
        Speed_m_s := Pair_reading_m_s_$PART[Index], Table := Table, Tracker := Tracker);
    Agrees := Believer.Passage = Pair_answer_$PART[Index];
"""

PULSE_ASKED: Final = """\
    Stepper(Sensor := Pulse_sensor_$PART[Index], Since_s := Pulse_since_s_$PART[Index],
        OverBase_s := Pulse_over_base_s_$PART[Index], Stage := Pulse_stage_$PART[Index],
        TransientEnded := Pulse_ended_$PART[Index] = 1, Table := Table, Tracker := Tracker);
    Agrees := Stepper.Command = Pulse_answer_$PART[Index];
"""

AFTER: Final = """\
    Agrees := Agrees AND (Tracker.Passage = $KIND_new_passage_$PART[Index])
        AND (Tracker.Speed_m_s = $KIND_new_v_m_s_$PART[Index])
        AND (Tracker.Time_s = $KIND_new_time_s_$PART[Index])
        AND (Tracker.Rival = $KIND_new_rival_$PART[Index])
        AND (Tracker.RivalSpeed_m_s = $KIND_new_rival_m_s_$PART[Index])
        AND (Tracker.RivalTime_s = $KIND_new_rival_s_$PART[Index]);
"""

RUN_ALL: Final = """\
FUNCTION_BLOCK RETARDER_PASSAGES_SELF_TEST
(* Call it once a cycle until Done: each call tests one table, the last one the choice. *)
VAR_INPUT
    Restart : BOOL; (* begin again *)
END_VAR
VAR_OUTPUT
    Done : BOOL;
    Failed : INT; (* blocks in which something is wrong; 0 when Done: all is as exported *)
    FirstFailed : INT; (* the first of them, $LAST the choice; -1: none *)
    FirstFault : INT; (* FirstFailed of that block *)
END_VAR
VAR
    Loader : RETARDER_LOAD_PASSAGES;
    Choices : RETARDER_PASSAGES_CHOICES;
$INSTANCES
    Table : RETARDER_PASSAGE_TABLE;
    Number : INT;
    Begun : BOOL;
    Faults : INT;
    Fault : INT;
END_VAR

IF Restart OR NOT Begun THEN
    Begun := TRUE;
    Done := FALSE;
    Number := 0;
    Failed := 0;
    FirstFailed := -1;
    FirstFault := -1;
END_IF;
IF NOT Done THEN
    Faults := 0;
    Fault := -1;
    Loader(TableNo := Number, Table := Table);
    CASE Number OF
$CASES
        $LAST:
            Choices();
            Faults := Choices.Failed;
            Fault := Choices.FirstFailed;
    END_CASE;
    IF Faults > 0 THEN
        IF Failed = 0 THEN
            FirstFailed := Number;
            FirstFault := Fault;
        END_IF;
        Failed := Failed + 1;
    END_IF;
    Done := Number >= $LAST;
    Number := Number + 1;
END_IF;
END_FUNCTION_BLOCK
"""

RUN_ONE: Final = """\
        $NUMBER:
            Test_$NUMBER(Table := Table);
            Faults := Test_$NUMBER.Failed;
            Fault := Test_$NUMBER.FirstFailed;"""


def self_test_blocks(book: PassageBook, ask: Ask) -> Iterator[str]:
    """The blocks of the self-test, in an order in which none is used before it is declared."""
    tables, size = book.tables, passage_block_size(book.tables)
    for number, table in enumerate(tables):
        yield without_single_turns(_table_test(number, table, size, ask))
    yield without_single_turns(_choice_test(book))
    yield Template(RUN_ALL).substitute(
        INSTANCES="\n".join(f"    Test_{number} : RETARDER_PASSAGES_TEST_{number};" for number in range(len(tables))),
        CASES="\n".join(Template(RUN_ONE).substitute(NUMBER=number) for number in range(len(tables))),
        LAST=len(tables),
    )


def _table_test(number: int, table: PassageTable, size: PassageBlockSize, ask: Ask) -> str:
    """RETARDER_PASSAGES_TEST_n: the constants of the table once more, and its golden rows."""
    golden = ask(table)
    kinds = {"Stage": golden.stages, "Pair": golden.pairs, "Pulse": golden.pulses}
    kept = {kind: rows[_portable(rows)] for kind, rows in kinds.items()}
    same_numbers, same = _same_constants(table)
    declarations, statements = [*same_numbers], [TEST_BEGIN, same]
    for member, values in arrays_of(table, size):
        for part, start, piece in parts_of(values):
            name = f"Expected_{member}_{part}"
            declarations.append((int_array if values.dtype == np.int64 else real_array)(name, piece))
            place = f"Index + {start}" if start else "Index"
            asked = f"    Agrees := Table.{member}[{place}] = {name}[Index];\n"
            statements.append(_loop(len(piece), asked))
    asked_of = {"Stage": STAGE_ASKED, "Pair": BEFORE + PAIR_ASKED + AFTER, "Pulse": BEFORE + PULSE_ASKED + AFTER}
    for kind, rows in kept.items():
        for part, _, piece in parts_of(rows):
            for name in rows.dtype.names or ():
                array = int_array if name in WHOLE else real_array
                declarations.append(array(f"{kind}_{name}_{part}", piece[name]))
            asked = asked_of[kind].replace("$KIND", kind).replace("$PART", str(part))
            statements.append(_loop(len(piece), asked))
    head = Template(TEST_HEAD).substitute(
        NUMBER=number,
        NAME=comment_text(table.id),
        **{f"{kind.upper()}_ROWS": len(rows) for kind, rows in kept.items()},
    )
    return "".join([head, constants(declarations), *statements, "END_FUNCTION_BLOCK\n"])


def _choice_test(book: PassageBook) -> str:
    """RETARDER_PASSAGES_CHOICES: golden choices by status and target."""
    rows = golden_selections(book)
    kept = [row for row in rows if is_portable(np.array([row.commanded_m_s]))[0]]
    targets = [0.0 if row.status < 0 else book.tables[row.table].target_speed_m_s for row in kept]
    columns = {
        "Category": np.array([row.category for row in kept]),
        "Axles": np.array([row.axles for row in kept]),
        "Commanded": np.array([row.commanded_m_s for row in kept], dtype=np.float32),
        "Status": np.array([int(row.status) for row in kept]),
        "Target": np.array(targets, dtype=np.float32),
    }
    declarations, statements = [], []
    for name, values in columns.items():
        for part, _, piece in parts_of(values):
            declarations.append((int_array if values.dtype == np.int64 else real_array)(f"{name}_{part}", piece))
    for part, _, piece in parts_of(columns["Axles"]):
        statements.append(_loop(len(piece), CHOICE_ASKED.replace("$PART", str(part))))
    head = Template(CHOICE_HEAD).substitute(CHOICES=len(kept))
    return "".join([head, constants(declarations), TEST_BEGIN, *statements, "END_FUNCTION_BLOCK\n"])


def _same_constants(table: PassageTable) -> tuple[list[str], str]:
    """Declarations and test whether the single numbers of the table are those that they should be: one group."""
    expected = [real_constant(f"Expected_{name}", v) for name, v in zip(NUMBERS, numbers_of(table), strict=True)]
    equal = [f"(Table.{name} = Expected_{name})" for name in NUMBERS]
    equal += [f"(Table.{name} = {v})" for name, v in zip(COUNTS, counts_of(table), strict=True)]
    same = "\n    AND ".join(equal)
    return expected, f"Agrees := {same};\n{_told('')}"


def _loop(count: int, asked: str) -> str:
    return f"FOR Index := 0 TO {count - 1} DO\n{asked}{_told('    ')}END_FOR;\n"


def _told(indent: str) -> str:
    return Template(TOLD).substitute(INDENT=indent)


def _portable(rows: npt.NDArray[np.void]) -> npt.NDArray[np.bool_]:
    """Which rows have a literal in every language."""
    names = [name for name in rows.dtype.names or () if name not in WHOLE]
    portable: npt.NDArray[np.bool_] = np.logical_and.reduce([is_portable(rows[name]) for name in names])
    return portable
