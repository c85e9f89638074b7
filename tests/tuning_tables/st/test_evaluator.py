"""The evaluator itself, on small programs whose results are known."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import pytest

from tests.tuning_tables.st.compiler import (
    BINARY32,
    COMPILERS,
    DOUBLE,
    FUSING,
    LONG_LITERALS,
    MATIEC,
    NO_TURN,
    ONE_TURN_TOO_MANY,
    Compiler,
    name_of,
)
from tests.tuning_tables.st.evaluator import Program
from tests.tuning_tables.st.storage import Fault, Frame

HEAD = "FUNCTION_BLOCK Probe VAR_INPUT I : INT; X : REAL; END_VAR VAR_OUTPUT J : INT; Y : REAL; B : BOOL; END_VAR VAR "


def run(
    body: str,
    i: npt.ArrayLike = 0,
    x: npt.ArrayLike = 0.0,
    variables: str = "",
    compiler: Compiler = BINARY32,
) -> Frame:
    """The instance after one call of a block with inputs I, X and outputs J, Y, B."""
    program = Program(f"{HEAD}{variables} END_VAR {body} END_FUNCTION_BLOCK".encode("ascii"), compiler)
    instance = program.new("Probe")
    program.call("PROBE", instance, I=i, X=x)
    return instance


def test_capitals_do_not_count_and_outputs_start_at_zero() -> None:
    instance = run("j := I;", i=7)
    assert (instance["J"].value, instance["Y"].value, instance["B"].value) == (7, 0.0, False)


@pytest.mark.parametrize(
    ("expression", "result"),
    [("2 + 3 * 4", 14), ("(2 + 3) * 4", 20), ("10 - 3 - 2", 5), ("-7 + 2", -5), ("32767 - 1", 32766)],
)
def test_whole_numbers(expression: str, result: int) -> None:
    assert run(f"J := {expression};")["J"].value == result


@pytest.mark.parametrize(
    ("expression", "result"),
    [
        ("NOT TRUE OR TRUE", True),
        ("TRUE OR TRUE AND FALSE", True),
        ("TRUE XOR TRUE", False),
        ("1 < 2 AND 2 >= 2", True),
        ("(1.5 <> 1.5) OR (2 = 3)", False),
    ],
)
def test_logic_and_precedence(expression: str, result: bool) -> None:
    assert run(f"B := {expression};")["B"].value == result


def test_real_is_rounded_after_every_operation_or_at_the_assignment() -> None:
    # 1 + 2^-24 rounds to 1 in float32; in double precision the sum stays, and minus 1 leaves 2^-24.
    body = "Y := X + 5.960464478E-08 - 1.0;"
    assert run(body, x=1.0)["Y"].value == 0.0
    assert run(body, x=1.0, compiler=DOUBLE)["Y"].value == np.float32(2.0**-24)
    stepwise = "Y := X + 5.960464478E-08; Y := Y - 1.0;"
    assert run(stepwise, x=1.0, compiler=DOUBLE)["Y"].value == 0.0
    assert run("Y := X / 3.0;", x=1.0)["Y"].value.dtype == np.float32


def test_if_takes_the_first_branch_that_holds_lane_by_lane() -> None:
    body = "IF I < 0 THEN J := 1; ELSIF I < 10 THEN J := 2; Y := 1.0; ELSE J := 3; END_IF;"
    instance = run(body, i=np.array([-5, 5, 50, 9, 10]))
    assert instance["J"].value.tolist() == [1, 2, 3, 2, 3]
    assert instance["Y"].value.tolist() == [0.0, 1.0, 0.0, 1.0, 0.0]


def test_case_with_lists_ranges_and_else() -> None:
    body = "CASE I OF 0: J := 10; 1, 3: J := 11; 5..7: J := 12; ELSE J := 13; END_CASE;"
    assert run(body, i=np.array([0, 1, 2, 3, 5, 7, 8]))["J"].value.tolist() == [10, 11, 13, 11, 12, 12, 13]


def test_case_without_a_match_does_nothing() -> None:
    assert run("J := 4; CASE I OF 1: J := 5; END_CASE;")["J"].value == 4


@pytest.mark.parametrize(
    ("loop", "total"), [("0 TO 4", 10), ("4 TO 0 BY -1", 10), ("0 TO 5 BY 2", 6), ("1 TO 0", 0), ("0 TO 1 BY -1", 0)]
)
def test_for_counts_up_and_down(loop: str, total: int) -> None:
    assert run(f"FOR K := {loop} DO J := J + K; END_FOR;", variables="K : INT;")["J"].value == total


def test_for_may_end_elsewhere_in_every_lane() -> None:
    instance = run("FOR K := 1 TO I DO J := J + K; END_FOR;", i=np.array([0, 1, 3, -2]), variables="K : INT;")
    assert instance["J"].value.tolist() == [0, 1, 6, 0]


def test_while_turns_as_often_as_its_condition_holds_in_every_lane() -> None:
    body = "K := I; WHILE K < 4 DO J := J + K; K := K + 1; END_WHILE;"
    instance = run(body, i=np.array([1, 3, 4, 9]), variables="K : INT;")
    assert instance["J"].value.tolist() == [6, 3, 0, 0]
    assert instance["K"].value.tolist() == [4, 4, 4, 9]


@pytest.mark.parametrize(
    ("compiler", "turns"),
    [(BINARY32, [3, 2, 1, 0, 0]), (NO_TURN, [3, 2, 0, 0, 0]), (ONE_TURN_TOO_MANY, [3, 2, 1, 1, 1])],
    ids=["binary32", "none at equal ends", "one beyond the end"],
)
@pytest.mark.parametrize("loop", ["I TO 2", "2 TO I BY -1"], ids=["up", "down"])
def test_compilers_differ_in_a_for_of_one_turn_or_none(loop: str, compiler: Compiler, turns: list[int]) -> None:
    body = f"FOR K := {loop} DO J := J + 1; END_FOR;"
    found = run(body, i=np.array([0, 1, 2, 3, 9]), variables="K : INT;", compiler=compiler)
    assert found["J"].value.tolist() == turns


@pytest.mark.parametrize("compiler", COMPILERS, ids=name_of)
def test_compilers_agree_in_a_for_of_two_turns_or_more_and_in_a_while(compiler: Compiler) -> None:
    body = "FOR K := 1 TO 2 DO J := J + 1; END_FOR; FOR K := 5 TO 0 BY -2 DO J := J + 1; END_FOR;"
    body += "WHILE J < 5 DO J := 9; END_WHILE;"
    assert run(body, variables="K : INT;", compiler=compiler)["J"].value == 5


@pytest.mark.parametrize(
    ("compiler", "bare"),
    [(BINARY32, True), (FUSING, True), (DOUBLE, False), (LONG_LITERALS, False), (MATIEC, False)],
    ids=["binary32", "fusing", "double", "LREAL literals", "MATIEC"],
)
def test_compilers_differ_in_a_bare_literal_that_is_compared(compiler: Compiler, bare: bool) -> None:
    """0.2 to ten digits is read as REAL, or stays beside the REAL that is nearest to it."""
    assert run("B := X = 2.000000030E-01;", x=0.2, compiler=compiler)["B"].value == bare
    constant = "END_VAR VAR CONSTANT Fifth : REAL := 2.000000030E-01;"
    assert run("B := X = Fifth;", x=0.2, variables=constant, compiler=compiler)["B"].value
    assert run("B := X = 0.25;", x=0.25, compiler=compiler)["B"].value


def test_what_a_long_literal_takes_part_in_is_rounded_when_it_is_assigned() -> None:
    # X + 2^-24 stays above 1 in double, and is 1 in binary32; among REALs nothing is computed in double.
    body = "B := X + 5.960464478E-08 > 1.0; Y := X + 5.960464478E-08;"
    for compiler, above in ((BINARY32, False), (LONG_LITERALS, True)):
        found = run(body, x=1.0, compiler=compiler)
        assert (found["B"].value, found["Y"].value, found["Y"].value.dtype) == (above, 1.0, np.float32)
    least = "END_VAR VAR CONSTANT Least : REAL := 5.960464478E-08;"
    assert not run("B := X + Least > X;", x=1.0, variables=least, compiler=LONG_LITERALS)["B"].value
    assert run("B := X + Least > X;", x=1.0, variables=least, compiler=DOUBLE)["B"].value


@pytest.mark.parametrize("text", ["X * X - 1.0", "(X * X) - 1.0", "-1.0 + X * X"])
def test_a_product_in_a_sum_is_fused_and_one_in_a_statement_of_its_own_is_not(text: str) -> None:
    # (1 + 2^-12)^2 = 1 + 2^-11 + 2^-24, whose last digit is lost where the product is rounded.
    x = 1.0 + 2.0**-12
    for compiler, result in ((BINARY32, 2.0**-11), (FUSING, 2.0**-11 + 2.0**-24)):
        assert run(f"Y := {text};", x=x, compiler=compiler)["Y"].value == result
    assert run("Y := X * X; Y := Y - 1.0;", x=x, compiler=FUSING)["Y"].value == 2.0**-11
    assert run("Y := 1.0 - X * X;", x=x, compiler=FUSING)["Y"].value == -(2.0**-11 + 2.0**-24)


def test_arrays_have_initial_values_bounds_and_a_value_a_lane() -> None:
    variables = "A : ARRAY[-1..2] OF REAL := [1.5, -2.5, 3.0, 4.0]; N : ARRAY[0..1] OF INT;"
    instance = run("Y := A[I]; N[1] := I; A[I] := 9.0; J := N[1] + N[0];", i=np.array([-1, 2, 0]), variables=variables)
    assert instance["Y"].value.tolist() == [1.5, 4.0, -2.5]
    assert instance["J"].value.tolist() == [-1, 2, 0]
    assert instance["A"].data.tolist() == [[9.0, -2.5, 3.0, 4.0], [1.5, -2.5, 3.0, 9.0], [1.5, 9.0, 3.0, 4.0]]


def test_a_block_keeps_its_variables_and_writes_to_what_it_is_handed() -> None:
    text = b"""
    TYPE Pair : STRUCT First : INT; Twice : ARRAY[0..1] OF INT; END_STRUCT; END_TYPE
    FUNCTION_BLOCK Adder
    VAR_INPUT Step : INT; END_VAR VAR_IN_OUT Sum : Pair; END_VAR VAR_OUTPUT Calls : INT; END_VAR
    Calls := Calls + 1; Sum.First := Sum.First + Step; Sum.Twice[1] := 2 * Sum.First;
    END_FUNCTION_BLOCK
    FUNCTION_BLOCK User
    VAR_INPUT I : INT; END_VAR VAR_OUTPUT J, Calls : INT; END_VAR VAR A : Adder; S : Pair; END_VAR
    A(Step := I, Sum := S); A(Step := 10, Sum := S);
    IF I > 1 THEN A(Step := 100, Sum := S); END_IF;
    J := S.Twice[1]; Calls := A.Calls;
    END_FUNCTION_BLOCK"""
    program = Program(text)
    user = program.new("User")
    program.call("User", user, I=np.array([1, 2]))
    assert user["J"].value.tolist() == [22, 224]
    assert user["CALLS"].value.tolist() == [2, 3]


def test_nan_fails_every_comparison_but_one() -> None:
    body = "IF X >= 0.0 THEN J := J + 1; END_IF; IF X <= 0.0 THEN J := J + 2; END_IF; B := X <> X;"
    instance = run(body, x=np.array([np.nan, 1.0, -np.inf]))
    assert instance["J"].value.tolist() == [0, 1, 2]
    assert instance["B"].value.tolist() == [True, False, False]


@pytest.mark.parametrize(
    ("body", "variables", "reason"),
    [
        ("J := I + 32767;", "", "INT"),
        ("J := -32768 - I;", "", "INT"),
        ("J := 40000;", "", "is no INT"),
        ("J := A[I + 3];", "A : ARRAY[0..3] OF INT;", "leaves"),
        ("A[I - 2] := 1;", "A : ARRAY[0..3] OF INT;", "leaves"),
        ("Y := X / 0.0;", "", "no REAL result"),
        ("Y := 3.0E+38 + 3.0E+38;", "", "no REAL result"),
        ("J := X;", "", "is REAL, not INT"),
        ("Y := X + 1;", "", "mixes"),
        ("IF I THEN J := 1; END_IF;", "", "is INT, not BOOL"),
        ("K := 1;", "", "not declared"),
        ("I := 1;", "", "assigned to"),
        ("REPEAT J := 1; UNTIL B END_REPEAT;", "", "not understood"),
        ("WHILE J < 3 DO Y := 1.0; END_WHILE;", "", "does not end"),
        ("RETURN;", "", "not understood"),
        ("J := 1;", "j : INT;", "declared twice"),
        ("J := 1;", "A : ARRAY[0..3] OF INT := [1, 2, 3];", "3 values"),
        ("J := 1;", "A : ARRAY[0..1] OF INT := [1, 2.5];", "is REAL"),
        ("J := ;", "", "no Structured Text"),
        ("J := 1", "", "no Structured Text"),
    ],
)
def test_what_a_controller_would_trap_or_refuse_is_a_fault(body: str, variables: str, reason: str) -> None:
    with pytest.raises(Fault, match=reason):
        run(body, i=1, variables=variables)


def test_a_constant_cannot_be_assigned() -> None:
    text = b"FUNCTION_BLOCK F VAR CONSTANT A : ARRAY[0..1] OF INT := [1, 2]; END_VAR A[0] := 3; END_FUNCTION_BLOCK"
    with pytest.raises(Fault, match="A is a constant"):
        Program(text)


def test_a_fault_in_a_lane_that_is_not_executed_is_none() -> None:
    body = "IF I < 4 THEN J := A[I]; END_IF; IF X > 0.0 THEN Y := 1.0 / X; END_IF;"
    instance = run(
        body, i=np.array([0, 9]), x=np.array([0.0, 2.0]), variables="A : ARRAY[0..3] OF INT := [5, 6, 7, 8];"
    )
    assert instance["J"].value.tolist() == [5, 0]
    assert instance["Y"].value.tolist() == [0.0, 0.5]


def test_both_sides_of_and_are_evaluated() -> None:
    with pytest.raises(Fault, match="leaves"):
        run("B := (I < 4) AND (A[I] > 0);", i=9, variables="A : ARRAY[0..3] OF INT;")
