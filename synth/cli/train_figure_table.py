"""The end of a hump trial in words and figures, on stdout."""

from __future__ import annotations

from pathlib import Path

from synth.present.humping_outputs import TrialResult
from synth.present.report.figure_table import shown_figure


def print_trains(result: TrialResult, directory: Path) -> None:
    """The figures with their intervals, the verdict, and where the files are."""
    found, settings = result.found, result.config.settings
    print(f"{result.config.title}: trains: {len(found)}; cuts: {found.cuts.sum()}; cars: {found.cars.sum()}")
    for figure in result.figures:
        shown = shown_figure(figure)
        title = f"{shown.title}{f', {shown.unit}' if shown.unit not in ('', '1/h') else ''}"
        print(f"{title:<46}{shown.value:>8}  {shown.interval}")
    if settings.acceptance.model_dump(exclude_none=True):
        print(f"{'accepted' if result.verdict.accepted else 'not accepted'}: {result.verdict.sentence}")
    names = "summary.json, figures.csv, trains.npz, locomotive.csv, uncoupler.csv, events.csv, inputs/, batches/"
    pages = ", report.html, hump.html" * settings.output.report
    print(f"{directory}: {names}{', plots/' * settings.output.plots}{pages}")
