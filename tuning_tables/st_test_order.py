"""RETARDER_SELF_TEST, which runs all blocks of the Structured Text self-test, one a cycle."""

from __future__ import annotations

from string import Template
from typing import Final

from tuning_tables.distinct_estimators import distinct_estimators
from tuning_tables.table_book import TableBook

RUN_ALL: Final = """\
FUNCTION_BLOCK RETARDER_SELF_TEST
(* Call it once a cycle until Done: each call tests one table, then the choice, then one estimator after the other. *)
VAR_INPUT
    Restart : BOOL; (* begin again *)
END_VAR
VAR_OUTPUT
    Done : BOOL;
    Failed : INT; (* blocks in which something is wrong; 0 when Done: all is as exported *)
    FirstFailed : INT; (* the first of them: number of the table, $TABLES the choice, then the estimators; -1: none *)
    FirstFault : INT; (* FirstFailed of that block *)
END_VAR
VAR
    Loader : RETARDER_LOAD;
    Choices : RETARDER_TEST_CHOICES;
$INSTANCES
    Table : RETARDER_TABLE;
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
        $TABLES:
            Choices();
            Faults := Choices.Failed;
            Fault := Choices.FirstFailed;
$ESTIMATORS
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

RUN_ESTIMATOR: Final = """\
        $NUMBER:
            Loader(TableNo := $TABLE, Table := Table);
            Estimator_$PLACE(Table := Table);
            Faults := Estimator_$PLACE.Failed;
            Fault := Estimator_$PLACE.FirstFailed;"""


def run_all(book: TableBook) -> str:
    """The block: tables by their numbers, then the choice, then the estimators in the order of their first tables."""
    tables, estimators = len(book.tables), distinct_estimators(book).first_tables
    instances = [f"    Test_{number} : RETARDER_TEST_{number};" for number in range(tables)]
    instances += [f"    Estimator_{place} : RETARDER_TEST_ESTIMATOR_{place};" for place in range(len(estimators))]
    return Template(RUN_ALL).substitute(
        INSTANCES="\n".join(instances),
        CASES="\n".join(Template(RUN_ONE).substitute(NUMBER=number) for number in range(tables)),
        ESTIMATORS="\n".join(
            Template(RUN_ESTIMATOR).substitute(NUMBER=tables + 1 + place, PLACE=place, TABLE=number)
            for place, number in enumerate(estimators)
        ),
        TABLES=tables,
        LAST=tables + len(estimators),
    )
