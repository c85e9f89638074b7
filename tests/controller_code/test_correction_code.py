"""The exported C of the on-line correction: bit for bit Python in every build, clean, its self-test finds faults."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest
from numba import njit

from scripts.studies.in_the_loop.controller_process import Build
from synth.kernels.compiled_rules import compiled_rule
from tests.controller_code.building import WAYS, built, told
from tests.controller_code.conftest import ToChange, Tool
from tests.effort import QUESTIONS
from tuning_tables.correction import Correction
from tuning_tables.exports import correction_c_files
from tuning_tables.programs.correct import corrected_speed, learn_exit, usable_exit

CORRECTION = Correction(0.15, 0.06)
QUESTION = np.dtype([("state", "u4", 3), ("error", "u4"), ("speed", "u4"), ("credible", "i4"), ("pass", "i4", 6)])
PROGRAM = r"""
#include <stdio.h>
#include <string.h>
#include "retarder_correction_self_test.h"
int main(int count, char **arguments)
{
    int32_t asked[12];
    if (count > 1 && strcmp(arguments[1], "self-test") == 0) {
        uint32_t where = 0u;
        const int fault = retarder_correction_self_test(&where);
        printf("fault %d at %u\n", fault, (unsigned)where);
        return 0;
    }
    while (fread(asked, sizeof asked, 1, stdin) == 1) {
        float answer[5], error, speed;
        const retarder_correction_setting *setting = &retarder_correction_settings[0];
        retarder_correction state;
        memcpy(&state, asked, 12);
        memcpy(&error, asked + 3, 4);
        memcpy(&speed, asked + 4, 4);
        retarder_learn_exit(setting, &state, error, (int)asked[5]);
        memcpy(answer, &state, 12);
        answer[3] = retarder_corrected_speed(setting, &state, speed);
        answer[4] = (float)retarder_usable_exit(asked[6], asked[7], asked[8], (int)asked[9], (int)asked[10],
                                                (int)asked[11], error);
        fwrite(answer, sizeof answer, 1, stdout);
    }
    return 0;
}
"""


@cache
def asked_exits() -> npt.NDArray[np.void]:
    """Likely states and exits, those at every bound, and one in ten of any bits."""
    rng, n = np.random.default_rng(20261122), QUESTIONS
    limit, reach, clip = map(float, CORRECTION.setting[2:5])
    found = np.empty(n, QUESTION)

    def bits_of(values: npt.NDArray[np.float64], special: Sequence[float], any_share: float) -> npt.NDArray[np.uint32]:
        near = np.array(special, np.float32)
        edges = np.nextafter(near[rng.integers(0, len(near), n)], rng.choice([-9, 0, 9], n).astype(np.float32))
        chosen = np.where(rng.random(n) < 0.1, edges, values.astype(np.float32)).view(np.uint32)
        return np.where(rng.random(n) < any_share, rng.integers(0, 2**32, n, np.uint32), chosen)

    t = CORRECTION.threshold_m_s
    found["state"][:, 0] = bits_of(rng.normal(0, 0.06, n), (reach, -reach, t, -t), 0.02)
    found["state"][:, 1] = bits_of(rng.uniform(-limit, limit, n), (limit, -limit, 0.0), 0.02)
    found["state"][:, 2] = bits_of(rng.integers(0, 3000, n).astype(np.float64), (2.0**24, 2.0**24 - 1, 0.0), 0.02)
    found["error"] = bits_of(rng.normal(0, 0.15, n), (1.0, -1.0, clip, -clip, 0.1, np.inf), 0.05)
    found["speed"] = bits_of(rng.uniform(0, 12, n), (40.0, 0.0, limit), 0.05)
    found["credible"] = rng.random(n) < 0.9
    samples = rng.choice([*range(5, 100), 32767, -1], n)
    found["pass"] = np.stack(
        [samples, rng.integers(-1, 6, n), (samples * rng.uniform(-0.1, 1.1, n)).astype(np.int32),
         rng.integers(0, 2, n), rng.random(n) < 0.1, rng.random(n) < 0.1], axis=1,
    )  # fmt: skip
    return found


@cache
def right_exits() -> npt.NDArray[np.float32]:
    """What the Python text makes of each question, compiled."""
    learn, speed, usable = map(compiled_rule, (learn_exit, corrected_speed, usable_exit))
    setting = CORRECTION.setting

    @njit
    def all_answers(setting, states, errors, speeds, credible, passes, answers):  # type: ignore[no-untyped-def]
        for i in range(len(errors)):
            learn(setting, states[i], errors[i], credible[i])
            answers[i, :3] = states[i]
            answers[i, 3] = speed(setting, states[i], speeds[i])
            p = passes[i]
            answers[i, 4] = usable(p[0], p[1], p[2], p[3] != 0, p[4] != 0, p[5] != 0, errors[i])

    found, answers = asked_exits(), np.empty((QUESTIONS, 5), np.float32)
    states = np.ascontiguousarray(found["state"]).view(np.float32).copy()
    with np.errstate(invalid="ignore"):  # a signalling NaN is widened
        errors, speeds = (np.ascontiguousarray(found[name]).view(np.float32).astype(np.float64)
                          for name in ("error", "speed"))  # fmt: skip
    all_answers(setting, states, errors, speeds, found["credible"] != 0, found["pass"].copy(), answers)
    return answers


def test_python_and_its_compiled_text_agree() -> None:
    found, answers = asked_exits(), right_exits()
    for i in range(2000):
        state = found["state"][i].view(np.float32).copy()
        with np.errstate(invalid="ignore"):  # a signalling NaN is widened
            error, speed = (float(found[name][i : i + 1].view(np.float32)[0]) for name in ("error", "speed"))
        learn_exit(CORRECTION.setting, state, error, bool(found["credible"][i]))
        assert np.array_equal(state.view(np.uint32), answers[i, :3].view(np.uint32))
        assert np.array_equal(
            np.float32(corrected_speed(CORRECTION.setting, state, speed)), answers[i, 3], equal_nan=True
        )


@pytest.mark.requirement("CORR-06")
@pytest.mark.parametrize("build", WAYS, ids=str)
def test_c_learns_as_python_to_the_last_bit(build: Build, tmp_path: Path, tool: Tool) -> None:
    for name in build.missing():
        tool(name)
    command = built(correction_c_files(CORRECTION), PROGRAM, tmp_path, build)
    given = asked_exits().view("i4").astype(f"{build.order}i4").tobytes()
    found = np.frombuffer(told(command, given=given), f"{build.order}f4").astype(np.float32).reshape(-1, 5)
    # Which of its many bit patterns a NaN that is handed on has is the processor's business.
    both_nan = np.isnan(found) & np.isnan(right_exits())
    assert np.count_nonzero((found.view(np.uint32) != right_exits().view(np.uint32)) & ~both_nan) == 0
    assert told(command, "self-test") == b"fault 0 at 0\n"


def test_the_questions_reach_much() -> None:
    answers = right_exits()
    assert np.isfinite(answers[:, :3]).all()
    assert np.abs(answers[:, 1]).max() == CORRECTION.setting.limit_m_s
    for share in ((answers[:, 1] == 0.0).mean(), answers[:, 4].mean(), (answers[:, 3] == 0.0).mean()):
        assert 0.001 < share < 0.6


MUTANTS = (
    ("-0x1p+0f", "-0x1.8p+0f", 4),
    ("LARGEST_ERROR_M_S 0x1p+0f", "LARGEST_ERROR_M_S 0x1.8p+0f", 4),
    ("0x1.99999ap-4f", "0x1.99999cp-4f", 5),
    ("MOST_LEARNT 0x1p+24f", "MOST_LEARNT 0x1p+26f", 4),
    ("0x1.4p+5f", "0x1.8p+5f", 4),
    ("least_mean <= correction->mean_m_s &&", "", 4),
    ("least_mean <= correction->mean_m_s &&", "least_mean < correction->mean_m_s &&", 4),
    ("correction->mean_m_s <= setting->reach_m_s &&", "", 4),
    ("rounded(mean * mean) > setting->threshold_squared", "1", 4),
    ("rounded(mean - rounded(setting->threshold_squared / mean))", "mean", 4),
    ("&& correction->learnt <= MOST_LEARNT", "", 4),
    ("if (!sound) {", "if (0) {", 4),
    ("if (credible &&", "if (", 4),
    ("rounded(error_m_s + correction->correction_m_s)", "error_m_s", 4),
    ("larger(innovation, rounded(0.0f - setting->clip_m_s))", "innovation", 4),
    ("smaller(larger(mean, least_mean), setting->reach_m_s)", "mean", 4),
    ("smaller(larger(wanted, slowest), fastest)", "larger(wanted, slowest)", 4),
    ("smaller(larger(wanted, slowest), fastest)", "smaller(wanted, fastest)", 4),
    ("rounded(correction->learnt + 1.0f)", "correction->learnt", 4),
    ("0.0f <= v_m_s", "-9.0f <= v_m_s", 4),
    ("larger(rounded(v_m_s + correction->correction_m_s), 0.0f)", "rounded(v_m_s + correction->correction_m_s)", 4),
    ("!by_hand &&", "", 5),
    ("!stalled &&", "", 5),
    ("samples >= 10", "samples > 10", 5),
    ("0 <= missing &&", "", 5),
    ("missing <= 3", "missing < 3", 5),
    ("0 <= at_top &&", "", 5),
    ("at_top <= others", "at_top < others", 5),
    ("LEAST_ERROR_M_S <= error_m_s &&", "", 5),
    ("!ends_at_top ||", "", 5),
    ("error_m_s <= LARGEST_EXCESS_M_S", "error_m_s < LARGEST_EXCESS_M_S", 5),
    ("if (correction == 0) {", "if (0) {", None),
    ("0xEDB88320u", "0xEDB88321u", 1),
    ("0x1.333334p-3f", "0x1.333336p-3f", 2),
)


@pytest.mark.parametrize(("before", "after", "fault"), MUTANTS, ids=[f"{n}" for n in range(len(MUTANTS))])
def test_the_self_test_finds_a_wrong_controller(
    before: str, after: str, fault: int | None, tmp_path: Path, to_change: ToChange
) -> None:
    export = {**correction_c_files(CORRECTION), "main.c": PROGRAM.encode("ascii")}
    (said,) = to_change([export], "retarder_correction.c").self_tests(before, after, tmp_path)
    assert said.returncode == 0 if fault else said.returncode != 0  # without a record it must not fall
    assert said.stdout.startswith(f"fault {fault} at" if fault else "")
