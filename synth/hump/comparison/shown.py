"""What is shown of runs side by side: each figure of each run, and what it is more than in the first."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any, Final

from synth.frame.exhibits import Column, Exhibit, Row, Sentence, Table
from synth.frame.interval import Interval
from synth.hump.comparison.compared_runs import HumpedRun
from synth.hump.trains.shift_sums import in_shifts, shifts_in
from synth.hump.trains.shown.figures import in_hundred, titles_of
from synth.hump.trains.train_figures import FigureOf, figures_told, interval_of

FEWEST_EVENTS: Final = 10
"""Cuts in both runs together that a difference of shares needs: with fewer its interval holds the truth too seldom."""

HOW_TO_READ: Final = (
    "All runs humped the same trains. 'More than' tells a figure less that of the first run, paired by train, or by "
    "shift, with its 95 % interval; grey where the interval holds 0, so that these trains do not decide whether there "
    "is a difference. "
    f"A share has no difference where fewer than {FEWEST_EVENTS} cuts of both runs count."
)


def undecided(difference: Any) -> bool:
    """Whether an interval holds 0."""
    return isinstance(difference, Interval) and difference.low95 <= 0.0 <= difference.high95


def figures(runs: Sequence[HumpedRun]) -> Iterator[Exhibit]:
    """A table of means and one of shares, a row a figure and run."""
    first, trains = runs[0], len(runs[0].found)
    yield Sentence(
        f"{len(runs)} runs of the same {trains} trains, {int(first.found.cuts.sum())} cuts",
        {"trains": trains, "runs": {run.name: run.config.sha256 for run in runs}},
        brief=True,
    )
    told = figures_told(first.found)
    more = f"more than {first.name}"
    counted = "trains, or shifts" if any(in_shifts(run.found) for run in runs) else "trains"
    for columns, name, title, is_share in (
        (mean_columns(more, counted), "means", "Means over trains", False),
        (share_columns(more), "shares", "Shares of cuts", True),
    ):
        rows = [row_of(each, run, first) for each in told if each.is_share == is_share for run in runs]
        yield Table(name, title, columns, rows, brief=True)
    yield Sentence(HOW_TO_READ)


NAMES: Final = (
    Column("title", "figure", words=True, once=True),
    Column("name", "name", words=True, code=True),
    Column("run", "run", words=True),
)


def mean_columns(more: str, counted: str) -> tuple[Column, ...]:
    """Those of means; `more`: what a difference is called; `counted`: what n counts."""
    return (
        *NAMES,
        Column("value", "mean"),
        Column("unit", "unit", words=True),
        Column("difference", more, grey=undecided),
        Column("n", counted, spare=1),
    )


def share_columns(more: str) -> tuple[Column, ...]:
    """Those of shares, in per cent."""
    return (
        *NAMES,
        Column("value", "share", "%", in_hundred),
        Column("difference", more, "%", in_hundred, grey=undecided),
        Column("n", "cuts", spare=1),
    )


def row_of(figure: FigureOf, run: HumpedRun, first: HumpedRun) -> Row:
    """One figure of one run."""
    found = figure.figure(run.found)
    return {
        "title": titles_of(first.config.settings.couplings)[figure.name],
        "name": figure.name,
        "run": run.name,
        "value": found.told,
        "unit": None if figure.unit == "1" else figure.unit,
        "difference": None if run is first else difference(figure, run, first),
        "n": found.n,
    }


def difference(figure: FigureOf, run: HumpedRun, first: HumpedRun) -> Interval | float | None:
    """What the figure of `run` is more than that of the first run, where the trains tell it."""
    events = figure.hits(run.found).sum() + figure.hits(first.found).sum()
    if figure.is_share and events < FEWEST_EVENTS:
        return None
    return interval_of(*figure.difference(run.found, first.found), min(shifts_in(run.found), shifts_in(first.found)))
