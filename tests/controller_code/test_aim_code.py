"""The exported C of aim tables: clean, bit for bit the Python rule in every build, and its self-test finds faults."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest

from scripts.studies.in_the_loop.controller_process import Build
from tests.controller_code.building import WAYS, built, told
from tests.controller_code.conftest import ToChange, Tool
from tests.effort import QUESTIONS
from tests.tuning_tables.aim.made_tables import (
    answers,
    category_table,
    hard_questions,
    measured_table,
    reported_of,
    sample_set,
)
from tuning_tables.aim import AimTables
from tuning_tables.aim.exports import aim_c_files
from tuning_tables.aim.golden_aims import few_golden_aims, golden_aims
from tuning_tables.controller_code.aim_code import aim_code
from tuning_tables.controller_code.code import crc32_of, words_of
from tuning_tables.export_names import RETARDER
from tuning_tables.self_test_size import FULL, SMALL, SelfTestSize

PROGRAM = r"""
#include <stdio.h>
#include <string.h>
#include "aim_self_test.h"
int main(int count, char **arguments)
{
    uint32_t question[4];
    static aim_table given;
    if (count > 1 && strcmp(arguments[1], "self-test") == 0) {
        uint32_t where = 0u;
        const int fault = (int)aim_self_test(&where);
        printf("fault %d at %u\n", fault, (unsigned)where);
        return 0;
    }
    if (count > 1) {
        while (fread(&given, sizeof given, 1, stdin) == 1) {
            const float speed = aim_exit_speed(&given, 5, 60.0f, 2.0f);
            const int sound = (int)aim_table_intact(&given);
            printf("%d %d\n", sound, speed >= 0.5f && speed <= 7.0f ? 1 : speed == -1.0f ? 0 : 2);
        }
        return 0;
    }
    while (fread(question, sizeof question, 1, stdin) == 1) {
        float distance, resistance, speed;
        int32_t cars;
        memcpy(&cars, question + 1, 4);
        memcpy(&distance, question + 2, 4);
        memcpy(&resistance, question + 3, 4);
        speed = aim_exit_speed(question[0] < (uint32_t)aim_table_count ? &aim_tables[question[0]] : 0, cars, distance,
                               resistance);
        fwrite(&speed, sizeof speed, 1, stdout);
    }
    return 0;
}
"""


@pytest.fixture(scope="module")
def aims() -> AimTables:
    return sample_set()


@pytest.fixture(scope="module")
def asked(aims: AimTables) -> npt.NDArray[np.void]:
    return hard_questions(aims, QUESTIONS, 20261122)


@pytest.fixture(scope="module")
def right(aims: AimTables, asked: npt.NDArray[np.void]) -> npt.NDArray[np.float32]:
    return answers(aims, asked)


@pytest.mark.requirement("CODE-01")
@pytest.mark.parametrize("build", WAYS, ids=str)
def test_c_answers_as_python_to_the_last_bit(
    build: Build,
    aims: AimTables,
    asked: npt.NDArray[np.void],
    right: npt.NDArray[np.float32],
    tmp_path: Path,
    tool: Tool,
) -> None:
    for name in build.missing():
        tool(name)
    command = built(aim_c_files(aims), PROGRAM, tmp_path, build)
    found = np.frombuffer(
        told(command, given=asked.astype(asked.dtype.newbyteorder(build.order)).tobytes()), f"{build.order}f4"
    )
    assert np.array_equal(found.astype(np.float32).view(np.uint32), right.view(np.uint32))
    assert told(command, "self-test") == b"fault 0 at 0\n"


def test_the_questions_reach_much(asked: npt.NDArray[np.void], right: npt.NDArray[np.float32]) -> None:
    assert 0.3 * QUESTIONS < np.count_nonzero(right > 0.0) < 0.8 * QUESTIONS
    assert len(np.unique(right)) > 0.1 * QUESTIONS
    for name in ("distance", "resistance"):
        assert np.count_nonzero(~np.isfinite(asked[name])) > 0.0005 * QUESTIONS
    # One step of float32 in the distance changes the answer: it is near a node, or sharp.
    assert np.count_nonzero(asked["cars"] < 1) > 0.005 * QUESTIONS


MUTANTS = (
    ("0x1.666666p+0f", "0x1.666668p+0f", 2),  # the last bit of a speed
    ("distance > table->distance_m[below]", "1", 4),
    ("below < (table->distances - 1)", "1", 4),
    ("rounded(distance - table->distance_m[below]) /", "rounded(distance) /", 4),
    ("speed = smaller(speed, far);", "speed = far;", 4),
    ("speed = larger(speed, far);", "speed = far;", 4),
    ("if (near < far) {", "if (near > far) {", 4),
    ("near >= 0.0f && far >= 0.0f", "near >= 0.0f", 4),
    ("near >= 0.0f && far >= 0.0f", "far >= 0.0f", 4),
    ("0.0f <= near && near <= far", "near <= far", 4),
    ("0.0f <= near && near <= far", "0.0f <= near", 4),
    ("0.0f <= near && near <= far", "0.0f <= near && near < far", 4),
    ("if (beyond) {", "if (0) {", 4),
    ("beyond = 1;", "beyond = 0;", 4),
    ("below = below - 1;", "below = below - 0;", 4),
    ("rounded(far - near)", "rounded(near - far)", 4),
    ("last = first + 1;", "last = first;", 4),
    ("if (last >= table->listed) {", "if (last > table->listed) {", 4),
    ("cars >= table->cars[row]", "cars > table->cars[row]", 4),
    ("cars > table->cars[first]", "0", 4),
    ("distance >= table->distance_m[0]", "distance >= 0.0f", 4),
    ("LEAST_NUMBER <= free_distance_m &&", "", None),  # it is nearer than the first
    ("&& free_distance_m <= LARGEST_NUMBER", "", 4),
    ("resistance_n_per_kn && resistance_n_per_kn <= LARGEST_NUMBER", "resistance_n_per_kn", 4),
    ("LEAST_NUMBER <=\n                resistance_n_per_kn &&", "", 4),
    ("distance >= table->distance_m[node]", "distance > table->distance_m[node]", 4),
    ("upper = lower + 1;", "upper = lower;", 4),
    ("if (row == first || found < least) {", "if (row == first || found > least) {", 4),
    ("over_distance(table, row, upper,", "over_distance(table, row, lower,", 4),
    ("along(low, high, share)", "along(low, high, part)", 4),
    ("float share = 0.0f;\n            if (table->is_measured == 1) {", "float share = 0.0f;\n            if (0) {", 4),
    ("&& aim_tables[number].is_measured == wanted", "", 5),
    ("aim_tables[number].category == category &&", "", 5),
    ("if (table == 0) {\n        return -1.0f;", "if (table == 0) {\n        return 0.0f;", 6),
    ("0xEDB88320u", "0xEDB88321u", 1),
)


@cache
def to_mutate(self_test: SelfTestSize) -> Mapping[str, bytes]:
    """An export that shows every fault of `MUTANTS`, and the program around it."""
    speeds = category_table().exit_speed_m_s.copy()
    speeds[0, 0] = np.float32(1.4)  # 0x1.666666p+0f
    speeds[3, -2:] = 1.75  # level at the end
    speeds[4] = 1.3  # less for more cars
    speeds[4, -2] = np.nan
    flat = replace(category_table(), exit_speed_m_s=speeds, reported=reported_of(speeds))
    aims = AimTables((flat, measured_table(), category_table(1.5, 4, "СТ")))
    return {**aim_c_files(aims, RETARDER, self_test), "main.c": PROGRAM.encode("ascii")}


@pytest.mark.requirement("CODE-06")
@pytest.mark.parametrize(
    ("before", "after", "fault"), MUTANTS, ids=[f"{each[1][:30]}-{n}" for n, each in enumerate(MUTANTS)]
)
def test_the_self_test_finds_a_wrong_controller(
    before: str, after: str, fault: int | None, tmp_path: Path, to_change: ToChange
) -> None:
    export = to_change([to_mutate(size) for size in (FULL, SMALL)], "aim_table.c")
    for said in export.self_tests(before, after, tmp_path):
        assert said.returncode == 0
        assert said.stdout.startswith(f"fault {fault} at") if fault else said.stdout == "fault 0 at 0\n"


@pytest.mark.requirement("CODE-07")
def test_a_damaged_table_is_found_and_leads_nowhere(tmp_path: Path, tool: Tool) -> None:
    """Every changed byte of a block; sizes that would lead out of the table; speeds that are none."""
    tool("gcc")
    aims = AimTables((category_table(), measured_table()))
    command = built(aim_c_files(aims), PROGRAM, tmp_path, Build("gcc", ("-O1", "-g", "-fsanitize=address,undefined")))
    code = aim_code(aims, FULL)
    words = words_of(code.table, code.tables[1].values)
    sound = np.append(words, np.uint32(crc32_of(words)))
    damaged = np.repeat(sound[None, :], 4 * len(sound), axis=0)
    places = np.arange(4 * len(sound))
    damaged.view(np.uint8)[places, places] ^= (1 + places % 255).astype(np.uint8)
    for word, value in ((2, 0), (2, 6), (3, 0), (3, 2**31), (4, 6), (4, 2**32 - 1)):
        forged = sound.copy()
        forged[word] = value
        damaged = np.vstack([damaged, forged])
    for bits in (0x7F800000, 0x7FC00000, 0x7F000000, 0xBF000000, 0x3A000000):  # speeds: inf, NaN, huge, negative, tiny
        forged = sound.copy()
        forged[-1 - code.table.length("speed_m_s") : -1] = bits
        damaged = np.vstack([damaged, forged])
    lines = told(command, "given", given=np.vstack([sound, damaged]).tobytes()).decode().splitlines()
    assert lines[0] == "1 1"
    assert len(lines) == 1 + len(damaged)
    assert {line[0] for line in lines[1:]} == {"0"}
    assert {line[2] for line in lines[1:]} == {"0", "1"}  # never a speed out of the bounds
    assert set(lines[-11:]) == {"0 0"}


def test_equal_sets_give_equal_bytes_and_golden_aims_are_few(aims: AimTables) -> None:
    assert aim_c_files(aims) == aim_c_files(sample_set())
    for table in aims.tables:
        assert len(few_golden_aims(table)) <= 15 * len(table.axes.cars) + 70
        for golden in (golden_aims(table), few_golden_aims(table)):
            assert np.count_nonzero(golden.exit_speed_m_s < 0.0) > 10
