"""What is shown of a retune: what is gained case by case, the numbers behind it, and the new tables."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any, Final

from synth.frame.exhibits import Chart, Column, Exhibit, File, Row, Sentence, Table, Tile, Tiles
from synth.frame.interval import Interval
from synth.frame.printed_numbers import decimals, four_figures
from synth.logs.retune.retune import CaseGain, Retuned
from synth.retarder.failed_case import FailedCase
from tuning_tables import to_json
from tuning_tables.hdf5_file import book_bytes

CASES: Final = (
    Column("label", "case", words=True, once=True),
    Column("target_speed_m_s", "target", "m/s"),
    Column("old_rms_m_s", "rms before", "m/s", decimals(4)),
    Column("new_rms_m_s", "rms after", "m/s", decimals(4)),
    Column("ratio", "ratio", form=decimals(3)),
    Column("p_value", "p, no better", form="{:.2g}".format, spare=1),
    Column("table", "table", words=True),
)
FAILED: Final = (
    Column("label", "case", words=True),
    Column("target_m_s", "target", "m/s"),
    Column("reason", "reason", words=True),
)
NUMBERS: Final = (
    Column("key", "key", words=True),
    Column("before", "configured", form=four_figures),
    Column("value", "identified", form=four_figures),
    Column("unit", "unit", words=True),
)
NEW, KEPT = "new", "kept: within noise"


def changed_sentence(found: Retuned) -> str:
    """How many cases get new tables."""
    changed, n = len(found.changed), found.estimate.passes
    if not changed:
        return (
            f"within noise: no table tuned for what {n} passes say is better beyond doubt than the old one in any of "
            f"{len(found.gains)} cases, judged together; no book is written"
        )
    return (
        f"{changed} of {len(found.gains)} cases get new tables, from {n} passes; {len(found.gains) - changed} are "
        "within noise and keep their lines"
    )


def failed_sentence(found: Retuned, case: FailedCase) -> str:
    """Why a case has no new table, and what it has instead."""
    kept = "the old one is kept" if case.case in found.old else "and no old one"
    return f"{case.name}: no new table, {kept}: {case.reason}"


def gained(found: Retuned) -> Iterator[Exhibit]:
    """The rms of every case under both tables."""
    yield tiles(found)
    yield Table("cases", "rms by case", CASES, [case_row(found, each) for each in found.gains], brief=True)
    if found.failed:
        yield Table("failed", "Cases without a new table", FAILED, [vars(case) for case in found.failed])
    if found.gains:
        yield from pictures(found)


def tiles(found: Retuned) -> Tiles:
    """How many tables are new, and the largest gain."""
    best = min(found.gains, key=lambda gain: gain.ratio, default=None)
    made = [Tile(f"{len(found.changed)} of {len(found.gains)}", "cases get new tables; the others keep their lines")]
    if best is not None:
        low, high = best.ratio_ci95
        words = f"the rms of the old table has the new one at best [{low:.2f}, {high:.2f}]: {best.label} to"
        made.append(Tile(f"{best.ratio:.2f} times", f"{words} {best.target_m_s:g} m/s"))
    return Tiles(made)


def case_row(found: Retuned, gain: CaseGain) -> Row:
    """One case; the interval is told by the plants that the estimate leaves likely."""
    return {
        "label": gain.label,
        "target_speed_m_s": gain.target_m_s,
        "old_rms_m_s": gain.old_rms_m_s,
        "new_rms_m_s": gain.new_rms_m_s,
        "ratio": Interval(gain.ratio, *gain.ratio_ci95, gain.plants),
        "p_value": gain.p_value,
        "table": NEW if gain in found.changed else KEPT,
    }


def pictures(found: Retuned) -> Iterator[Exhibit]:
    """All cases, and the lines of that with the largest gain."""
    most = min(found.changed or found.gains, key=lambda gain: gain.ratio)
    yield Chart(
        "retune-gains",
        "rms after over rms before",
        "rms of exit less target under the new table over that under the old one, on the plants the passes leave "
        "likely; bars: 95 % intervals of each case alone, of passes and estimate. Grey: within noise when all cases "
        "are judged together (Holm), the case keeps its table.",
        lambda: _pictures().gains(found),
    )
    yield Chart(
        "retune-lines",
        "Lines before and after",
        f"{most.label} to {most.target_m_s:g} m/s, where most is gained: lines above which a stage is raised, before "
        "and after.",
        lambda: _pictures().before_after(found, most),
    )


def numbers(found: Retuned) -> Iterator[Exhibit]:
    """What the passes say, and the configuration with it."""
    estimate = found.estimate
    yield Sentence(
        f"Identified from {estimate.passes} passes.",
        {
            "passes": estimate.passes,
            "identified_config": json.loads(found.identified.canonical_json()),
            "identified_config_sha256": found.identified.sha256,
        },
    )
    rows = [
        {
            "key": one.key,
            "before": one.value(0.0),
            "value": Interval(one.value(float(estimate.u[i])), *estimate.interval(i), estimate.passes),
            "unit": one.unit,
        }
        for i, one in enumerate(estimate.unknowns)
    ]
    yield Table("numbers", "Numbers", NUMBERS, rows)


def files(found: Retuned) -> Iterator[Exhibit]:
    """The new book, and each of its tables; none where nothing is better."""
    if not found.tables:
        yield Sentence("No table is better beyond doubt, so no book is written.")
        return
    yield Sentence(
        f"book.h5 holds {len(found.tables)} tables, kept ones too, with their figures for the identified plant."
    )
    for table in found.tables:
        yield File(f"tables/{table.id}.json", to_json(table))
    yield File("book.h5", book_bytes(found.tables))


def _pictures() -> Any:
    from synth.logs.retune import pictures  # matplotlib

    return pictures
