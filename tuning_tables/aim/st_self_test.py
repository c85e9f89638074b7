"""The Structured Text self-test of aim tables: a block for every table, one for the choice, one that runs all.

Only questions that have a portable literal are in it: no NaN, no infinity, no denormal number.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from string import Template
from typing import Final

import numpy as np

from tuning_tables.aim.aim_table import AimTable
from tuning_tables.aim.aim_tables import AimTables
from tuning_tables.aim.block import controller_speeds
from tuning_tables.aim.golden_aims import GoldenAims, golden_selections
from tuning_tables.category_names import comment_text
from tuning_tables.st_literals import LONGEST_ARRAY, bool_array, constants, int_array, is_portable, real_array
from tuning_tables.st_loops import without_single_turns

SELF_TEST_HEAD: Final = """\
(* Self-test of aim_table.st, for the controller that is to run it. Generated: do not edit, export again.

   Call one instance of AIM_SELF_TEST once a cycle until Done; Failed must be 0. It compares every constant with a
   second copy, and the answers of AIM_EXIT_SPEED and AIM_SELECT with those of the reference implementation. Questions
   that are not finite or denormal are left out, because they have no portable literal. *)
"""

TABLE_HEAD: Final = """\
FUNCTION_BLOCK AIM_TEST_$NUMBER
(* Table $NUMBER, $NAME: its axes, $NODES nodes and $QUESTIONS questions. *)
VAR_OUTPUT
    Failed : INT; (* numbers that are wrong *)
    FirstFailed : INT; (* the first of them: 0 the axes, then nodes, then questions; -1: none *)
END_VAR
VAR
    Loader : AIM_LOAD;
    Axes : AIM_AXES;
    Asker : AIM_EXIT_SPEED;
    Index : INT;
    Distance : INT;
    Resistance : INT;
    Agrees : BOOL;
END_VAR
"""

RESET: Final = """\
Failed := 0;
FirstFailed := -1;
"""

AXES: Final = """\
Loader(TableNo := $NUMBER, Axes := Axes);
Agrees := (Axes.Listed = $LISTED) AND (Axes.Distances = $DISTANCES) AND (Axes.Resistances = $RESISTANCES);
FOR Index := 0 TO $LAST_CARS DO
    IF Axes.Cars[Index] <> CarsAxis[Index] THEN
        Agrees := FALSE;
    END_IF;
END_FOR;
FOR Index := 0 TO $LAST_DISTANCE DO
    IF Axes.Distance_m[Index] <> DistanceAxis[Index] THEN
        Agrees := FALSE;
    END_IF;
END_FOR;
"""

RESISTANCE_AXIS: Final = """\
FOR Index := 0 TO $LAST_RESISTANCE DO
    IF Axes.Resistance[Index] <> ResistanceAxis[Index] THEN
        Agrees := FALSE;
    END_IF;
END_FOR;
"""

AXES_FOOT: Final = """\
IF NOT Agrees THEN
    Failed := 1;
    FirstFailed := 0;
END_IF;
"""

NODES: Final = """\
FOR Distance := 0 TO $LAST_DISTANCE DO
    FOR Resistance := 0 TO $LAST_RESISTANCE DO
        Index := Distance * $STRIDE + Resistance;
        Asker(TableNo := $NUMBER, Cars := CarsAxis[$ROW], FreeDistance_m := DistanceAxis[Distance],
            Resistance := ResistanceAxis[Resistance]);
        IF Asker.ExitSpeed_m_s <> Expected_$ROW[Index] THEN
            IF Failed = 0 THEN
                FirstFailed := Index + $FIRST;
            END_IF;
            Failed := Failed + 1;
        END_IF;
    END_FOR;
END_FOR;
"""

QUESTIONS: Final = """\
FOR Index := 0 TO $LAST DO
    Asker(TableNo := $NUMBER, Cars := Cars_$PART[Index], FreeDistance_m := Distance_$PART[Index],
        Resistance := Resistance_$PART[Index]);
    IF Asker.ExitSpeed_m_s <> Answer_$PART[Index] THEN
        IF Failed = 0 THEN
            FirstFailed := Index + $FIRST;
        END_IF;
        Failed := Failed + 1;
    END_IF;
END_FOR;
"""

FOOT: Final = "END_FUNCTION_BLOCK\n"

SELECTIONS: Final = """\
FOR Index := 0 TO $LAST DO
    Selector(Category := Category[Index], Measured := Measured[Index]);
    IF Selector.TableNo <> TableNo[Index] THEN
        IF Failed = 0 THEN
            FirstFailed := Index;
        END_IF;
        Failed := Failed + 1;
    END_IF;
END_FOR;
"""

SELECTIONS_HEAD: Final = """\
FUNCTION_BLOCK AIM_TEST_SELECTIONS
(* $SELECTIONS selections. *)
VAR_OUTPUT
    Failed : INT; (* selections that are wrong *)
    FirstFailed : INT; (* the first of them, -1: none *)
END_VAR
VAR
    Selector : AIM_SELECT;
    Index : INT;
END_VAR
"""

RUN_ALL: Final = """\
FUNCTION_BLOCK AIM_SELF_TEST
(* Call it once a cycle until Done: each call tests one table, the last one the choice. *)
VAR_INPUT
    Restart : BOOL; (* begin again *)
END_VAR
VAR_OUTPUT
    Done : BOOL;
    Failed : INT; (* blocks in which something is wrong; 0 when Done: all is as exported *)
    FirstFailed : INT; (* the first of them: number of the table, $TABLES the choice; -1: none *)
    FirstFault : INT; (* FirstFailed of that block *)
END_VAR
VAR
    Selections : AIM_TEST_SELECTIONS;
$INSTANCES
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
    CASE Number OF
$CASES
        $TABLES:
            Selections();
            Faults := Selections.Failed;
            Fault := Selections.FirstFailed;
    END_CASE;
    IF Faults > 0 THEN
        IF Failed = 0 THEN
            FirstFailed := Number;
            FirstFault := Fault;
        END_IF;
        Failed := Failed + 1;
    END_IF;
    Done := Number >= $TABLES;
    Number := Number + 1;
END_IF;
END_FUNCTION_BLOCK
"""

RUN_ONE: Final = """\
        $NUMBER:
            Test_$NUMBER();
            Faults := Test_$NUMBER.Failed;
            Fault := Test_$NUMBER.FirstFailed;"""


def aim_self_test_blocks(aims: AimTables, ask: Callable[[AimTable], GoldenAims]) -> Iterator[str]:
    """The blocks of aim_self_test.st, in an order in which none is used before it is declared."""
    for number, table in enumerate(aims.tables):
        yield without_single_turns(_table_test(table, number, ask(table)))
    yield without_single_turns(_selection_test(aims))
    count = len(aims.tables)
    yield Template(RUN_ALL).substitute(
        TABLES=count,
        INSTANCES="\n".join(f"    Test_{number} : AIM_TEST_{number};" for number in range(count)),
        CASES="\n".join(Template(RUN_ONE).substitute(NUMBER=number) for number in range(count)),
    )


def _table_test(table: AimTable, number: int, golden: GoldenAims) -> str:
    """AIM_TEST_n: axes and nodes once more, and golden questions."""
    listed, distances, resistances = table.speed_nodes.shape
    kept = np.flatnonzero(is_portable(golden.free_distance_m) & is_portable(golden.resistance_n_per_kn))
    sizes = {
        "NUMBER": number,
        "LISTED": listed,
        "DISTANCES": distances,
        "RESISTANCES": resistances * table.is_measured,
        "LAST_CARS": listed - 1,
        "LAST_DISTANCE": distances - 1,
        "LAST_RESISTANCE": resistances - 1,
        "STRIDE": resistances,
    }
    declarations = [
        int_array("CarsAxis", table.axes.cars),
        real_array("DistanceAxis", table.distance_nodes),
        real_array("ResistanceAxis", table.resistance_nodes),
    ]
    statements = [Template(AXES + (RESISTANCE_AXIS if table.is_measured else "")).substitute(sizes), AXES_FOOT]
    for row, speeds in enumerate(controller_speeds(table)):
        declarations.append(real_array(f"Expected_{row}", speeds.ravel(), resistances))
        statements.append(Template(NODES).substitute(sizes, ROW=row, FIRST=1 + row * speeds.size))
    for part, start in enumerate(range(0, len(kept), LONGEST_ARRAY)):
        chosen = kept[start : start + LONGEST_ARRAY]
        declarations += [
            int_array(f"Cars_{part}", golden.cars[chosen]),
            real_array(f"Distance_{part}", golden.free_distance_m[chosen]),
            real_array(f"Resistance_{part}", golden.resistance_n_per_kn[chosen]),
            real_array(f"Answer_{part}", golden.exit_speed_m_s[chosen]),
        ]
        first = 1 + table.speed_nodes.size + start
        statements.append(Template(QUESTIONS).substitute(NUMBER=number, PART=part, LAST=len(chosen) - 1, FIRST=first))
    told = {"NAME": comment_text(table.id), "NODES": table.speed_nodes.size, "QUESTIONS": len(kept)}
    head = Template(TABLE_HEAD).substitute(told, NUMBER=number)
    return "".join([head, constants(declarations), RESET, *statements, FOOT])


def _selection_test(aims: AimTables) -> str:
    """AIM_TEST_SELECTIONS: golden selections."""
    selections = golden_selections(aims)
    declarations = [
        int_array("Category", [category for category, _, _ in selections]),
        bool_array("Measured", [measured for _, measured, _ in selections]),
        int_array("TableNo", [number for _, _, number in selections]),
    ]
    head = Template(SELECTIONS_HEAD).substitute(SELECTIONS=len(selections))
    loop = Template(SELECTIONS).substitute(LAST=len(selections) - 1)
    return "".join([head, constants(declarations), RESET, loop, FOOT])
