"""The evaluator itself, on small programs whose results are known."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import pytest

from tests.tuning_tables.st.evaluator import Program
from tests.tuning_tables.st.storage import Fault, Frame
from tests.tuning_tables.st.syntax import (
    BINARY32,
    DOUBLE,
    FUSING,
    LONG_LITERALS,
    MATIEC,
    NO_TURN,
    ONE_TURN_TOO_MANY,
    Compiler,
)

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


def test_real_is_rounded_after_every_operation_or_at_the_assignment() -> None:
    # 1 + 2^-24 rounds to 1 in float32; in double precision the sum stays, and minus 1 leaves 2^-24.
    body = "Y := X + 5.960464478E-08 - 1.0;"
    assert run(body, x=1.0)["Y"].value == 0.0
    assert run(body, x=1.0, compiler=DOUBLE)["Y"].value == np.float32(2.0**-24)
    stepwise = "Y := X + 5.960464478E-08; Y := Y - 1.0;"
    assert run(stepwise, x=1.0, compiler=DOUBLE)["Y"].value == 0.0
    assert run("Y := X / 3.0;", x=1.0)["Y"].value.dtype == np.float32


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
