"""What is shown of permissions: ratios by case, the figures behind them, and a picture."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from synth.book.permissions.overview import asked_of, median_ratios, medians
from synth.book.permissions.permission import AllPermissions, CasePermissions
from synth.frame.exhibits import Chart, Column, Exhibit, Row, Sentence, Table
from synth.frame.interval import Interval
from synth.frame.printed_numbers import decimals, per_cent
from synth.simulation.exit_statistics import ExitStatistics

CASE = (Column("case", "case", words=True, once=True), Column("target_m_s", "target", "m/s"))
FIGURES = (
    *CASE,
    Column("permission", "permission", words=True),
    Column("ratio", "rms / rms as configured", form=decimals(2)),
    Column("predicted_rms_m_s", "predicted rms", "m/s", decimals(4)),
    Column("rms_m_s", "rms", "m/s", decimals(4)),
    Column("bias_m_s", "mean error", "m/s", decimals(4)),
    Column("std_m_s", "its deviation", "m/s", decimals(4)),
    Column("p95_m_s", "95 of 100 within", "m/s", decimals(4)),
    Column("p99_m_s", "99 of 100 within", "m/s", decimals(4)),
    Column("overspeed", "over-speed", form=per_cent),
    Column("stalled", "stops", form=per_cent),
    Column("switchings", "commands a cut"),
    Column("time_s", "time", "s"),
)
MISSING = (*CASE, Column("permission", "permission", words=True), Column("reason", "reason", words=True))
AS_CONFIGURED = "as configured"


def permissions(title: str, told: AllPermissions) -> Iterator[Exhibit]:
    """A row for each case and a column for each permission; then every figure."""
    asked = asked_of(told.cases)
    columns = (
        *CASE,
        Column("configured_m_s", "rms as configured", "m/s", decimals(4), spare=2),
        *(Column(each.value, each.value, form=decimals(2), spare=1) for each in asked),
    )
    yield Table(
        "permissions", "Rms over that of the table as configured", columns, [ratios(case) for case in told.cases], True
    )
    passes = told.cases[0].table.passes
    yield Sentence(
        f"{passes} stratified passes a case, the same for every column. Columns of permissions: rms over that of the "
        f"table as configured, with its 95 % interval. Medians: {medians(told.cases)}.",
        {"median_ratios": median_ratios(told.cases)},
        brief=True,
    )
    yield from missing(told)
    yield Chart(
        "permissions",
        "What permissions of the hardware would give",
        "Paired on common passes, bars: 95 %. Left of 1: a smaller error than the table as configured.",
        lambda: _picture().ratio_rows(title, told.cases),
    )
    yield Table("figures", "Every figure", FIGURES, [row for case in told.cases for row in figures(case)])


def missing(told: AllPermissions) -> Iterator[Exhibit]:
    """What cannot be told, and why; nothing where all is told."""
    rows: list[Row] = [
        {"case": case.label, "target_m_s": case.target_speed_m_s, "permission": each.permission.value,
         "reason": each.reason}
        for case in told.cases
        for each in case.failed
    ]  # fmt: skip
    rows += [{"case": each.label, "target_m_s": each.target_m_s, "reason": each.reason} for each in told.failed]
    if rows:
        yield Table("missing", "What cannot be told; without a permission: the case has no table", MISSING, rows, True)


def ratios(case: CasePermissions) -> Row:
    """The ratios of one case by the names of the permissions."""
    row: dict[str, Any] = {
        "case": case.label,
        "target_m_s": case.target_speed_m_s,
        "configured_m_s": Interval(case.table.rms_m_s, *case.table.rms_ci95_m_s, case.table.passes),
    }
    for each in case.results:
        row[each.permission.value] = Interval(each.ratio, *each.ratio_ci95, case.table.passes)
    return row


def figures(case: CasePermissions) -> Iterator[Row]:
    """The table as configured, then each permission."""
    head = {"case": case.label, "target_m_s": case.target_speed_m_s}
    yield {**head, "permission": AS_CONFIGURED, "predicted_rms_m_s": case.predicted_rms_m_s, **of(case.table)}
    for each in case.results:
        yield {
            **head,
            "permission": each.permission.value,
            "ratio": Interval(each.ratio, *each.ratio_ci95, case.table.passes),
            "predicted_rms_m_s": each.predicted_rms_m_s,
            **of(each.statistics),
        }


def of(found: ExitStatistics) -> Row:
    """The figures of a closed loop with their intervals."""
    n = found.passes
    return {
        "rms_m_s": Interval(found.rms_m_s, *found.rms_ci95_m_s, n),
        "bias_m_s": Interval(found.bias_m_s, *found.bias_ci95_m_s, n),
        "std_m_s": found.std_m_s,
        "p95_m_s": Interval(found.p95_m_s, *found.p95_ci95_m_s, n),
        "p99_m_s": Interval(found.p99_m_s, *found.p99_ci95_m_s, n),
        "overspeed": Interval(found.overspeed, *found.overspeed_ci95, n),
        "stalled": Interval(found.stalled, *found.stalled_ci95, n),
        "switchings": Interval(found.switchings, *found.switchings_ci95, n),
        "time_s": Interval(found.time_s, *found.time_ci95_s, n),
    }


def _picture() -> Any:
    from synth.book.permissions import picture  # matplotlib

    return picture
