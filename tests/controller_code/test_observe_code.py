"""The estimator in the exported C: spoilt tables and estimates do no harm; its golden tracks are few, and right."""

from __future__ import annotations

import csv
import io
import subprocess
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from scripts.studies.in_the_loop.controller_process import SANITIZED, compile_with, held_words, places, write_sources
from scripts.studies.in_the_loop.hard_questions import hard_samples
from tests.controller_code.conftest import Built, Tool
from tests.controller_code.sample_book import estimating_book, sample_book, surface_book, table_of
from tuning_tables import alarms_for, speed_for, unseen_samples
from tuning_tables.estimator import begin
from tuning_tables.exports import c_files
from tuning_tables.golden_tracks import golden_tracks
from tuning_tables.table_book import TableBook


@pytest.fixture(scope="module")
def estimating() -> TableBook:
    return estimating_book()


PROBE = r"""
#include "retarder_table.h"
#include <stdio.h>
int main(void)
{
    static retarder_table table;
    retarder_estimate estimate;
    float readings[3];
    unsigned long count = 0u;
    while (fread(&table, sizeof table, 1, stdin) == 1 && fread(&estimate, sizeof estimate, 1, stdin) == 1
           && fread(readings, sizeof readings, 1, stdin) == 1) {
        const float speed = retarder_observe(&table, &estimate, readings[0], readings[1], readings[2]);
        count += retarder_decide(&table, 1, readings[0], speed, readings[2]) != 1;
        count += retarder_alarms(&table, &estimate) > 7;
    }
    printf("%lu\n", count);
    return 0;
}
"""


@pytest.mark.requirement("CODE-07")
def test_spoilt_tables_and_estimates_do_no_harm(tmp_path: Path, tool: Tool) -> None:
    """Any sizes, lines that are none, any bits in every word, under the sanitizers; each call ends."""
    spoilt = surface_book()
    write_sources(spoilt, tmp_path)
    (tmp_path / "probe.c").write_text(PROBE, "ascii")
    program = str(tmp_path / "probe")
    sources = [str(tmp_path / name) for name in ("probe.c", "retarder_table.c")]
    compile_with([tool("gcc"), "-std=c99", *SANITIZED, *sources, "-o", program])
    rng, where, calls = np.random.default_rng(8), places(spoilt), 20_000
    tables = np.array([held_words(spoilt, number) for number in range(len(spoilt.tables))])
    words = tables[rng.integers(0, len(tables), calls)]
    wild = rng.integers(0, 2**32, words.shape, dtype=np.uint32)
    words = np.where(rng.random(words.shape) < rng.choice([0.0, 0.01, 0.3], (calls, 1)), wild, words)
    for member, room in (("breaks", 40), ("stages", 9), ("powers", 10)):
        near = rng.choice([0, 1, 2, room, room + 1, 2**31, 2**32 - 1], calls)
        words[:, where[member].start] = np.where(rng.random(calls) < 0.3, near, words[:, where[member].start])
    words[:, where["has_line"]] = np.where(rng.random((calls, 1)) < 0.3, 1, words[:, where["has_line"]])
    estimates = rng.integers(0, 2**32, (calls, 16), dtype=np.uint32)
    samples = hard_samples(spoilt, calls, 9)[:calls]
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
        for name in ("s_m", "v_m_s", "overpressure_kpa"):
            value = np.array([int(row[f"{name}_bits"], 16)], np.uint32).view(np.float32)[0]
            assert np.array_equal(np.float32(row[name]), value, equal_nan=True)
            readings.append(float(value))
        with np.errstate(all="ignore"):
            estimate = np.float32(speed_for(table, state, *readings))
        assert f"{int(estimate.view(np.uint32)):08x}" == row["estimate_m_s_bits"]
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
    assert sum(map(len, tracks)) < classes * 400
