"""The page that plays the same trains of several runs, one below the other on one clock."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from synth.frame.exhibits import Exhibit, File, Sentence
from synth.hump.comparison.compared_runs import HumpedRun
from synth.hump.comparison.compared_trains import compared_trains
from synth.hump.trains.chosen_trains import ChosenTrain
from synth.hump.trains.hump_page.hump_page import PLAYER, PlayedRun, hump_page
from synth.hump.trains.made_trial import made_trial
from synth.hump.trains.outcomes import TrainOutcomes
from synth.hump.trains.traced_train import OneTrain, some_trains
from synth.kernels.cache import guarded


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
