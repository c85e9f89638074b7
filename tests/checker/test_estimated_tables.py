"""Tables with an estimator, and that act before the entrance: what a tune writes passes, each planted fault is
found.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from synth.checker.finding import Kind
from synth.checker.plant import UnusableConfigError, plant_of
from synth.checker.summary import read_summary
from synth.checker.verdict import CONFIRMED, verify
from tests.checker.planted_fault import Document, alone, found, judged, look, rewrite
from tests.tuning_tables.forged_book import forge, put
from tuning_tables import Approach, TableBook, read_book, write_book
from tuning_tables.exports import vectors_csv
from tuning_tables.golden_vectors import GoldenVectors, golden_vectors
from tuning_tables.rule import decide_many


def test_a_tune_with_an_estimator_passes(estimated_once: Path) -> None:
    """JSON, book and CSV say the same, the data are those of the plant, claims confirmed; so is the book alone."""
    verdict = verify(estimated_once, 300, 1)
    assert verdict.findings == ()
    assert [each.skipped for each in verdict.tables] == [None, None]
    assert all(each.table.estimator and each.table.predicted_passes == 10_000 for each in verdict.tables)
    assert verify(estimated_once / "book.h5", 100, 1).code == CONFIRMED


def more_brake(document: Document) -> None:
    document["estimator"]["brake_m2_s2_per_kpa"] = [1.1 * w for w in document["estimator"]["brake_m2_s2_per_kpa"]]


def swapped_drive(document: Document) -> None:
    drive = document["estimator"]["drive_m2_s2"]
    drive[3], drive[4] = drive[4], drive[3]


def late_break(document: Document) -> None:
    places = document["estimator"]["s_m"]
    places[3] = 0.2 * places[3] + 0.8 * places[4]


def times(key: str, factor: float) -> Callable[[Document], None]:
    def change(document: Document) -> None:
        document["estimator"][key] *= factor

    return change


def to(key: str, value: object) -> Callable[[Document], None]:
    return lambda document: document["estimator"].update({key: value})


def no_estimator(document: Document) -> None:
    document["estimator"] = document["predicted"]["passes"] = None


@pytest.mark.requirement("VERIFY-04")
@pytest.mark.parametrize(
    ("change", "words"),
    [
        (more_brake, r"estimator's W is .* but the plant gives"),
        (swapped_drive, r"estimator's D is .* but the plant gives"),
        (late_break, r"estimator's [DW] is .* but the plant gives"),
        (times("speed_noise_m_s", 2.0), "estimator's speed noise is"),
        (times("friction_cv", 1.01), "estimator's friction_cv is"),
        (times("resistance_std_m_s2", 0.5), "estimator's resistance_std is"),
        (times("path_std", 0.99), "estimator's path_std is"),
        (times("correlation_length_m", 2.0), "estimator's correlation length is"),
        (to("frozen_readings", 1000), r"calls 1000 repetitions frozen, but its configuration gives \d\b"),
        (to("doubted_readings", 19), "doubts 19 readings, but 20 are 2 s"),
        (to("lost_speed_std_m_s", 0.3), "estimator's limit of a lost speed is 0.3, but its configuration gives 0.2"),
        (times("unlikely_deviation", 0.9), "estimator's unlikely deviation is"),
        (times("touch_pressure_kpa", 1.1), "estimator's touch pressure is"),
        (no_estimator, "asks for an estimator, it has none"),
    ],
)
def test_an_estimator_of_another_plant_is_found(
    estimated: Path, change: Callable[[Document], None], words: str
) -> None:
    file = alone(estimated)
    rewrite(file, change)
    assert found(look(file), Kind.DISAGREES, words)


def swapped_breaks(document: Document) -> None:
    places = document["estimator"]["s_m"]
    places[3], places[4] = places[4], places[3]


def falling_brake(document: Document) -> None:
    brake = document["estimator"]["brake_m2_s2_per_kpa"]
    brake[3], brake[4] = brake[4], brake[3]


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (swapped_breaks, "rising by a millimetre"),
        (falling_brake, "without a fall"),
    ],
)
def test_what_makes_no_estimator_is_damage(estimated: Path, change: Callable[[Document], None], words: str) -> None:
    file = alone(estimated)
    rewrite(file, change)
    assert found(look(file), Kind.DAMAGED, words)


def test_another_estimator_in_the_json_file_is_found_in_every_export(estimated: Path) -> None:
    rewrite(min((estimated / "tables").glob("*.json")), more_brake)
    verdict = judged(estimated)
    assert found(verdict, Kind.DISAGREES, r"estimator.brake_m2_s2_per_kpa\[\d+\] is .* in book.h5")
    assert found(verdict, Kind.DISAGREES, r"\.csv: the row number,estimator.brake_m2_s2_per_kpa")


def change_text(file: Path, pattern: str, replacement: str) -> None:
    """Change one place in a file."""
    text, count = re.subn(pattern, replacement, file.read_bytes().decode("utf-8"), count=1)
    assert count == 1
    file.write_bytes(text.encode("utf-8"))


@pytest.mark.parametrize(
    ("name", "pattern", "replacement", "words"),
    [
        (
            "c/golden_tracks.csv",
            r"\n(0,0(?:,[^,]*){4}),\w+,",
            r"\n\1,40000000,",
            r"the estimate at sample \d+ of track '0'",
        ),
        ("c/golden_tracks.csv", r"(\n(?:[^,\n]*,){7})0,", r"\g<1>1,", r"the estimate at sample \d+ of track '0'"),
        ("c/golden_tracks.csv", r"(\n(?:[^,\n]*,){8})0,", r"\g<1>2,", r"the estimate at sample \d+ of track '0'"),
        ("c/golden_tracks.csv", r"\n1,0,", "\n1,7,", "track '1' is of table '7'"),
        ("c/golden_tracks.csv", r"(?s)\n.*", "\n", "its estimator has no golden track"),
        ("c/golden_tracks.csv", r"\n(0,0,[^,]*),\w+,", r"\n\1,x,", "is no sample"),
    ],
)
def test_a_wrong_golden_track_is_found(estimated: Path, name: str, pattern: str, replacement: str, words: str) -> None:
    change_text(estimated / name, pattern, replacement)
    kind = Kind.DAMAGED if words == "is no sample" else Kind.DISAGREES
    assert found(look(estimated), kind, words)


def shorter(document: Document) -> None:
    document["approach"]["length_m"] = 3.5
    document["valid"]["s_m"][0] = -3.5


def none_at_all(document: Document) -> None:
    document["approach"] = None


def of_approach(key: str, value: object) -> Callable[[Document], None]:
    return lambda document: document["approach"].update({key: value})


@pytest.mark.parametrize(
    ("change", "kind", "words"),
    [
        (of_approach("entrance_stage", 2), Kind.DISAGREES, "allows stage 1 before the entrance, not 2"),
        (of_approach("entrance_stage", 0), Kind.DISAGREES, "allows stage 1 before the entrance, not 0"),
        (shorter, Kind.DISAGREES, r"other approach: 4\.0, not 3\.5"),
        (none_at_all, Kind.DISAGREES, r"other approach: 4\.0, not 0\.0"),
        (of_approach("length_m", 3.5), Kind.DAMAGED, r"valid\.s_m is .* but it must be from -approach\.length_m"),
    ],
)
def test_a_fault_in_the_document_is_found(
    approached: Path, change: Callable[[Document], None], kind: Kind, words: str
) -> None:
    table = alone(approached)
    rewrite(table, change)
    assert found(look(table), kind, words)


@pytest.mark.parametrize("wrong", ["no gate", "off by one", "too early", "at the entrance too", "turned round"])
def test_golden_vectors_of_a_wrong_gate_are_found(approached: Path, wrong: str) -> None:
    book = TableBook(read_book(approached / "book.h5"))
    file = approached / "c" / "golden_vectors.csv"
    assert file.read_bytes() == vectors_csv(book, [golden_vectors(table) for table in book.tables])
    stages = {"no gate": 4, "off by one": 2, "too early": 0}
    vectors = []
    for table in book.tables:
        right = golden_vectors(table)
        other = replace(table, approach=Approach(4.0, stages.get(wrong, 1)))
        asked = {"at the entrance too": right.s_m - (right.s_m == 0.0), "turned round": -right.s_m}
        path = asked.get(wrong, right.s_m)
        ungated = decide_many(replace(table, approach=Approach(4.0, 4)), right.stage, right.s_m, right.v_m_s)
        gated = np.minimum(ungated, np.maximum(right.stage, other.entrance_stage))
        answers = np.where(path < 0.0, gated, ungated)
        s_m, v_m_s, kpa = (each.copy() for each in (right.s_m, right.v_m_s, right.pressure_kpa))
        vectors.append(GoldenVectors(right.stage.copy(), s_m, v_m_s, kpa, answers))
    file.write_bytes(vectors_csv(book, vectors))
    assert found(look(approached), Kind.DISAGREES, "but the rule says")


def test_a_book_that_says_otherwise_is_found(approached: Path) -> None:
    book = approached / "book.h5"
    tables = read_book(book)
    write_book([replace(tables[0], approach=Approach(4.0, 2)), *tables[1:]], book)
    assert found(look(approached), Kind.DISAGREES, r"approach\.entrance_stage is 1 in its JSON file, but 2 in book")


@pytest.mark.parametrize(
    ("name", "value", "words"),
    [
        ("approach_entrance_stage", -1, "from 0 to"),
        ("approach", 2, "approach is 2, but it must be 0 or 1"),
        ("approach", 0, "approach_length_m holds values beside"),
        ("approach_entrance_stage", 9, "from 0 to"),
        ("approach_length_m", float("nan"), "approach.length_m"),
        ("approach_length_m", -0.0, "approach.length_m"),
        ("approach_length_m", 101.0, "from 0.001 to 100"),
    ],
)
def test_a_forged_book_is_damaged(approached: Path, name: str, value: float, words: str) -> None:
    book = approached / "book.h5"

    def edit(file: object) -> None:
        file[name][0] = value  # type: ignore[index]  # an h5py file

    forge(book, edit)
    assert found(look(book), Kind.DAMAGED, words)


def test_columns_of_approaches_that_no_table_has_are_damage(approached: Path) -> None:
    book = approached / "book.h5"

    def edit(file: Any) -> None:
        for name, value in (("approach", 0), ("approach_entrance_stage", 0), ("approach_length_m", np.nan)):
            put(file, name, file[name][()] * 0 + value)
        put(file, "approach_interlock", np.array([b""] * len(file["approach"])))

    forge(book, edit)
    assert found(look(book), Kind.DAMAGED, "columns of approach, but none of its tables has one")


@pytest.mark.parametrize(
    ("section", "changes", "words"),
    [
        ("regulator", {"approach_m": 101.0}, r"regulator\.approach_m of its configuration is 101"),
        ("regulator", {"approach_m": "4"}, r"regulator\.approach_m of its configuration is '4'"),
        ("regulator", {"initial_stage": 2}, r"regulator\.initial_stage of its configuration is 2"),
        ("regulator", {"initial_stage": 0.5}, r"regulator\.initial_stage of its configuration is 0\.5, no stage"),
        ("cut", {"entrance_stage": 5}, r"entrance_stage of its configuration is 5"),
        ("cut", {"entrance_stage": -1}, r"entrance_stage of its configuration is -1"),
    ],
)
def test_a_configuration_with_an_impossible_approach_is_refused(
    approached_once: Path, section: str, changes: Document, words: str
) -> None:
    config = read_summary(approached_once / "summary.json").config
    (cut,) = config["cut"]
    parts: Document = {"regulator": dict(config["regulator"]), "cut": dict(cut)}
    parts[section] |= changes
    with pytest.raises(UnusableConfigError, match=words):
        plant_of({**config, "regulator": parts["regulator"]}, parts["cut"])


def test_keys_of_the_approach_may_be_absent(approached_once: Path) -> None:
    config = read_summary(approached_once / "summary.json").config
    (cut,) = config["cut"]
    plant = plant_of(config, cut)
    assert (plant.approach_m, plant.initial_stage, plant.entrance_stage) == (4.0, 0, 1)
    before = plant_of({**config, "regulator": {"estimator": False}}, {k: cut[k] for k in cut if k != "entrance_stage"})
    assert (before.approach_m, before.initial_stage, before.entrance_stage) == (0.0, 0, 4)
    closed = plant_of({**config, "regulator": {"estimator": False, "initial_stage": 2}}, cut | {"entrance_stage": 2})
    assert (closed.approach_m, closed.initial_stage) == (0.0, 2)
