"""What is shown of permissions: ratios by case, the figures behind them, and a picture."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from synth.frame.exhibits import Chart, Column, Exhibit, Row, Sentence, Table, Tile, Tiles
from synth.frame.interval import Interval
from synth.frame.printed_numbers import counted, decimals
from synth.retarder.exit_figures import CASE, LOOP, PREDICTED, loop_row
from synth.retarder.permissions.permission import AllPermissions, CasePermissions, asked_of, median_ratios, medians

FIGURES = (
    *CASE,
    Column("permission", "permission", words=True),
    Column("ratio", "rms / rms as configured", form=decimals(2)),
    PREDICTED,
    *LOOP,
)
MISSING = (*CASE, Column("permission", "permission", words=True), Column("reason", "reason", words=True))
AS_CONFIGURED = "as configured"


def permissions(title: str, told: AllPermissions) -> Iterator[Exhibit]:
    """A row for each case and a column for each permission; then every figure."""
    asked = asked_of(told.cases)
    yield from first_screen(told.cases)
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


def first_screen(cases: Sequence[CasePermissions]) -> Iterator[Exhibit]:
    """A tile for each permission, and which one to ask for."""
    found = median_ratios(cases)
    yield Tiles(
        [Tile(f"{ratio:.2f} times", f"the rms as configured, in the median: {name}") for name, ratio in found.items()]
    )
    if not found:
        return
    best = min(found, key=lambda name: found[name])
    given = [result for case in cases for result in case.results if result.permission.value == best]
    smaller = sum(result.ratio_ci95[1] < 1.0 for result in given)
    step = "Leave the hardware as it is: no permission makes the rms smaller for sure in more than half of the cases."
    if found[best] < 1.0 and 2 * smaller > len(given):
        step = (
            f"Ask what '{best}' costs: it gives {found[best]:.2f} times the rms in the median case, and makes it "
            f"smaller for sure in {smaller} of {counted(len(given), 'case')}."
        )
    yield Sentence(step, to_do=True)


def missing(told: AllPermissions) -> Iterator[Exhibit]:
    """What cannot be told, and why; nothing where all is told."""
    rows: list[Row] = [
        {"label": case.label, "target_speed_m_s": case.target_speed_m_s, "permission": each.permission.value,
         "reason": each.reason}
        for case in told.cases
        for each in case.failed
    ]  # fmt: skip
    rows += [{"label": each.label, "target_speed_m_s": each.target_m_s, "reason": each.reason} for each in told.failed]
    if rows:
        yield Table(
            "missing", "What cannot be decided; without a permission: the case has no table", MISSING, rows, True
        )


def ratios(case: CasePermissions) -> Row:
    """The ratios of one case by the names of the permissions."""
    row: dict[str, Any] = {
        "label": case.label,
        "target_speed_m_s": case.target_speed_m_s,
        "configured_m_s": Interval(case.table.rms_m_s, *case.table.rms_ci95_m_s, case.table.passes),
    }
    for each in case.results:
        row[each.permission.value] = Interval(each.ratio, *each.ratio_ci95, case.table.passes)
    return row


def figures(case: CasePermissions) -> Iterator[Row]:
    """The table as configured, then each permission."""
    head = {"label": case.label, "target_speed_m_s": case.target_speed_m_s}
    yield {**head, "permission": AS_CONFIGURED, "predicted_rms_m_s": case.predicted_rms_m_s, **loop_row(case.table)}
    for each in case.results:
        yield {
            **head,
            "permission": each.permission.value,
            "ratio": Interval(each.ratio, *each.ratio_ci95, case.table.passes),
            "predicted_rms_m_s": each.predicted_rms_m_s,
            **loop_row(each.statistics),
        }


def _picture() -> Any:
    from synth.retarder.permissions import picture  # matplotlib

    return picture
