"""Point sensors and the on-line correction in Structured Text, run from the parse tree: bit for bit the Python
text.
"""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from functools import cache
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from tests.controller_code.passage_tables import every_axle_book, passage_book, passage_table
from tests.controller_code.pulse_questions import ANSWER, BEGIN, ON, PAIR, Rows, asked, right
from tests.controller_code.test_correction_code import CORRECTION, asked_exits, right_exits
from tests.effort import FEW, MANY, QUESTIONS, every
from tests.st_files import correction_st_files, passage_st_files
from tests.tuning_tables.st.evaluator import Program
from tests.tuning_tables.st.storage import Fault
from tests.tuning_tables.st.syntax import ASKED_UNDER, Compiler, name_of
from tuning_tables import InvalidTable
from tuning_tables.export_names import RETARDER
from tuning_tables.language.records import st_name
from tuning_tables.passages.exports import SELF_TEST_FILE, TABLE_FILE
from tuning_tables.passages.passage_book import PassageBook
from tuning_tables.passages.passage_table import PassageTable
from tuning_tables.passages.sensor_layout import DecidesOn
from tuning_tables.programs.tracker import TRACKER
from tuning_tables.self_test_size import FULL, SMALL, SelfTestSize

BOOK = passage_book()
TABLES = BOOK.tables
FILES = passage_st_files(BOOK)
MEMBERS = tuple(st_name(name).upper() for name in TRACKER.members)


@cache
def questions(book: PassageBook) -> tuple[Rows, Rows]:
    """Questions that stand for themselves, each with the tracker before it, and the answers of the Python text."""
    found = asked(book.tables, QUESTIONS, 20261124)
    answers = right(book.tables, found)
    on = np.flatnonzero(found["mode"] == ON)
    found["tracker"][on] = answers["tracker"][on - 1]
    found["tracker"][found["mode"] == BEGIN] = (-1, 0, 0, -1, 0, 0)
    return found, answers


def answers_of(program: Program, number: int, asked_now: Rows) -> Rows:
    """What the blocks make of every question of table `number`, a lane each."""
    table = program.new("RETARDER_PASSAGE_TABLE")
    program.call("RETARDER_LOAD_PASSAGES", program.new("RETARDER_LOAD_PASSAGES"), TableNo=number, Table=table)
    found = np.zeros(len(asked_now), ANSWER)
    sensor, stage, passage = (asked_now[name].astype(np.int64) for name in ("sensor", "stage", "passage"))
    for alone in (False, True):
        chosen = (asked_now["mode"] == PAIR) == alone
        tracker = program.new("RETARDER_TRACKER")
        for place, name in enumerate(MEMBERS):
            tracker[name].store(np.ascontiguousarray(asked_now["tracker"][chosen, place]), None)
        given = {"Sensor": sensor[chosen], "Since_s": asked_now["since_s"][chosen], "Table": table, "Tracker": tracker}
        if alone:
            block = program.new("RETARDER_BELIEVED_PASSAGE")
            program.call("RETARDER_BELIEVED_PASSAGE", block, Reading_m_s=asked_now["v_m_s"][chosen], **given)
            found["stage"][chosen] = block["FOUND"].value
        else:
            given |= {"Stage": stage[chosen], "TransientEnded": asked_now["ended"][chosen] != 0}
            block = program.new("RETARDER_AT_PULSE")
            program.call("RETARDER_AT_PULSE", block, OverBase_s=asked_now["over_base_s"][chosen], **given)
            found["stage"][chosen] = block["WANTED"].value
        for place, name in enumerate(MEMBERS):
            found["tracker"][chosen, place] = tracker[name].value
    wanter = program.new("RETARDER_WANTED_STAGE")
    program.call(
        "RETARDER_WANTED_STAGE", wanter, Passage=passage, Stage=stage, Reading_m_s=asked_now["v_m_s"], Table=table
    )
    found["wanted"] = wanter["WANTED"].value
    return found


def differences(found: Rows, answers: Rows) -> int:
    """How many answers differ; 0 has no sign in Structured Text."""
    wrong = (found["stage"] != answers["stage"]) | (found["wanted"] != answers["wanted"])
    return int(np.count_nonzero(wrong | (found["tracker"] != answers["tracker"]).any(axis=1)))


@pytest.mark.requirement("CODE-02")
@pytest.mark.parametrize("book", [BOOK, every_axle_book()], ids=["first axle", "every axle"])
@pytest.mark.parametrize("compiler", ASKED_UNDER, ids=name_of)
def test_every_question_is_answered_as_by_python(compiler: Compiler, book: PassageBook) -> None:
    program = Program(passage_st_files(book)[TABLE_FILE], compiler)
    found, answers = questions(book)
    for number in range(len(book.tables)):
        chosen = found["table"] == number
        assert chosen.sum() >= QUESTIONS / len(book.tables)
        assert differences(answers_of(program, number, found[chosen]), answers[chosen]) == 0


def test_a_table_that_was_not_loaded_commands_nothing() -> None:
    program = Program(FILES[TABLE_FILE])
    table, tracker, block = (
        program.new(name) for name in ("RETARDER_PASSAGE_TABLE", "RETARDER_TRACKER", "RETARDER_AT_PULSE")
    )
    loader = program.new("RETARDER_LOAD_PASSAGES")
    for number in (None, -1, len(TABLES)):
        if number is not None:
            program.call("RETARDER_LOAD_PASSAGES", loader, TableNo=number, Table=table)
            assert not loader["FOUND"].value
        given = {"Sensor": 0, "Since_s": np.float32(1), "OverBase_s": np.float32(0.1), "TransientEnded": True}
        program.call("RETARDER_AT_PULSE", block, Stage=3, Table=table, Tracker=tracker, **given)
        assert block["WANTED"].value == 3


def self_tested(text: str) -> tuple[int, int, int]:
    """Failed, FirstFailed and FirstFault after all calls of the self-test."""
    program = Program(text.encode("ascii"))
    block = program.new("RETARDER_PASSAGES_SELF_TEST")
    calls = 0
    while not block["DONE"].value:
        program.call("RETARDER_PASSAGES_SELF_TEST", block, Restart=False)
        calls += 1
        assert calls < 60
    return tuple(int(block[name].value) for name in ("FAILED", "FIRSTFAILED", "FIRSTFAULT"))  # type: ignore[return-value]


@pytest.mark.parametrize("size", every(2, [SMALL, FULL]), ids=["small", "full"])
def test_nothing_is_wrong_with_the_export(size: SelfTestSize) -> None:
    files = passage_st_files(BOOK, RETARDER, size)
    assert self_tested(b"\n".join(files.values()).decode("ascii")) == (0, -1, -1)


CHANGES = (
    ("Speed > Table.Switching_m_s[", "Speed >= Table.Switching_m_s["),
    ("Speed < Table.Switching_m_s[", "Speed <= Table.Switching_m_s["),
    ("Passage < Table.BeforeEntrance", "Passage <= Table.BeforeEntrance"),
    ("NOT (IsSound AND IsRivalSound)", "FALSE"),
    ("IsSound := Number = Last;", "IsSound := TRUE;"),
    ("Turn := Turn + Lost;", ""),
    ("Fastest := Fast + Gained;", "Fastest := Fast;"),
    ("IF Held_1 > Slow THEN", "IF FALSE THEN"),
    ("(SlowNow <= Fastest) AND ", ""),
    ("Nearest <= Way", "Nearest < Way"),
    ("Way <= Farthest", "Way < Farthest"),
    ("Held_1 := Tracker.RivalTime_s + Since_s;", "Held_1 := Tracker.RivalTime_s;"),
    ("Tracker.RivalTime_s := 0.0;\nEND_FUNCTION_BLOCK", "END_FUNCTION_BLOCK"),
    (" AND TransientEnded THEN", " THEN"),
    ("Table.Deciding[Heard]", "Heard"),
    ("IF Held_1 > LongestWait_s THEN", "IF FALSE THEN"),
    ("MassOf[Number] >= Heaviest", "MassOf[Number] > Heaviest"),
    ("Target <= Commanded_m_s", "Target < Commanded_m_s"),
    ("Slower_m_s >= Commanded_m_s", "Slower_m_s > Commanded_m_s"),
    ("(AxlesOf[Number] = Axles)", "(AxlesOf[Number] <= Axles)"),
    ("InitialStageOf : ARRAY[0..0] OF INT := [0]", "InitialStageOf : ARRAY[0..0] OF INT := [1]"),
)


@cache
def small_texts(table: PassageTable) -> Mapping[str, bytes]:
    """The export of one table with the small self-test, made once for all changes."""
    return MappingProxyType(dict(passage_st_files(PassageBook((table,)), RETARDER, SMALL)))


@pytest.mark.parametrize(("before", "after"), CHANGES, ids=[f"{n}" for n in range(len(CHANGES))])
def test_a_wrong_block_is_found_by_the_small_self_test(before: str, after: str) -> None:
    table = passage_table(places_m=(-4.0, 2.0, 5.5, 9.0), axles=(0.0, 1.85))
    text = b"\n".join(small_texts(table).values()).decode("ascii")
    assert before in text
    with suppress(Fault):  # a controller would trap
        assert self_tested(text.replace(before, after, 1))[0] > 0


def test_the_page_states_what_is_asked_here() -> None:
    path = Path(__file__).parents[3] / "docs" / "reference" / "code-checks.md"
    page = " ".join(path.read_text("utf-8").split())
    assert f"{FEW // 1000} 000 questions to the rules of each kind" in page
    assert f"with `scripts/test --long` {MANY // 10**6} 000 000" in page
    assert f"{len(CHANGES)} in the Structured Text" in page


def test_a_changed_constant_is_found() -> None:
    tables = (passage_table(places_m=(-4.0, 2.0, 9.0), stages=3, axles=(0.0, 1.85)),)
    files = passage_st_files(PassageBook(tables), RETARDER, SMALL)
    text, test = (files[name].decode("ascii") for name in (TABLE_FILE, SELF_TEST_FILE))
    begin = text.index("VAR CONSTANT", text.index("FUNCTION_BLOCK RETARDER_LOAD_PASSAGES"))
    literals = [part for part in text[begin:].split() if "E+" in part or "E-" in part][:20]
    assert len(literals) == 20
    for literal in literals:
        number = np.float32(literal.strip("[],;"))
        other = f"{float(np.nextafter(number, np.float32(np.inf))):.9E}"
        changed = text[:begin] + text[begin:].replace(literal.strip("[],;"), other, 1)
        assert self_tested(f"{changed}\n{test}")[0] >= 1, literal


def test_what_sixteen_bits_do_not_count_is_refused() -> None:
    large: tuple[PassageTable, ...] = (
        passage_table(stages=31, axles=tuple(1.5 * n for n in range(12)), decides_on=DecidesOn.EVERY_AXLE),
    )
    with pytest.raises(InvalidTable, match="counts to 32767"):
        passage_st_files(PassageBook(large))


CORRECTION_FILES = correction_st_files(CORRECTION)
STATE = ("MEAN_M_S", "CORRECTION_M_S", "LEARNT")


def corrections_of(program: Program, questions: npt.NDArray[np.void]) -> npt.NDArray[np.float32]:
    """What the blocks make of every question, a lane each: float32 (n, 5)."""
    state, setting, load = (
        program.new(f"RETARDER_{name}") for name in ("CORRECTION", "CORRECTION_SETTING", "LOAD_CORRECTION")
    )
    program.call("RETARDER_LOAD_CORRECTION", load, TableNo=0, Table=setting)
    for name, words in zip(STATE, questions["state"].T, strict=True):
        state[name].store(np.ascontiguousarray(words).view(np.float32), None)
    error, speed = (np.ascontiguousarray(questions[name]).view(np.float32) for name in ("error", "speed"))
    learner, corrector, judge = (
        program.new(f"RETARDER_{name}") for name in ("LEARN_EXIT", "CORRECTED_SPEED", "USABLE_EXIT")
    )
    records = {"Setting": setting, "Correction": state}
    program.call("RETARDER_LEARN_EXIT", learner, Error_m_s=error, Credible=questions["credible"] != 0, **records)
    program.call("RETARDER_CORRECTED_SPEED", corrector, Speed_m_s=speed, **records)
    samples, missing, at_top, *flags = questions["pass"].T.astype(np.int64)
    told: dict[str, Any] = dict(zip(("EndsAtTop", "ByHand", "Stalled"), (flag != 0 for flag in flags), strict=True))
    program.call("RETARDER_USABLE_EXIT", judge, Samples=samples, Missing=missing, AtTop=at_top, Error_m_s=error, **told)
    found = [*(state[name].value for name in STATE), corrector["CORRECTED"].value, judge["USABLE"].value]
    return np.stack([np.broadcast_to(each, error.shape).astype(np.float32) for each in found], axis=1)


@pytest.mark.requirement("CORR-06")
@pytest.mark.parametrize("compiler", ASKED_UNDER, ids=name_of)
def test_every_exit_is_learnt_as_by_python(compiler: Compiler) -> None:
    with np.errstate(invalid="ignore"):  # a signalling NaN is widened
        found = corrections_of(Program(CORRECTION_FILES["retarder_correction.st"], compiler), asked_exits())
    # 0 has no sign in Structured Text.
    assert np.array_equal(found, right_exits(), equal_nan=True)


@pytest.mark.parametrize(
    ("before", "after"),
    [("Held_1 > Setting.ThresholdSquared", "Mean > 0.0"), ("Held_1 < Slowest", "Held_1 < -9.0"), ("NOT Sound", "FALSE"),
     ("Innovation > Setting.Clip_m_s", "Innovation > 9.0"), ("Corrected < 0.0", "Corrected < -9.0"),
     ("AtTop <= Others", "AtTop < Others"), ("(NOT EndsAtTop) OR ", ""),
     ("LargestExcess_m_s : REAL := 1.0", "LargestExcess_m_s : REAL := 1.1"), ("[1.500000060E-01]", "[1.500000209E-01]"),
     ("Innovation := Innovation - Correction.Mean_m_s;", "")],
)  # fmt: skip
def test_a_wrong_block_of_the_correction_is_found(before: str, after: str) -> None:
    text = b"".join(CORRECTION_FILES.values()).decode("ascii")
    assert before in text
    assert failing_blocks(text.replace(before, after, 1)) > 0
    assert failing_blocks(text) == 0


@cache
def failing_blocks(text: str) -> int:
    """In how many blocks the self-test finds something wrong."""
    program = Program(text.encode("ascii"))
    block = program.new("RETARDER_CORRECTION_SELF_TEST")
    for _ in range(4):
        assert not block["DONE"].value
        program.call("RETARDER_CORRECTION_SELF_TEST", block, Restart=False)
    assert block["DONE"].value
    assert (int(block["FIRSTFAILED"].value) >= 0) == (int(block["FAILED"].value) > 0)
    return int(block["FAILED"].value)
