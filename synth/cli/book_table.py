"""The end of a tune in words and figures, on stdout."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from rich import box
from rich.console import Console
from rich.table import Table
from rich.text import Text

Figures = dict[str, Any]

WIDTH_OF_A_FILE = 180
"""Columns where stdout is no terminal."""

COLUMNS = (
    "case", "target\nm/s", "rms [95 %]\nm/s", "pre-\ndicted", "honesty", "table\nloss", "bound\nm/s", "regret",
    "best baseline\nm/s", "as published\npred. → sim.", "switch-\nings", "over-\nspeed", "stalls", "verdict",
)  # fmt: skip

FIRST_TO_GO = (
    "stalls",
    "bound\nm/s",
    "switch-\nings",
    "over-\nspeed",
    "best baseline\nm/s",
    "as published\npred. → sim.",
)
"""Columns that a narrow terminal does without, in this order."""

GAP = 2


def print_book(summary: Figures, directory: Path) -> None:
    """Print the table of cases, what is infeasible, the verdict, and where everything is."""
    console = stdout_console()
    rows = rows_of(summary["cases"])
    columns = columns_for(console.width, rows)
    table = Table(box=box.SIMPLE_HEAD, title=summary["title"], title_justify="left", pad_edge=False)
    for place in columns:
        name = COLUMNS[place]
        table.add_column(name, justify="left" if name in ("case", "verdict") else "right", no_wrap=True)
    for case, cells in zip(summary["cases"], rows, strict=True):
        table.add_row(*(cells[place] for place in columns), style=None if case["feasible"] else "dim")
    console.print(table)
    if len(columns) < len(COLUMNS):
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


def stdout_console() -> Console:
    """A console on stdout, as wide as a terminal, or wide enough for our tables."""
    console = Console(highlight=False)
    return console if console.is_terminal else Console(highlight=False, width=WIDTH_OF_A_FILE)


def rows_of(cases: list[Figures]) -> list[tuple[str, ...]]:
    """The cells of all cases; a class is named in its first row."""
    labels = [None, *(case["label"] for case in cases)]
    return [row(case, case["label"] != before) for case, before in zip(cases, labels, strict=False)]


def columns_for(width: int, rows: list[tuple[str, ...]]) -> list[int]:
    """Places of the columns that fit into `width`."""
    lines = [[line for cell in column for line in cell.split("\n")] for column in zip(COLUMNS, *rows, strict=True)]
    kept = list(range(len(COLUMNS)))
    for name in FIRST_TO_GO:
        if sum(max(map(len, lines[place])) + GAP for place in kept) > width:
            kept.remove(COLUMNS.index(name))
    return kept


def row(case: Figures, first: bool) -> tuple[str, ...]:
    """The cells of one case."""
    simulated, compared = case["simulated"], case["comparison"]
    published, best = compared["as published"], case["best_baseline"]
    low, high = simulated["rms_ci95_m_s"]
    return (
        case["label"] if first else "",
        f"{case['target_speed_m_s']:g}",
        f"{speed(simulated['rms_m_s'])} [{speed(low)}, {speed(high)}]",
        speed(simulated["predicted_rms_m_s"]),
        ratio(case["honesty"]),
        ratio(case["table_loss"]),
        speed(compared["friction known"]["rms_m_s"]),
        ratio(case["regret"]),
        f"{best} {speed(compared[best]['rms_m_s'])}" if best else "–",
        f"{speed(published['predicted_rms_m_s'])} → {speed(published['rms_m_s'])}",
        f"{simulated['switchings']:.1f}",
        share(simulated["overspeed"]),
        share(simulated["stalls"] / simulated["passes"]),
        case["verdict"],
    )


def infeasible(case: Figures) -> str:
    """What of an infeasible case can be served."""
    served, entry = case["served_entry_m_s"], case["entry_m_s"]
    part = f"entry speeds from {served[0]:.2f} to {served[1]:.2f} m/s are served" if served else "no entry speed is"
    return (
        f"{case['label']} to {case['target_speed_m_s']:g} m/s, {case['why_infeasible']}; {part}, "
        f"of the {entry[0]:g} to {entry[1]:g} m/s asked for"
    )


def speed(value: float | None) -> str:
    """m/s to the millimetre."""
    return "–" if value is None else f"{value:.3f}"


def ratio(value: float | None) -> str:
    """A quotient."""
    return "–" if value is None else f"{value:.2f}"


def share(value: float) -> str:
    """A probability."""
    return "0" if value == 0.0 else f"{value:.2%}"
