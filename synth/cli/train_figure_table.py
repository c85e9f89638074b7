"""The end of a hump trial in words and figures, on stdout."""

from __future__ import annotations

from pathlib import Path

from synth.frame.terminal.printed_page import Exhibit, Verdict, print_page
from synth.frame.terminal.printed_table import Column, PrintedTable
from synth.present.humping_outputs import TrialResult
from synth.present.report.figure_table import ShownFigure, shown_figure


def title(figure: ShownFigure) -> str:
    """What a figure is, and in what."""
    return f"{figure.title}{f', {figure.unit}' if figure.unit not in ('', '1/h') else ''}"


COLUMNS = (
    Column[ShownFigure]("figure", title, words=True),
    Column[ShownFigure]("value", lambda figure: figure.value),
    Column[ShownFigure]("95 %", lambda figure: figure.interval),
)


def print_trains(result: TrialResult, directory: Path) -> None:
    """The figures with their intervals, the verdict, and where the files are."""
    found, settings = result.found, result.config.settings
    page: list[Exhibit] = [
        f"{result.config.title}: trains: {len(found)}; cuts: {found.cuts.sum()}; cars: {found.cars.sum()}",
        PrintedTable(COLUMNS, [shown_figure(figure) for figure in result.figures], "summary.json and figures.csv"),
    ]
    if settings.acceptance.model_dump(exclude_none=True):
        page.append(Verdict(result.verdict.accepted, result.verdict.sentence))
    names = "summary.json, figures.csv, trains.npz, locomotive.csv, uncoupler.csv, events.csv, inputs/, batches/"
    pages = ", report.html, hump.html" * settings.output.report
    print_page(*page, f"{directory}: {names}{', plots/' * settings.output.plots}{pages}")
