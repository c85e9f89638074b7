"""The command `hump compare`: figures of several runs on the same trains, by how much each is more than in the first,
and the page that plays such trains, one below the other on one clock.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, Final

import numpy as np

from synth.frame.command import Asked, Command, Head, Steps, Work
from synth.frame.exhibits import Chapter, Column, Exhibit, File, Row, Sentence, Table
from synth.frame.interval import Interval
from synth.frame.settings.toml_file import read_text
from synth.hump.compared_runs import HumpedRun, Runs, compared_trains, config_in, runs_in
from synth.hump.options import CompareOptions
from synth.hump.rolling.outcomes import TrainOutcomes
from synth.hump.trains.hump_page.hump_page import PLAYER, PlayedRun, hump_page
from synth.hump.trains.shown.figures import in_hundred, titles_of
from synth.hump.trains.traced_train import ChosenTrain, OneTrain, some_trains
from synth.hump.trains.train_figures import FigureOf, figures_told, in_shifts, interval_of, shifts_in
from synth.hump.trial.asked_trial import CHANCE_ONLY, MODEL_ONLY
from synth.hump.trial.made_trial import made_trial
from synth.kernels.cache import guarded
from tuning_tables.json_text import canonical_json


def played(runs: Sequence[HumpedRun]) -> Iterator[Exhibit]:
    """The page, and which trains it plays; in its place a warning, where a run would hump them otherwise today."""
    chosen = compared_trains(runs)
    again = [humped_again(run, chosen) for run in runs]
    for run, trains in zip(runs, again, strict=True):
        for train in trains:
            if not as_told(train, run.found):
                yield Sentence(
                    f"Warning: {run.name} was humped by another version of this program, which did otherwise in train "
                    f"{train.number + 1}. So no page plays the trains; hump it again: retarder-synth hump "
                    "simulate with its inputs/config.toml",
                    brief=True,
                )
                return
    titles = [each.title for each in chosen]
    shown = [
        PlayedRun(
            run.name, run.config.hump, tuple(train.traced() for train in trains),
            run.config.categories.members,
            run.config.settings.couplings,
        )
        for run, trains in zip(runs, again, strict=True)
    ]  # fmt: skip
    title = "The same trains: " + " | ".join(run.name for run in runs)
    yield File(PLAYER, hump_page(title, shown, titles).encode(), "Play the trains of all runs on one clock")
    yield Sentence(f"{PLAYER} plays {'; '.join(titles)}", {"played": [each.number + 1 for each in chosen]}, brief=True)


def humped_again(run: HumpedRun, chosen: Sequence[ChosenTrain]) -> tuple[OneTrain, ...]:
    """The chosen trains of a run."""
    trial = guarded(made_trial, run.config)
    return guarded(some_trains, trial, [each.number for each in chosen])


def as_told(again: OneTrain, found: TrainOutcomes) -> bool:
    """Whether a train that was humped again came to what its run has kept."""
    now = again.outcomes()
    return all(
        np.array_equal(getattr(now, name)[again.lane], getattr(found, name)[again.number])
        for name in ("caught", "caught_in_last", "stopped", "overspeed", "span_s")
    )


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


LIMITS_OF_USE = (
    MODEL_ONLY,
    CHANCE_ONLY,
    "Several differences are told at once: of twenty that are none, one is outside its interval.",
)


def text_of(folder: Path, template: str) -> str:
    """The configuration of the run in `folder`."""
    return read_text(config_in(folder), template)


def resolve(asked: Asked[Path, CompareOptions]) -> Runs:
    """All runs; refused where they humped different trains."""
    return runs_in((asked.settings, *asked.options.others))


def head(runs: Runs) -> Head:
    """What is said of them: the parameters are those of the first."""
    first = runs[0].config
    names = [run.name for run in runs]
    told = {"format": "hump-comparison", "runs": [[run.name, run.config.sha256] for run in runs]}
    return Head(
        title=f"{', '.join(names[1:])} beside {names[0]}",
        canonical_json=canonical_json(told).decode("utf-8"),
        parameters=first.parameters,
        output=first.settings.output,
        warnings=tuple(dict.fromkeys(warning for run in runs for warning in run.config.warnings)),
    )


def compute(runs: Runs, work: Work) -> Runs:
    """Nothing is computed: figures and trains are made when they are shown."""
    work.progress.note(f"{len(runs)} runs of {len(runs[0].found)} trains read")
    return runs


def show(runs: Runs) -> Iterator[Chapter]:
    """Every figure of every run; then a few trains, which are humped again to be played."""
    yield Chapter("Figures", tuple(figures(runs)))
    if runs[0].config.settings.output.report:
        yield Chapter("Trains side by side", tuple(played(runs)))


COMMAND = Command(
    name="hump compare",
    read=lambda text, place: Path(place),
    options=CompareOptions,
    resolve=resolve,
    head=head,
    steps=lambda runs: Steps(1, "comparing", "comparisons"),
    compute=compute,
    show=show,
    limits_of_use=LIMITS_OF_USE,
    text=text_of,
)
