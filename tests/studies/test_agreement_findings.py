"""What the studies of compiled controllers call a fault."""

from __future__ import annotations

from scripts.studies.in_the_loop.agreement import Differences
from scripts.studies.in_the_loop.agreement_study import Agreement, Row
from scripts.studies.in_the_loop.loop_study import InTheLoop
from scripts.studies.in_the_loop.loop_study import Row as TableRow

SAME = Differences(0, 0, 0, 0, "fault 0 at 0")


def agreement(*rows: Row) -> Agreement:
    return Agreement(15, 15, 1000, 20, 100, 1, rows)


def test_what_is_left_out_is_no_fault_but_nothing_at_all_is() -> None:
    left_out = Row("clang -O0", ("clang",), None)
    found = agreement(Row("gcc -O0", (), SAME), left_out)
    assert found.faults() == ()
    assert found.sentences()[1] == "1 of 1 ways of compiling agree in everything; 1 left out"
    assert found.tables()["agreement"].rows[1] == ("clang -O0", "–", "–", "–", "–", "not run: no clang")
    assert "no compiler is installed" in agreement(left_out).faults()[0]


def test_every_kind_of_difference_is_a_fault() -> None:
    wrong = [
        Differences(1, 0, 0, 0, "fault 0 at 0"),
        Differences(0, 1, 0, 0, "fault 0 at 0"),
        Differences(0, 0, 1, 0, "fault 0 at 0"),
        Differences(0, 0, 0, 1, "fault 0 at 0"),
        Differences(0, 0, 0, 0, "fault 3 at 7"),
    ]
    for each in wrong:
        assert agreement(Row("gcc -O0", (), SAME), Row("gcc -O1", (), each)).faults() == ("gcc -O1 answers otherwise",)


def test_a_pass_that_differs_is_a_fault() -> None:
    same, other = TableRow("a", False, 500, 0, 0.02), TableRow("b", True, 500, 2, 0.02)
    assert InTheLoop(("0", "1"), 1, "gcc -O2", (same,)).faults() == ()
    found = InTheLoop(("0", "1"), 1, "gcc -O2", (same, other))
    assert found.faults() == ("2 passes differ",)
    assert found.sentences() == ("2 of 1000 passes differ (gcc -O2), seed 1",)
