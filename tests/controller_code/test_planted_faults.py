"""What the self-tests reach of the exported C, and that they find what is planted there."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Mapping
from concurrent.futures import ThreadPoolExecutor
from functools import cache
from pathlib import Path
from typing import NamedTuple

import pytest

from scripts.studies.in_the_loop.code_coverage import Coverage, coverage_of, mcdc_release
from scripts.studies.in_the_loop.controller_process import sources_of
from tests.controller_code.building import planted_faults
from tests.controller_code.conftest import ToChange
from tests.controller_code.passage_tables import every_axle_book, passage_book, passage_table
from tests.controller_code.sample_book import FOUR_AXLES, estimating_book, sample_book, surface_book, table_of
from tests.controller_code.test_families import pairs
from tests.controller_code.test_passage_code import BOOK, PROGRAM, exported
from tests.effort import every, sized
from tests.tuning_tables.aim.made_tables import category_table, sample_set
from tuning_tables import from_json
from tuning_tables.aim import AimTables
from tuning_tables.aim.exports import aim_c_files
from tuning_tables.correction import Correction
from tuning_tables.exports import c_files, correction_c_files
from tuning_tables.passages.exports import passage_c_files
from tuning_tables.passages.passage_book import PassageBook
from tuning_tables.self_test_size import FULL, SMALL
from tuning_tables.table_book import TableBook

PARTS = {"constants": ("#define LARGEST", "\nconst "), "rules": ("static uint32_t crc_of_byte", "")}
"""Where they begin and end."""

SAME = (
    # Equal numbers, of which one is as good as the other, or which no reading gives; tables have no equal targets.
    "target > slower_m_s) {: < ->", "target < faster_m_s) {: < ->", "faster >= 0) {: >= ->", "leap < least;: ",
    "(square > bound && (strange || estimate->doubted > 0.0f)) {: >", "v >= LEAST_SPEED_M_S && !leaps) {: >= ->",
    "overpressure_kpa <= LARGEST_OVERPRESSURE_KPA) {: <= ->", "(before <= s_m && s_m <= farthest) {: <= ->",
    "(estimate->speed_variance > table->lost_variance) {: > ->", "estimate->begun > 0.0f) {: > ->",
    # One turn more over what is not there, or that answers the same.
    "number) {: < ->", "while (stage < ", "while (i < ", "while (j < ", "while (number < ", "remaining = ",
    # begin_at sets it anew, or the next reading does; a damaged table only.
    *(f"estimate->{name} = 0.0f;: left out" for name in (
        "path_m", "speed_m_s", "factor", "excess", "speed_variance", "factor_covariance", "excess_covariance",
        "factor_variance", "cross_covariance", "excess_variance", "reading_m_s", "repeated", "believed", "doubted")),
    "is_seen = 0;: left out",
    # The choice asks for what is between two tables only where the speed is between their targets.
    "table->target_m_s < commanded_m_s", "commanded_m_s < faster->target_m_s",
)  # fmt: skip
"""Changes that change nothing: a part of the line and of what was changed."""


def rules_book() -> TableBook:
    """Tables of every kind in few numbers; a lighter one before a heavier one, the faster ones before the slower."""
    wanted = ("many-stages", "turning", "odd", "shadow-3.0", "shadow-1.5", "light-4.0", "light-3.3", "light-2.0",
              "same-target", "medium-4.0")  # fmt: skip
    tables = {table.id: table for table in surface_book().tables}
    return TableBook(tuple(tables[name] for name in wanted))


@pytest.mark.requirement("CODE-06")
@pytest.mark.parametrize("part", PARTS)
def test_the_self_test_finds_every_fault(part: str, tmp_path: Path, to_change: ToChange) -> None:
    export = to_change([sources_of(rules_book())], "retarder_table.c")
    begin, end = PARTS[part]
    text = export.content
    at = text.index(begin)
    to = text.index(end, at) if end else len(text)
    faults = list(planted_faults(text[at:to]))
    assert len(faults) > 10
    faults = faults[:: sized(8, 1)]

    def self_test(number: int) -> str:
        folder = tmp_path / str(number)
        folder.mkdir()
        (said,) = export.self_tests_of(text[:at] + faults[number][1] + text[to:], folder)
        return said.stdout.strip() or f"signal {-said.returncode}"

    with ThreadPoolExecutor(2) as pool:
        said = list(pool.map(self_test, range(len(faults))))
    sound = [what for (what, _), answer in zip(faults, said, strict=True) if answer == "fault 0 at 0"]
    assert [what for what in sound if not any(same in what for same in SAME)] == []
    assert len(sound) < max(3, 0.2 * len(faults))


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


PAGE = Path(__file__).parents[2] / "docs" / "reference" / "code-checks.md"
DEFAULT = Path(__file__).parents[1] / "tuning_tables" / "st" / "default_book"


def default_book() -> TableBook:
    """The built-in book: neither estimators nor approaches nor gauges."""
    return TableBook(tuple(from_json(path.read_bytes()) for path in sorted(DEFAULT.glob("*.json"))))


def smallest_book() -> TableBook:
    """Two stages, constant lines, one table."""
    return TableBook((table_of("constant", "СТ", 66.0, FOUR_AXLES, 3.0, stages=2, degree=0),))


def one_sensor_book() -> PassageBook:
    """Two stages, two axles over one sensor."""
    return PassageBook((passage_table(stages=2, places_m=(-4.0,), axles=(0.0, 1.85)),))


EXPORTS: Mapping[str, Callable[[], Mapping[str, bytes]]] = {
    "smallest": lambda: c_files(smallest_book()),
    "default": lambda: c_files(default_book()),
    "measured": lambda: c_files(sample_book()),
    "estimated": lambda: c_files(estimating_book()),
    "surfaces": lambda: c_files(surface_book()),
    "pairs": lambda: c_files(pairs()),
    "passages": lambda: passage_c_files(passage_book()),
    "every axle": lambda: passage_c_files(every_axle_book()),
    "one sensor": lambda: passage_c_files(one_sensor_book()),
    "aims": lambda: aim_c_files(sample_set()),
    "aims by category": lambda: aim_c_files(AimTables((category_table(),))),
    "correction": lambda: correction_c_files(Correction(0.12, 0.06)),
}


class Rest(NamedTuple):
    """Why places are not reached in some exports, and what each of these places holds."""

    why: str
    exports: tuple[str, ...]
    places: tuple[str, ...]


LINES = ("smallest", "default", "measured", "estimated", "surfaces", "pairs")
ONE_TABLE = ("smallest", "every axle", "one sensor")
RESTS = (
    Rest("The other order of bytes is that of other processors; it is shown under the emulation of a PowerPC.",
         tuple(EXPORTS), ("*(const unsigned char *)&probe",)),
    Rest("No class of this book has two targets.", ONE_TABLE,
         (".mass_t > heaviest` is never false", ".mass_t >= heaviest`", "slower < 0", "faster < 0", "faster >= 0",
          "target > slower_m_s", "target < faster_m_s", "status == RETARDER_BETWEEN")),
    Rest("In this book the tables of a class stand by rising target.", ("default", "pairs", "passages"),
         ("slower < 0 || target > slower_m_s", "`target > slower_m_s` is never false",
          "faster < 0 || target < faster_m_s", "`target < faster_m_s` is never true")),
    Rest("No table of this book has a lighter one of its class behind it.", ("default", "pairs"),
         (".mass_t >= heaviest` is never false",)),
    Rest("The choice asks for what lies between two tables only where the speed lies between their targets.", LINES[1:],
         ("table->family_no == faster->family_no &&", "`table->target_m_s < commanded_m_s` is never false",
          "`commanded_m_s < faster->target_m_s` is never false")),
    Rest("All neighbours in this book are of one family.", ("default",),
         ("`table->family_no == faster->family_no` is never false", "`is_between` is never false", "`blend(")),
    Rest("All lines of this book are constants.", ("smallest",), ("`power > 0` is never true",)),
    Rest("With two stages no command can turn.", ("smallest",), ("(answer + before) == 0",)),
    Rest("Two passages, both over one sensor: there is none before or behind to be taken instead.", ("one sensor",),
         ("found == -1", "table->sensor[met] == sensor")),
    Rest("By category there is one resistance.", ("aims by category",),
         ("node < table->resistances", "resistance >= table->resistance_n_per_kn[node]",
          "lower < (table->resistances - 1)", "resistance > table->resistance_n_per_kn[lower]")),
)  # fmt: skip
"""All that the self-tests do not reach."""


@cache
def measured(name: str) -> Coverage | None:
    """What the self-test of an export reaches; None without a compiler that tells."""
    release = mcdc_release()
    if release is None:
        return None
    with tempfile.TemporaryDirectory() as folder:
        return coverage_of(EXPORTS[name](), Path(folder), release)


@pytest.mark.long
@pytest.mark.parametrize("name", EXPORTS)
def test_what_is_not_reached_is_declared_and_what_is_declared_is_not_reached(name: str) -> None:
    found = measured(name)
    if found is None:
        pytest.skip("no clang from 18 on that measures MC/DC is installed")
    places = [place for rest in RESTS if name in rest.exports for place in rest.places]
    assert [each for each in found.rest if not any(place in each for place in places)] == [], str(found)
    assert [place for place in places if not any(place in each for each in found.rest)] == [], str(found)


def test_the_page_tells_every_reason() -> None:
    page = " ".join(PAGE.read_text("utf-8").split())
    assert [rest.why for rest in RESTS if rest.why not in page] == []
