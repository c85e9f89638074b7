"""The exported C of tables for point sensors: bit for bit Python in every build, clean, its self-test finds faults."""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest

from scripts.studies.in_the_loop.controller_process import Build, compile_with
from tests.controller_code.building import WAYS, built, told, written
from tests.controller_code.conftest import Tool
from tests.controller_code.passage_tables import every_axle_book, passage_book, passage_table
from tests.controller_code.pulse_questions import ANSWER, PAIR, Rows, asked, right
from tests.effort import QUESTIONS, every
from tuning_tables.controller_code.code import crc32_of, words_of
from tuning_tables.controller_code.passage_code import passage_code
from tuning_tables.export_names import RETARDER
from tuning_tables.passages.exports import passage_c_files
from tuning_tables.passages.passage_book import PassageBook
from tuning_tables.passages.rule import held_by
from tuning_tables.programs.at_pulse import wanted_stage
from tuning_tables.self_test_size import FULL, SMALL, SelfTestSize

BOOK = passage_book()
TABLES = BOOK.tables

PROGRAM = r"""
#include <stdio.h>
#include <string.h>
#include "retarder_passages_self_test.h"
int main(int count, char **arguments)
{
    int32_t asked[15];
    retarder_tracker tracker;
    retarder_begin_cut(&tracker);
    if (count > 1 && strcmp(arguments[1], "self-test") == 0) {
        uint32_t where = 0u;
        const int32_t fault = retarder_passages_self_test(&where);
        printf("fault %d at %u\n", (int)fault, (unsigned)where);
        return 0;
    }
    if (count > 1 && strcmp(arguments[1], "dump") == 0) {
        fwrite(retarder_passage_tables, sizeof(retarder_passage_table), (size_t)retarder_passage_table_count, stdout);
        return 0;
    }
    if (count > 1 && strcmp(arguments[1], "intact") == 0) {
        static retarder_passage_table damaged;
        while (fread(&damaged, sizeof damaged, 1, stdin) == 1) {
            putchar(retarder_passage_table_intact(&damaged) ? '1' : '0');
            retarder_begin_cut(&tracker);
            putchar('0' + retarder_at_pulse(&damaged, &tracker, 0, 1.0f, 0.05f, 1, 1));
        }
        return 0;
    }
    while (fread(asked, sizeof asked, 1, stdin) == 1) {
        const retarder_passage_table *table = &retarder_passage_tables[asked[0]];
        int32_t answer[8];
        float since_s, over_base_s, v_m_s;
        memcpy(&since_s, asked + 9, 4);
        memcpy(&over_base_s, asked + 10, 4);
        memcpy(&v_m_s, asked + 14, 4);
        if (asked[1] == 1) {
            retarder_begin_cut(&tracker);
        }
        if (asked[1] > 1) {
            memcpy(&tracker, asked + 2, sizeof tracker);
        }
        answer[0] = asked[1] == 3
            ? retarder_believed_passage(table, &tracker, asked[8], since_s, v_m_s)
            : retarder_at_pulse(table, &tracker, asked[8], since_s, over_base_s, asked[11], (int)asked[12]);
        memcpy(answer + 1, &tracker, sizeof tracker);
        answer[7] = retarder_wanted_stage(table, asked[13], asked[11], v_m_s);
        fwrite(answer, sizeof answer, 1, stdout);
    }
    return 0;
}
"""


@cache
def questions(book: PassageBook = BOOK) -> tuple[Rows, Rows]:
    """Questions and the answers of the Python text."""
    found = asked(book.tables, QUESTIONS, 20261123)
    return found, right(book.tables, found)


@cache
def exported(book: PassageBook, self_test: SelfTestSize) -> Mapping[str, bytes]:
    """The exported files."""
    return passage_c_files(book, RETARDER, self_test)


def differences(command: Sequence[str], build: Build, found: Rows, answers: Rows) -> int:
    """How many answers of a program have another bit."""
    given = found.view("i4").astype(f"{build.order}i4").tobytes()
    words = np.frombuffer(told(command, given=given), f"{build.order}i4").astype(np.int32)
    return int(np.count_nonzero((words.reshape(-1, 8) != answers.view("i4").reshape(-1, 8)).any(axis=1)))


def blocks(book: PassageBook) -> list[npt.NDArray[np.uint32]]:
    """What C holds of each table, its checksum last."""
    code = passage_code(book, SMALL)
    words = [words_of(code.table, table.values) for table in code.tables]
    return [np.append(each, np.uint32(crc32_of(each))) for each in words]


@pytest.mark.requirement("CODE-01")
@pytest.mark.parametrize("build", every(3, WAYS), ids=str)
def test_c_does_as_python_to_the_last_bit(build: Build, tmp_path: Path, tool: Tool) -> None:
    for name in build.missing():
        tool(name)
    command = built(exported(BOOK, FULL), PROGRAM, tmp_path, build)
    assert differences(command, build, *questions()) == 0
    assert told(command, "self-test") == b"fault 0 at 0\n"
    words = np.frombuffer(told(command, "dump"), f"{build.order}u4")
    assert np.array_equal(words, np.concatenate(blocks(BOOK)))


def test_c_does_as_python_on_every_axle(tmp_path: Path, tool: Tool) -> None:
    build, book = Build(tool("gcc"), ("-O2",)), every_axle_book()
    command = built(exported(book, FULL), PROGRAM, tmp_path, build)
    assert differences(command, build, *questions(book)) == 0
    assert told(command, "self-test") == b"fault 0 at 0\n"


def test_the_questions_reach_much() -> None:
    found, answers = questions()
    assert ANSWER.itemsize == 32
    alone = found["mode"] == PAIR
    believed = answers["stage"][alone] >= 0
    commanded = (answers["stage"] != found["stage"])[~alone]
    changed = answers["wanted"] != found["stage"]
    jumped = np.abs(answers["wanted"] - found["stage"]) > 1
    rival = answers["tracker"][:, 3] >= 0.0
    for share in (believed.mean(), commanded.mean(), changed.mean(), jumped.mean(), rival.mean()):
        assert 0.04 < share < 0.96


def test_every_changed_byte_of_a_table_is_found(tmp_path: Path, tool: Tool) -> None:
    tables = (passage_table(stages=3, places_m=(-4.0, 2.0, 9.0)),)
    command = built(exported(PassageBook(tables), FULL), PROGRAM, tmp_path, Build(tool("gcc"), ("-O1",)))
    block = blocks(PassageBook(tables))[0].view(np.uint8)
    assert told(command, "intact", given=block.tobytes()) in (b"10", b"11", b"12")
    damaged = np.repeat(block[None, :], 255 * len(block), axis=0)
    place, change = np.divmod(np.arange(255 * len(block)), 255)
    damaged[np.arange(255 * len(block)), place] ^= (change + 1).astype(np.uint8)
    answers = told(command, "intact", given=damaged.tobytes())
    assert len(answers) == 2 * len(damaged)
    assert set(answers[::2]) == set(b"0")
    assert set(answers[1::2]) <= set(b"012")  # no stage that the table has not


def test_golden_stages_as_csv_are_answered_as_they_say() -> None:
    rows = list(csv.DictReader(io.StringIO(exported(BOOK, FULL)["golden_stages.csv"].decode(), newline="")))
    assert len(rows) > 200 * len(TABLES)
    for row in rows:
        table = TABLES[int(row["table"])]
        v = np.array([int(row["reading_m_s_bits"], 16)], np.uint32).view(np.float32)[0]
        assert np.array_equal(np.float32(row["reading_m_s"]), v, equal_nan=True)
        assert wanted_stage(held_by(table), int(row["passage"]), int(row["stage"]), v) == int(row["wanted"])
        assert table.id == row["id"]


def test_a_table_and_a_tracker_take_what_the_page_says(tmp_path: Path, tool: Tool) -> None:
    written(exported(BOOK, FULL), tmp_path)
    heard, passages, stages = 7 * 6, 6, 8
    (tmp_path / "size.c").write_text(
        '#include "retarder_passages.h"\n'
        f"typedef char table_is_so_large[sizeof(retarder_passage_table) == "
        f"{4 * (20 + 3 * heard + passages * (stages + 1) * stages)}u ? 1 : -1];\n"
        "typedef char tracker_is_so_large[sizeof(retarder_tracker) == 24u ? 1 : -1];\n"
        "int main(void) { return 0; }\n"
    )
    compile_with([tool("gcc"), "-std=c99", "-c", str(tmp_path / "size.c"), "-o", str(tmp_path / "o")])
