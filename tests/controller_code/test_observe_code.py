"""The estimator in the exported C: wrong ones are found by the self-test, spoilt tables and estimates do no harm."""

from __future__ import annotations

import csv
import io
import re
import subprocess
import zlib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from tuning_tables.table_block import block_of, block_size

from scripts.studies.in_the_loop.builds import SANITIZED
from scripts.studies.in_the_loop.controller_process import CONTRACT, compile_with, sources_of, write_sources
from scripts.studies.in_the_loop.hard_samples import hard_samples
from tests.controller_code.conftest import Built, ToChange, Tool
from tests.controller_code.sample_book import estimating_book, sample_book, table_of
from tuning_tables import alarms_for, speed_for, unseen_samples
from tuning_tables.c_source import c_files
from tuning_tables.estimator import begin
from tuning_tables.golden_tracks import golden_tracks
from tuning_tables.table_book import TableBook

SWAPPED = {
    " + ": " - ", " - ": " + ", " * ": " / ", " / ": " * ", " < ": " <= ", " > ": " >= ", " <= ": " < ", " >= ": " > ",
    " && ": " || ", " == ": " != ",
}  # fmt: skip
SAME = {
    ("least > value", " > "), ("most < value", " < "),  # of two equal numbers one is as good as the other
    ("j + 1u < last", " < "),  # no place is beyond the last break
    ("overpressure_kpa >= 0.0f", " >= "), ("s_m >= before", " >= "),  # what replaces it is equal
    ("surprise) > bound", " > "), ("leap > most", " > "), ("leap < -most", " < "),  # equal in no track
    ("variance > table->lost", " > "), ("off > table->unlikely", " > "), ("off < -table->unl", " < "),  # nor these
    ("LEAST_SPEED_M_S && !leaps", " && "), ("doubted = v_m_s", " >= "),  # told later, or not at all
}  # fmt: skip
"""Changes that change nothing."""

HARDLY = {
    ("LEAST_STEP_M", "LEAST_FACTOR", "LARGEST_FACTOR", "LARGEST_EXCESS_M_S2"): "1.01f",
    ("GATE_SQUARED", "FEW_READINGS"): "1.5f",
}
"""Constants of which a last bit is lost when it comes to speeds, and what they are changed by."""


@pytest.fixture(scope="module")
def estimating() -> TableBook:
    return estimating_book()


def changed_code(code: str) -> list[tuple[str, str]]:
    """(what was changed, the code) for every operator swapped and every constant changed."""
    found = []
    for match in re.finditer(r" (?:[-+*/<>]|[<>=]=|&&) ", code):
        line = code[code.rfind("\n", 0, match.start()) + 1 : code.index("\n", match.start())]
        if line.startswith("#"):
            continue
        in_comment = code.rfind("/*", 0, match.start()) > code.rfind("*/", 0, match.start())
        if in_comment or (match[0] == " * " and "rounded" not in line):
            continue
        around = code[match.start() - 16 : match.end() + 12]
        if not any(place in around and operator == match[0] for place, operator in SAME):
            found.append((f"{match[0]}in {line}", code[: match.start()] + SWAPPED[match[0]] + code[match.end() :]))
    for match in re.finditer(r"(#define (\w+) )(0x1\S+f)", code):
        factor = next((factor for names, factor in HARDLY.items() if match[2] in names), "1.0000002f")
        found.append((match[2], code[: match.start()] + f"{match[1]}({match[3]} * {factor})" + code[match.end() :]))
    return found


@pytest.mark.slow
def test_the_self_test_finds_every_wrong_operation(estimating: TableBook, tmp_path: Path, to_change: ToChange) -> None:
    wanted = ("light-2.0", "light-3.3", "odd", "shadow-1.5", "shadow-3.0")
    book = TableBook(tuple(table for table in estimating.tables if table.id in wanted))
    export = to_change([sources_of(book)], "retarder_table.c")
    text = export.content
    begin_at, end_at = text.index("#define LARGEST_SPEED_M_S"), text.index("static uint32_t crc_of_byte")
    code, rest = text[begin_at:end_at], text[end_at:]

    def self_test(changed: str) -> str:
        (said,) = export.self_tests_of(text[:begin_at] + changed + rest, tmp_path)
        return said.stdout.strip() or f"signal {-said.returncode}"

    assert self_test(code) == "fault 0 at 0"
    changes = changed_code(code)
    assert len(changes) > 100
    answers = {change: self_test(changed) for change, changed in changes}
    assert [change for change, answer in answers.items() if not answer.startswith(("fault 5", "signal"))] == []


@pytest.mark.parametrize(
    ("before", "after", "fault"),
    [
        ("rounded(rounded(slope * c7) - rounded(effect * estimate->cross_covariance))",
         "(float)((double)slope * (double)c7 - (double)effect * (double)estimate->cross_covariance)", "fault 5 at"),
        ("rounded(work[j] + rounded(part * rounded(work[j + 1u] - work[j])))",
         "(float)((double)work[j] + (double)part * (double)rounded(work[j + 1u] - work[j]))", "fault 5 at"),
        ("table->touch_kpa;", "table->touch_kpa + 1.0f;", "fault 5 at 0"),
        ("*estimate = unknown;", "(void)unknown;", "fault 5 at 0"),
        ("(void)is_seen(estimate, v_m_s);\n    return v_m_s;", "return v_m_s;", "fault 5 at"),
        ("    return v_m_s;", "    return 0.0f;", "fault 5 at"),
        ("is_credible ? 0.0f : rounded(estimate->unseen + 1.0f)", "rounded(estimate->unseen + 1.0f)", "fault 5 at"),
        ("return is_same_estimator(slower, faster) &&", "return", "fault 4 at"),
        ("if (differ(slower->work[row][j], faster->work[row][j]))", "if (row > j)", "fault 4 at"),
        ("slower->breaks != faster->breaks ||", "slower->breaks == faster->breaks ||", "fault 4 at"),
    ],
)  # fmt: skip
def test_other_faults_are_found(
    before: str, after: str, fault: str, estimating: TableBook, tmp_path: Path, to_change: ToChange
) -> None:
    # A neighbour whose estimator differs in the last bit of one break only.
    first = estimating.tables[1]
    assert first.estimator is not None
    work = (*first.estimator.drive_m2_s2[:-1], float(np.nextafter(np.float32(first.estimator.drive_m2_s2[-1]), 9.0)))
    other = replace(first, id="other", target_speed_m_s=3.5, estimator=replace(first.estimator, drive_m2_s2=work))
    book = TableBook((*estimating.tables, other))
    (said,) = to_change([sources_of(book)], "retarder_table.c").self_tests(before, after, tmp_path)
    assert said.stdout.startswith(fault)


PROBE = r"""
#include "retarder_table.h"
#include <stdio.h>
#include <string.h>
int main(void)
{
    static retarder_table table;
    retarder_estimate estimate;
    float readings[3];
    unsigned long count = 0u;
    memset(&estimate, 0xff, sizeof estimate);
    retarder_begin(0);
    if (retarder_unseen(0) != 16777216.0f || retarder_unseen(&estimate) == 0.0f || retarder_alarms(0, &estimate) != 0u
        || retarder_alarms(&retarder_tables[0], 0) != 0u) {
        return 1;
    }
    retarder_begin(&estimate);
    if (retarder_observe(0, &estimate, 1.0f, 2.0f, 3.0f) != -1.0f || retarder_touch_pressure(0) != 0.0f
        || retarder_observe(&retarder_tables[0], 0, 1.0f, 2.0f, 3.0f) != -1.0f || retarder_unseen(&estimate) != 1.0f) {
        return 1;
    }
    while (fread(&table, sizeof table, 1, stdin) == 1 && fread(&estimate, sizeof estimate, 1, stdin) == 1
           && fread(readings, sizeof readings, 1, stdin) == 1) {
        const float speed = retarder_observe(&table, &estimate, readings[0], readings[1], readings[2]);
        count += retarder_decide(&table, 1, readings[0], speed) != 1;
        count += retarder_alarms(&table, &estimate) > 7u;
    }
    printf("%lu\n", count);
    return 0;
}
"""


def test_spoilt_tables_and_estimates_and_null_pointers_do_no_harm(
    estimating: TableBook, tmp_path: Path, tool: Tool
) -> None:
    """Any number of breaks, any bits in every word, under the sanitizers; each call ends."""
    write_sources(estimating, tmp_path)
    (tmp_path / "probe.c").write_text(PROBE, "ascii")
    program = str(tmp_path / "probe")
    sources = [str(tmp_path / name) for name in ("probe.c", "retarder_table.c")]
    compile_with([tool("gcc"), "-std=c99", *SANITIZED, *sources, "-o", program])
    rng, size, calls = np.random.default_rng(8), block_size(estimating), 20_000
    blocks = np.array([block_of(estimating, number, size=size).words for number in range(len(estimating.tables))])
    words = blocks[rng.integers(0, len(blocks), calls)]
    wild = rng.integers(0, 2**32, words.shape, dtype=np.uint32)
    words = np.where(rng.random(words.shape) < rng.choice([0.0, 0.01, 0.3], (calls, 1)), wild, words)
    near = rng.choice([0, 1, 2, size.breaks, size.breaks + 1, 2**31, 2**32 - 1], calls)
    words[:, size.estimator.start] = np.where(rng.random(calls) < 0.5, near, words[:, size.estimator.start])
    estimates = rng.integers(0, 2**32, (calls, 16), dtype=np.uint32)
    samples = hard_samples(estimating, calls, 9)[:calls]
    readings = np.stack([samples[name] for name in ("s_m", "v_m_s", "overpressure_kpa")], axis=1).view(np.uint32)
    given = np.concatenate([words, estimates, readings], axis=1).astype(np.uint32).tobytes()
    ran = subprocess.run([program], input=given, capture_output=True, timeout=60, check=False)
    assert (ran.returncode, ran.stderr) == (0, b"")
    assert int(ran.stdout) > 50  # some of them did decide


def test_a_table_without_estimator_hands_every_bit_on(estimating: TableBook, built: Built) -> None:
    for book in (sample_book(), estimating):
        controller = built(book)
        samples = hard_samples(book, 20_000, 10)
        samples["table"] = next(n for n, table in enumerate(book.tables) if table.estimator is None)
        samples["v_m_s"] = np.random.default_rng(1).integers(0, 2**32, len(samples), np.uint32).view(np.float32)
        assert np.array_equal(controller.observe(samples)[:, 0], samples["v_m_s"].view(np.uint32))


def test_without_estimators_the_blocks_are_what_they_were(tmp_path: Path, tool: Tool) -> None:
    """No word of a table more than its 9 + stages + 2 stages powers, and no code of the estimator."""
    book = sample_book()
    size = block_size(book)
    assert size.words == 9 + size.stages + 2 * size.stages * size.powers
    assert "golden_tracks.csv" not in c_files(book)
    write_sources(book, tmp_path)
    compile_with([tool("gcc"), *CONTRACT, "-Os", "-c", str(tmp_path / "retarder_table.c"), "-o", str(tmp_path / "t.o")])
    names = compile_with(["nm", str(tmp_path / "t.o")])
    assert "retarder_observe" in names
    assert not re.search(r"\b(predict|correct|work_until|observe)\b", names)


def test_golden_tracks_as_csv_are_estimated_as_they_say(estimating: TableBook) -> None:
    rows = list(csv.DictReader(io.StringIO(c_files(estimating)["golden_tracks.csv"].decode("utf-8"), newline="")))
    tracks, state, last = set(), begin(), ""
    for row in rows:
        table = estimating.tables[int(row["table"])]
        assert row["id"] == table.id
        if row["track"] != last:
            state, last = begin(), row["track"]
            tracks.add(row["track"])
        readings = []
        for name, unit in (("s", "s_m"), ("v", "v_m_s"), ("overpressure", "overpressure_kpa")):
            value = np.array([int(row[f"{name}_bits"], 16)], np.uint32).view(np.float32)[0]
            assert np.array_equal(np.float32(row[unit]), value, equal_nan=True)
            readings.append(float(value))
        with np.errstate(all="ignore"):
            estimate = np.float32(speed_for(table, state, *readings))
        assert f"{int(estimate.view(np.uint32)):08x}" == row["estimate_bits"]
        assert np.float32(row["estimate_m_s"]) == estimate
        assert int(row["unseen_samples"]) == unseen_samples(state)
        assert int(row["alarms"]) == alarms_for(table, state)
    assert len(tracks) == len(golden_tracks(estimating))


def test_the_tracks_of_a_large_book_are_few() -> None:
    """Of 20 classes with three targets, each class of one estimator: a tenth of what the vectors take.

    Each class has tracks of its own, so those of 330 classes are as few for each of them.
    """
    base = estimating_book().tables[0]
    assert base.estimator is not None
    tables = []
    classes = 20
    for mass in range(classes):
        estimator = replace(base.estimator, friction_cv=0.1 + 1e-4 * mass)
        for target in (2.0, 3.0, 4.0):
            table = table_of(f"{mass}-{target}", f"{mass}", 20.0 + mass, (0.0, 2.0), target)
            tables.append(replace(table, estimator=estimator))
    tracks = golden_tracks(TableBook(tuple(tables)))
    assert len({track.number for track in tracks}) == classes
    assert sum(map(len, tracks)) < classes * 350


def test_the_checksum_covers_the_estimator(estimating: TableBook) -> None:
    words = block_of(estimating, 0).words
    estimator = block_size(estimating).estimator
    assert words[-1] == zlib.crc32(words[:-1].astype("<u4").tobytes())
    assert words[estimator].any()
    assert estimator.stop == len(words) - 1
