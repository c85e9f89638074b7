"""Each check passes on a sound book, fails on one with a fault, and says why it could not be made."""

from __future__ import annotations

import json
import os
import platform
import shutil
import subprocess
import sys
import time
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import psutil
import pytest

from synth.cli.qualification import any_time, structured_text
from synth.cli.qualification.any_time import any_time_checks, any_time_tables
from synth.cli.qualification.c_code import COMPILERS, c_checks, compiler_check, fault_check, self_test
from synth.cli.qualification.check import Outcome, Ran, process
from synth.cli.qualification.golden import (
    ELSEWHERE,
    LIBRARIES,
    golden_check,
    golden_of,
    kept,
    plain_checks,
    tune_checks,
)
from synth.cli.qualification.second_program import (
    CODE,
    loop_check,
    planted,
    planted_checks,
    prediction_check,
    verify_check,
    with_other_number,
)
from synth.cli.qualification.tuned import ESTIMATED, KINDS, MEASURED, Tuned
from tuning_tables import Decisions, Status, TableBook, from_json

Books = Mapping[str, Tuned]
FAILED = Tuned(ESTIMATED, Path("nowhere"), Ran(70, "", "a fault"), {})


def with_rms(book: Tuned, factor: float) -> Tuned:
    """A book whose table predicts another rms."""
    name, content = next(iter(book.tables.items()))
    document = json.loads(content)
    document["predicted"]["rms_m_s"] *= factor
    return replace(book, content={**book.content, name: json.dumps(document).encode()})


@pytest.mark.parametrize("kind", KINDS)
def test_the_kept_bytes_are_those_that_are_made(books: Books, kind: str) -> None:
    """Who changes tables on purpose runs `tests.qualification.keep`. Only processors of x86 are kept."""
    check = golden_check(books[kind], kept()[kind])
    assert check.outcome is Outcome.PASSED, check.found
    if platform.machine() == "x86_64":
        assert check.found.startswith("the bytes of processors"), f"{check.found}; python -m tests.qualification.keep"


def test_the_kept_bytes_were_made_with_the_libraries_of_the_lock() -> None:
    lock = (Path(__file__).parents[2] / "requirements.lock").read_text(encoding="utf-8").splitlines()
    made_with = next(iter(kept().values())).made_with
    assert {f"{name}=={made_with[name]} \\" for name in LIBRARIES} <= {*lock}


@pytest.mark.parametrize(
    ("factor", "library", "outcome"),
    [(0.5, "numpy", Outcome.PASSED), (1.5, "numpy", Outcome.FAILED), (0.5, "", Outcome.FAILED)],
)
def test_other_bytes_pass_with_other_libraries_alone_and_near_the_figures(
    books: Books, factor: float, library: str, outcome: Outcome
) -> None:
    book = books[MEASURED]
    kept_here = golden_of(book)
    made_with = {name: "0.1" if name == library else value for name, value in kept_here.made_with.items()}
    golden = replace(kept_here, made_with=made_with)
    check = golden_check(with_rms(book, 1.0 + factor * ELSEWHERE), golden)
    assert check.outcome is outcome
    assert "other bytes" in check.found
    assert library in check.limit


def test_the_version_that_wrote_a_table_changes_no_hash(books: Books) -> None:
    book = books[MEASURED]
    name, content = next(iter(book.tables.items()))
    document = json.loads(content)
    document["generator"]["version"] = "9.9"
    other = replace(book, content={**book.content, name: json.dumps(document).encode()})
    assert other.sha256 == book.sha256 != with_rms(book, 1.01).sha256


def test_an_unequal_file_of_the_plain_text_is_told(books: Books) -> None:
    book = books[MEASURED]
    (check,) = plain_checks([book], [replace(book, content={**book.content, "book.h5": b""})])
    assert check.outcome is Outcome.FAILED
    assert check.found.endswith("other bytes: book.h5")
    assert [check.outcome for check in plain_checks([book], [book])] == [Outcome.PASSED]


def test_a_tune_that_failed_is_told_and_nothing_is_said_of_its_book() -> None:
    (check,) = tune_checks([FAILED])
    assert (check.outcome, check.found) == (Outcome.FAILED, "exit code 70: a fault")
    others = [
        *plain_checks([FAILED], [FAILED]), prediction_check(FAILED), verify_check(FAILED), loop_check(FAILED),
        *planted_checks(FAILED), *any_time_checks(FAILED), *c_checks(FAILED), *structured_text.st_checks(FAILED),
    ]  # fmt: skip
    assert {check.outcome for check in others} == {Outcome.NOT_CHECKED}


def test_the_second_program_confirms_a_book_and_finds_what_is_planted(books: Books) -> None:
    for check in (verify_check(books[MEASURED]), *planted_checks(books[ESTIMATED])):
        assert check.outcome is Outcome.PASSED, check.found
    unchanged = planted("nothing", "", books[ESTIMATED], {})
    assert unchanged.outcome is Outcome.FAILED


def test_the_book_at_any_time_reaches_what_the_small_tunes_do_not(books: Books, tmp_path: Path) -> None:
    measured = replace(books[MEASURED], folder=tmp_path / MEASURED)
    for check in any_time_checks(measured):
        assert check.outcome is Outcome.PASSED, check.found
    made = TableBook(tuple(any_time_tables(from_json(next(iter(measured.tables.values()))))))
    assert all(table.has_gauge and table.decisions is Decisions.AT_ANY_TIME for table in made.tables)
    # Before the entrance another stage is the highest than behind it.
    assert all(table.stages[table.entrance_stage].upper is not None for table in made.tables)
    first = made.tables[0].target_speed_m_s
    category, axles = made.tables[0].cut.category, len(made.tables[0].cut.axle_offsets_m)
    between = [made.choose(category, axles, first + part * any_time.APART_M_S).status for part in (0.5, 1.5)]
    assert between == [Status.BETWEEN, Status.SLOWER]


def test_a_prediction_outside_its_limits_fails(books: Books) -> None:
    assert prediction_check(books[MEASURED]).outcome is Outcome.PASSED
    assert prediction_check(with_rms(books[MEASURED], 1.2)).outcome is Outcome.FAILED


@pytest.mark.skipif(shutil.which(COMPILERS[0]) is None, reason="no C compiler")
def test_the_self_test_of_c_is_run_and_finds_a_changed_number(books: Books, tmp_path: Path) -> None:
    code = {Path(name).name: content for name, content in books[ESTIMATED].content.items() if name.startswith("c/")}
    assert self_test(COMPILERS[0], "-O0", code, tmp_path / "sound") == "fault 0 at 0"
    assert fault_check(COMPILERS[0], code, tmp_path).outcome is Outcome.PASSED
    broken = {**code, Path(CODE).name: b"#error"}
    assert "#error" in self_test(COMPILERS[0], "-O0", broken, tmp_path / "broken")


def test_a_compiler_that_waits_for_ever_or_steers_the_terminal_is_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert process(["sleep", "60"], tmp_path, longest_s=0.1).sentence == "exit code -1: sleep has not ended after 0.1 s"
    (tmp_path / "steers").write_text("#!/bin/sh\nprintf '\\033[31m%05000d' 0 >&2\n")
    (tmp_path / "steers").chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path}{os.pathsep}{os.environ['PATH']}")
    check = compiler_check("steers", "", {}, tmp_path)
    assert (check.outcome, check.found.isprintable(), len(check.found)) == (Outcome.FAILED, True, 1000)


def test_a_process_under_way_ends_with_the_command(tmp_path: Path) -> None:
    """In a process of its own, which does what `leave` does before it ends."""
    text = """\
import atexit, sys, threading, time
from pathlib import Path
from synth.cli.qualification.check import process
one = threading.Thread(target=process, args=(["sh", "-c", "touch begun; exec sleep 60"], Path(sys.argv[1])))
one.start()
while not Path(sys.argv[1], "begun").exists():
    time.sleep(0.01)
atexit._run_exitfuncs()
one.join(20.0)
print(one.is_alive())
"""
    assert process([sys.executable, "-c", text, str(tmp_path)], tmp_path).out == "False\n"


def test_the_program_ends_with_a_command_that_is_killed(tmp_path: Path) -> None:
    text = """\
import sys
from pathlib import Path
from synth.cli.qualification import check
waits = "import os, time; from pathlib import Path; Path('pid').write_text(f'{os.getpid()}.'); time.sleep(60)"
check.ENTRY = (*check.ENTRY[:3], f"{check.WATCH}; {waits}")
check.program("", Path(sys.argv[1]))
"""
    command = subprocess.Popen([sys.executable, "-c", text, str(tmp_path)])
    told = tmp_path / "pid"
    while not (told.exists() and told.read_text().endswith(".")):
        assert command.poll() is None
        time.sleep(0.01)
    one = psutil.Process(int(told.read_text().rstrip(".")))
    command.kill()
    command.wait()
    patience = time.monotonic() + 20.0
    while one.is_running() and one.status() != psutil.STATUS_ZOMBIE:  # nobody may be there to bury it
        assert time.monotonic() < patience
        time.sleep(0.01)


def test_one_number_is_changed(books: Books) -> None:
    code = books[ESTIMATED].content[CODE]
    other = with_other_number(code)
    assert len(other) == len(code)
    assert sum(a != b for a, b in zip(other, code, strict=True)) == 1


def test_compilers_that_are_not_there_are_told(books: Books, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", "")
    found = [*c_checks(books[ESTIMATED]), *structured_text.st_checks(books[ESTIMATED])]
    assert [(check.outcome, check.found) for check in found] == [
        (Outcome.NOT_CHECKED, "not on PATH: gcc, clang"),
        (Outcome.NOT_CHECKED, "not on PATH: iec2c"),
    ]
    assert all(check.remedy for check in found)
