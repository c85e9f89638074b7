"""The end of a tune for point sensors in words and figures, on stdout."""

from __future__ import annotations

from pathlib import Path

from rich import box
from rich.table import Table
from rich.text import Text

from synth.cli.book_table import Figures, failed_row, plus_minus, stdout_console, ten_thousand

COLUMNS = (
    "case", "target\nm/s", "rms [95 %]\nm/s", "for want of\nbrake, m/s", "95 of 100\nwithin ± m/s",
    "out of brake\nin 10 000", "predicted /\nsimulated", "switch-\nings", "verdict",
)  # fmt: skip

LEGEND = (
    "For want of brake: what of the rms no table can avoid. 95 of 100 within ±: so many cuts leave within so many m/s "
    "of the target. Out of brake: leaves more than 0.3 m/s too fast even at full brake. Intervals and ± are 95 %."
)


def print_sensors(summary: Figures, directory: Path) -> None:
    """Print the table of cases, the verdict, and where everything is."""
    console = stdout_console()
    table = Table(box=box.SIMPLE_HEAD, title=summary["title"], title_justify="left", pad_edge=False)
    for name in COLUMNS:
        table.add_column(name, justify="left" if name in ("case", "verdict") else "right", no_wrap=True)
    before = None
    for case in summary["cases"]:
        table.add_row(*row(case, case["label"] != before), style=None if case["feasible"] else "dim")
        before = case["label"]
    for case in summary["failed"]:
        table.add_row(*failed_row(case, len(COLUMNS)), style="dim")
    console.print(table)
    passes = summary["cases"][0]["simulated"]["passes"]
    console.print(f"{passes} stratified passes a case. {LEGEND}", soft_wrap=True)
    accepted = summary["accepted"]
    word = Text("accepted" if accepted else "NOT ACCEPTED", style="bold green" if accepted else "bold red")
    console.print(word + Text(f": {summary['verdict']}", style="default"), soft_wrap=True)
    files = summary["files"]
    places = [f"tables in {directory / 'tables'}", f"code in {directory / 'c'} and {directory / 'st'}"]
    if any(name.startswith("plots/") for name in files):
        places.append(f"pictures in {directory / 'plots'}")
    if "report.html" in files:
        places.append(f"report {directory / 'report.html'}")
    console.print(" · ".join(places), soft_wrap=True, highlight=False)


def row(case: Figures, first: bool) -> tuple[str, ...]:
    """The cells of one case."""
    simulated, power = case["simulated"], case["brake_power"]
    return (
        case["label"] if first else "",
        f"{case['target_speed_m_s']:g}",
        plus_minus(simulated["rms_m_s"], simulated["rms_ci95_m_s"], 4),
        plus_minus(case["unavoidable_rms_m_s"], case["unavoidable_ci95_m_s"], 4),
        plus_minus(simulated["p95_m_s"], simulated["p95_ci95_m_s"], 4),
        ten_thousand(power["out_of_brake"], power["out_of_brake_ci95"]),
        plus_minus(case["honesty"], case["honesty_ci95"]),
        f"{simulated['switchings']:.1f}",
        case["verdict"],
    )
