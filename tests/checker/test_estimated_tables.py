"""Tables with an estimator: what a tune writes passes, and each planted fault in one is found for the right reason."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import pytest

from synth.checker.finding import Kind
from synth.checker.verdict import CONFIRMED, verify
from tests.checker.planted_fault import Document, alone, found, judged, look, rewrite


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
