"""Faults put into the exported C of tables for point sensors: each is found by the full and by the small self-test."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.controller_code.conftest import ToChange
from tests.controller_code.test_passage_code import BOOK, PROGRAM, exported
from tests.effort import every
from tuning_tables.self_test_size import FULL, SMALL

MUTANTS = (
    ("0xEDB88320u", "0xEDB88321u", 1),
    ("0x1.99999ap-3f, /* base_m", "0x1.99999cp-3f, /* base_m", 2),
    (".category == category &&", ".axles == axles &&", 3),
    (" && retarder_passage_tables[number].axles ==\n                axles", "", 3),
    (".mass_t > heaviest", ".mass_t < heaviest || heaviest < 0.0f", 3),
    (".mass_t >= heaviest", ".mass_t >= 0.0f", 3),
    ("target <= commanded_m_s", "target < commanded_m_s", 3),
    ("target > slower_m_s", "target < slower_m_s", 3),
    (" && commanded_m_s <= LARGEST_NUMBER", "", 3),
    ("slower_m_s >= commanded_m_s", "slower_m_s > commanded_m_s", 3),
    ("0.0f <= reading_m_s && reading_m_s <= LARGEST", "reading_m_s <= LARGEST", 4),
    (" && reading_m_s <= LARGEST_NUMBER", "", 4),
    ("v > table->switching_m_s", "v >= table->switching_m_s", 4),
    ("v < table->switching_m_s", "v <= table->switching_m_s", 4),
    ("passage < table->before_entrance", "passage <= table->before_entrance", 4),
    ("passage < table->before_entrance", "0", 4),
    ("passage < table->before_entrance && ", "", 4),
    ("highest = table->stages - 1;", "highest = table->stages - 2;", 4),
    ("0 <= passage && passage", "(passage = passage > 0 ? passage : 0) >= 0 && passage", 4),
    ("stage < table->stages", "stage <= table->stages", 4),
    ("                wanted = threshold;", "                wanted = stage + 1;", 4),
    ("0.0f <= since_s && since_s", "since_s", 5),
    ("since_s <= LONGEST_WAIT_S", "since_s < LONGEST_WAIT_S", 5),
    ("table->least_m_s <= reading_m_s", "table->least_m_s < reading_m_s", 5),
    ("reading_m_s <= table->greatest_m_s", "reading_m_s < table->greatest_m_s", 5),
    ("rounded(1.0f + table->speed_tolerance)", "1.0f", 5),
    ("rounded(1.0f - table->speed_tolerance)", "1.0f", 5),
    ("slow_now <= fastest && ", "", 5),
    (" && fast_now >= slowest", "", 5),
    ("slow_now <= fastest", "slow_now < rounded(fast + 0.999f * gained)", 5),
    ("rounded(rounded(fast_now - fast) + lost)", "rounded(fast_now - fast)", 5),
    ("rounded(rounded(slow - slow_now) + gained)", "rounded(slow - slow_now)", 5),
    ("lost) / both), 0.0f)", "lost) / both), -1e9f)", 5),
    ("gained) / both), 0.0f)", "gained) / both), -1e9f)", 5),
    ("lost) / both), 0.0f), elapsed)", "lost) / both), 0.0f), 1e9f)", 5),
    ("gained) / both), 0.0f), elapsed)", "gained) / both), 0.0f), 1e9f)", 5),
    ("+ lost) / both)", "+ lost) * (1.0f / both))", 5),
    (
        "turn * rounded(slow - rounded(half_loss * turn))",
        "(float)((double)turn * ((double)slow - (double)half_loss * (double)turn))",
        5,
    ),
    ("half_gain = rounded(0.5f * table->acc", "half_gain = rounded(0.5f * table->dec", 5),
    ("half_loss = rounded(0.5f * table->dec", "half_loss = rounded(0.5f * table->acc", 5),
    ("if (rounded(table->deceleration_m_s2 * turn) > slow)", "if (0)", 5),
    ("turn = rounded(slow / table->deceleration_m_s2);", "", 5),
    ("rest = rounded(slow_now / table->acceleration_m_s2);", "", 5),
    ("+ table->path_tolerance_m", "+ 0.0f", 5),
    ("- table->path_tolerance_m", "- 0.0f", 5),
    ("nearest <= way", "nearest < way + 1e-6f", 5),
    ("way <= farthest", "way - 1e-6f < farthest", 5),
    (" && table->sensor[met] == sensor &&", " &&", 5),
    ("met < here && found == -1", "found == -1", 5),
    ("last < (float)table->heard", "1", 5),
    ("there <= table->greatest_m_s", "1", 5),
    (" elapsed <= LONGEST_WAIT_S", " 1", 5),
    ("is_sound = is_equal(number, last);", "is_sound = 1;", 5),
    ("smaller(rounded(tracker->time_s + since_s), LONGEST_WAIT_S)", "rounded(tracker->time_s + since_s)", 5),
    ("smaller(rounded(tracker->rival_time_s + since_s), LONGEST_WAIT_S)", "tracker->rival_time_s", 5),
    ("!(is_sound && is_rival_sound)", "!is_rival_sound", 5),
    ("!(is_sound && is_rival_sound)", "!is_sound", 5),
    ("found = next_passage(table, sensor, v, tracker->rival,", "next_passage(table, sensor, v, tracker->rival,", 5),
    ("reached = larger((float)found, tracker->passage)", "reached = (float)found", 5),
    ("reached = larger((float)found, tracker->rival)", "reached = -1.0f", 5),
    ("tracker->rival = (float)first;", "", 5),
    ("        tracker->rival = -1.0f;\n", "", 5),
    ("        tracker->time_s = 0.0f;\n", "", 5),
    ("    tracker->rival_time_s = 0.0f;\n", "", 5),
    ("rounded(table->base_m / over_base_s)", "rounded(0.20001f / over_base_s)", 6),
    (" && transient_ended", "", 6),
    ("table->deciding[heard]", "table->deciding[heard] + 1", 6),
    ("table->deciding[heard]", "heard", 6),
    ("        return stage;", "        return 0;", 7),
    ("        return -1;", "        return 0;", 7),
)


@pytest.mark.requirement("CODE-06")
@pytest.mark.parametrize(("before", "after", "fault"), every(3, MUTANTS), ids=[f"{n}" for n in range(len(MUTANTS))])
def test_the_self_test_finds_a_wrong_controller(
    before: str, after: str, fault: int, tmp_path: Path, to_change: ToChange
) -> None:
    program = {"main.c": PROGRAM.encode("ascii")}
    export = to_change([{**exported(BOOK, size), **program} for size in (FULL, SMALL)], "retarder_passages.c")
    # Questions that come first may be too few for it in the small one.
    for said in export.self_tests(before, after, tmp_path):
        assert said.returncode == 0
        assert int(said.stdout.split()[1]) >= fault


def test_the_page_states_how_many_faults_are_put_into_it() -> None:
    page = (Path(__file__).parents[2] / "docs" / "reference" / "code-checks.md").read_text("utf-8")
    assert f"{len(MUTANTS)} faults put into the C" in " ".join(page.split())
