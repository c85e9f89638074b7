"""The on-line correction in Structured Text, run from its parse tree: bit for bit the Python text; its self-test."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from tests.controller_code.test_correction_code import CORRECTION, asked, right
from tests.st_files import correction_st_files
from tests.tuning_tables.st.compiler import ASKED_UNDER, Compiler, name_of
from tests.tuning_tables.st.evaluator import Program

FILES = correction_st_files(CORRECTION)
MEMBERS = ("MEAN_M_S", "CORRECTION_M_S", "LEARNT")


def answers_of(program: Program, questions: npt.NDArray[np.void]) -> npt.NDArray[np.float32]:
    """What the blocks make of every question, a lane each: float32 (n, 5)."""
    state, setting, load = (
        program.new(f"RETARDER_{name}") for name in ("CORRECTION", "CORRECTION_SETTING", "LOAD_CORRECTION")
    )
    program.call("RETARDER_LOAD_CORRECTION", load, TableNo=0, Table=setting)
    for name, words in zip(MEMBERS, questions["state"].T, strict=True):
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
    found = [*(state[name].value for name in MEMBERS), corrector["CORRECTED"].value, judge["USABLE"].value]
    return np.stack([np.broadcast_to(each, error.shape).astype(np.float32) for each in found], axis=1)


@pytest.mark.requirement("CORR-06")
@pytest.mark.parametrize("compiler", ASKED_UNDER, ids=name_of)
def test_every_question_is_answered_as_by_python(compiler: Compiler) -> None:
    with np.errstate(invalid="ignore"):  # a signalling NaN is widened
        found = answers_of(Program(FILES["retarder_correction.st"], compiler), asked())
    # 0 has no sign in Structured Text.
    assert np.array_equal(found, right(), equal_nan=True)


@pytest.mark.parametrize(
    ("before", "after"),
    [("Held_1 > Setting.ThresholdSquared", "Mean > 0.0"), ("Held_1 < Slowest", "Held_1 < -9.0"), ("NOT Sound", "FALSE"),
     ("Innovation > Setting.Clip_m_s", "Innovation > 9.0"), ("Corrected < 0.0", "Corrected < -9.0"),
     ("AtTop <= Others", "AtTop < Others"), ("(NOT EndsAtTop) OR ", ""),
     ("LargestExcess_m_s : REAL := 1.0", "LargestExcess_m_s : REAL := 1.1"), ("[1.500000060E-01]", "[1.500000209E-01]"),
     ("Innovation := Innovation - Correction.Mean_m_s;", "")],
)  # fmt: skip
def test_a_wrong_block_is_found_by_the_self_test(before: str, after: str) -> None:
    text = b"".join(FILES.values()).decode("ascii")
    assert before in text
    assert self_tested(text.replace(before, after, 1)) > 0
    assert self_tested(text) == 0


@cache
def self_tested(text: str) -> int:
    """In how many blocks the self-test finds something wrong."""
    program = Program(text.encode("ascii"))
    block = program.new("RETARDER_CORRECTION_SELF_TEST")
    for _ in range(4):
        assert not block["DONE"].value
        program.call("RETARDER_CORRECTION_SELF_TEST", block, Restart=False)
    assert block["DONE"].value
    assert (int(block["FIRSTFAILED"].value) >= 0) == (int(block["FAILED"].value) > 0)
    return int(block["FAILED"].value)
