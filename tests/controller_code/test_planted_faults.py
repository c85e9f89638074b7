"""Faults planted everywhere in the exported C are found by its self-test, but for those that change nothing."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from scripts.studies.in_the_loop.controller_process import sources_of
from tests.controller_code.conftest import ToChange
from tests.controller_code.planted_faults import planted_faults
from tests.controller_code.sample_book import surface_book
from tests.effort import sized
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
