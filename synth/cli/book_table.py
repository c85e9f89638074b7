"""The end of a tune in words and figures, on stdout."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rich import box
from rich.console import Console, JustifyMethod
from rich.table import Table
from rich.text import Text

from synth.cli.permissions_column import cell, head

if TYPE_CHECKING:
    from synth.book.permissions.overview import Overview

Figures = dict[str, Any]

Ends = Sequence[float | None]
"""Low and high end of an interval; null where there is none."""

WIDTH_OF_A_FILE = 190
"""Columns where stdout is no terminal."""

LOSS, AT_REST = "table\nloss", "rms /\nat rest"
"""The second stands in the place of the first where commands come at any time."""

WITHIN, OUT_OF_BRAKE = "95 of 100\nwithin ± m/s", "out of brake\nin 10 000"

PERMITTED = "permissions"
"""A column before the last, where they were asked for."""

COLUMNS = (
    "case", "target\nm/s", "rms [95 %]\nm/s", WITHIN, "99 of 100\nwithin ± m/s",
    OUT_OF_BRAKE, "predicted /\nsimulated", LOSS, "regret", "best baseline\nm/s",
    "switch-\nings", "verdict",
)  # fmt: skip

FIRST_TO_GO = (
    "switch-\nings", LOSS, "best baseline\nm/s", "regret", "99 of 100\nwithin ± m/s",
    WITHIN, PERMITTED, OUT_OF_BRAKE,
)  # fmt: skip
"""Columns that a narrow terminal does without, in this order; what is left fits into 80 characters."""

LEGEND = (
    "95 of 100 within ±: so many cuts leave within so many m/s of the target. Out of brake: leaves more than 0.3 m/s "
    "too fast whatever a table does. Intervals and ± are 95 %."
)

GAP = 3


def print_book(summary: Figures, directory: Path, permissions: Overview | None, permissions_line: str) -> None:
    """Print the table of cases, what is infeasible, the verdict, and where everything is."""
    names = (*COLUMNS[:-1], PERMITTED, COLUMNS[-1]) if permissions else COLUMNS
    heads, rows = heads_of(names, summary["cases"], permissions), rows_of(summary["cases"], permissions)
    rows += [failed_row(case, len(names)) for case in summary["failed"]]
    styles = [None if case["feasible"] else "dim" for case in summary["cases"]] + ["dim"] * len(summary["failed"])
    console = stdout_console(WIDTH_OF_A_FILE + (widest_line(heads[-2:-1]) + GAP if permissions else 0))
    columns = columns_for(console.width, names, heads, rows)
    table = Table(box=box.SIMPLE_HEAD, title=summary["title"], title_justify="left", pad_edge=False)
    for place in columns:
        justify: JustifyMethod = "left" if names[place] in ("case", "verdict") else "right"
        table.add_column(heads[place], justify=justify, no_wrap=True)
    for style, cells in zip(styles, rows, strict=True):
        table.add_row(*(cells[place] for place in columns), style=style)
    console.print(table)
    if summary["cases"]:
        passes = summary["cases"][0]["simulated"]["passes"]
        console.print(f"{passes} stratified passes a case. {LEGEND}", soft_wrap=True)
    if permissions_line:
        console.print(permissions_line, soft_wrap=True)
    if len(columns) < len(names):
        console.print("The terminal is too narrow for all columns; every figure is in summary.json and the report.")
    for case in summary["cases"]:
        if not case["feasible"]:
            console.print(f"infeasible: {infeasible(case)}", highlight=False)
    for case in summary["cases"]:
        if case["estimate"] and case["estimate"]["left_out"]:
            told = f"{case['label']} to {case['target_speed_m_s']:g} m/s: {case['estimate']['left_out']}"
            console.print(told, soft_wrap=True, highlight=False)
    accepted = summary["accepted"]
    word = Text("accepted" if accepted else "NOT ACCEPTED", style="bold green" if accepted else "bold red")
    console.print(word + Text(f": {summary['verdict']}", style="default"), soft_wrap=True)
    files = summary["files"]
    places = [f"tables in {directory / 'tables'}", f"book {directory / 'book.h5'}"]
    if any(name.startswith("plots/") for name in files):
        places.append(f"pictures in {directory / 'plots'}")
    if "report.html" in files:
        places.append(f"report {directory / 'report.html'}")
    console.print(" · ".join(places), soft_wrap=True, highlight=False)


def stdout_console(file_width: int = WIDTH_OF_A_FILE) -> Console:
    """A console on stdout, as wide as a terminal, or wide enough for our tables."""
    console = Console(highlight=False)
    return console if console.is_terminal else Console(highlight=False, width=file_width)


def heads_of(names: tuple[str, ...], cases: list[Figures], permissions: Overview | None) -> tuple[str, ...]:
    """What stands above the columns of those names."""
    heads = {LOSS: AT_REST} if any(map(at_any_time, cases)) else {}
    if permissions is not None:
        heads[PERMITTED] = head(permissions)
    return tuple(heads.get(name, name) for name in names)


def rows_of(cases: list[Figures], permissions: Overview | None) -> list[tuple[str, ...]]:
    """The cells of all cases; a class is named in its first row."""
    labels = [None, *(case["label"] for case in cases)]
    rows = [row(case, case["label"] != before) for case, before in zip(cases, labels, strict=False)]
    if permissions is None:
        return rows
    told = (cell(each, permissions) for each in permissions.cases)
    return [(*cells[:-1], figures, cells[-1]) for cells, figures in zip(rows, told, strict=True)]


def failed_row(case: Figures, columns: int) -> tuple[str, ...]:
    """The cells of a case without a table; the verdict tells why."""
    return (case["label"], f"{case['target_m_s']:g}", *["–"] * (columns - 3), "no table")


def columns_for(width: int, names: tuple[str, ...], heads: tuple[str, ...], rows: list[tuple[str, ...]]) -> list[int]:
    """Places of the columns that fit into `width`."""
    widths = [widest_line(column) for column in zip(heads, *rows, strict=True)]
    kept = list(range(len(names)))
    for name in (each for each in FIRST_TO_GO if each in names):
        if sum(widths[place] + GAP for place in kept) > width:
            kept.remove(names.index(name))
    return kept


def widest_line(cells: Sequence[str]) -> int:
    """Characters of the longest line of some cells."""
    return max(len(line) for each in cells for line in each.split("\n"))


def row(case: Figures, first: bool) -> tuple[str, ...]:
    """The cells of one case."""
    simulated, compared, power = case["simulated"], case["comparison"], case["brake_power"]
    best = case["best_baseline"]
    return (
        case["label"] if first else "",
        f"{case['target_speed_m_s']:g}",
        plus_minus(simulated["rms_m_s"], simulated["rms_ci95_m_s"], 4),
        plus_minus(simulated["p95_m_s"], simulated["p95_ci95_m_s"], 4),
        plus_minus(simulated["p99_m_s"], simulated["p99_ci95_m_s"], 4),
        ten_thousand(power["out_of_brake"], power["out_of_brake_ci95"]),
        plus_minus(case["honesty"], case["honesty_ci95"]),
        plus_minus(case["at_rest_ratio"], case["at_rest_ratio_ci95"])
        if at_any_time(case)
        else plus_minus(case["table_loss"], case["table_loss_ci95"]),
        plus_minus(case["regret"], case["regret_ci95"]),
        f"{plus_minus(compared[best]['rms_m_s'], compared[best]['rms_ci95_m_s'], 4)} {best}" if best else "–",
        f"{simulated['switchings']:.1f}",
        case["verdict"],
    )


def at_any_time(case: Figures) -> bool:
    """Whether the table of a case commands at any time."""
    return case.get("at_rest_ratio") is not None


def infeasible(case: Figures) -> str:
    """What of an infeasible case can be served."""
    served, entry = case["served_entry_m_s"], case["entry_m_s"]
    part = f"entry speeds from {served[0]:.2f} to {served[1]:.2f} m/s are served" if served else "no entry speed is"
    return (
        f"{case['label']} to {case['target_speed_m_s']:g} m/s, {case['why_infeasible']}; {part}, "
        f"of the {entry[0]:g} to {entry[1]:g} m/s asked for"
    )


def plus_minus(value: float | None, ends: Ends, digits: int = 2) -> str:
    """A figure with the wider half of its 95 % interval, which is never printed as 0."""
    if value is None or ends[0] is None or ends[1] is None:
        return "–"
    return f"{value:.{digits}f} ±{max(value - ends[0], ends[1] - value, 0.1**digits):.{digits}f}"


def ten_thousand(value: float, ends: Ends) -> str:
    """A probability as cuts in 10 000, with the wider half of its 95 % interval; where no pass met one, a bound."""
    from synth.book.printed_numbers import few

    low, high = (1e4 * (end or 0.0) for end in ends)
    if value == 0.0:
        return f"below {few(high)}"
    return f"{few(1e4 * value)} ±{few(max(1e4 * value - low, high - 1e4 * value))}"


def speed(value: float | None) -> str:
    """m/s to a tenth of a millimetre a second."""
    return "–" if value is None else f"{value:.4f}"


def ratio(value: float | None) -> str:
    """A quotient."""
    return "–" if value is None else f"{value:.3f}"


def share(value: float | None) -> str:
    """A probability in per cent."""
    return "–" if value is None else "0" if value == 0.0 else f"{100.0 * value:.2g}"
