"""The end of a plan of point sensors in words and figures, on stdout."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from synth.book.sensors.layout_results import LayoutResults
from synth.book.sensors.layout_summary import judged, rounded
from synth.cli.printed_page import Verdict, print_page
from synth.cli.printed_table import Column, PrintedTable

Layout = dict[str, Any]
"""A layout of the summary and its name; a radar has neither sensors nor places."""


def places(layout: Layout) -> str | None:
    """Where the sensors are."""
    return ", ".join(f"{place:g}" for place in layout["path_m"]) if "path_m" in layout else None


COLUMNS = (
    Column[Layout]("layout", lambda layout: layout["layout"], words=True),
    Column[Layout]("sensors", lambda layout: str(layout["sensors"]) if "sensors" in layout else None),
    Column[Layout]("rms, m/s", lambda layout: f"{layout['rms_m_s']:.4f}"),
    Column[Layout]("sensors at, m", places, words=True, spare=1),
)


def print_plan(results: LayoutResults, directory: Path) -> None:
    """The layouts of each number of sensors, what stands beside them, and which were chosen."""
    layouts = [
        {"layout": name, **judged(results, layout)}
        for plan in results.plans
        for name, layout in (("planned", plan.best), ("equal sections", plan.equal))
    ]
    layouts.append({"layout": "by the rule", **judged(results, results.rule)})
    layouts.append({"layout": "radar", "rms_m_s": rounded(results.radar_mean_rms_m_s)})
    wanted = f"an rms of at most {rounded(results.wanted_rms_m_s):g} m/s"
    if results.chosen is None:
        verdict = Verdict(False, f"none of these numbers of sensors gives {wanted}")
    else:
        verdict = Verdict(True, f"{results.chosen.deciding + 1} sensors are the fewest that give {wanted}")
    files = f"{directory}: plots/, {'sensors.toml, ' * (results.chosen is not None)}summary.json"
    print_page(PrintedTable(COLUMNS, layouts, "summary.json"), verdict, files)
