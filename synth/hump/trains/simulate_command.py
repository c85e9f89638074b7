"""The command `hump simulate`: whole trains over a hump, in batches that are stored as they come."""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache, partial

from synth.frame.command import Asked, Command, Head, Steps, Work
from synth.frame.exhibits import Chapter
from synth.hump.configuration.trial_file import INPUTS, TrialFile, parse_trial_file, trial_text
from synth.hump.options import SimulateOptions
from synth.hump.rolling.outcomes import TrainOutcomes
from synth.hump.trains.batch import batches
from synth.hump.trains.humped_trial import HumpedTrial, trial_limits
from synth.hump.trains.shown.figures import catch_ups, couplings, figures, shift
from synth.hump.trains.shown.first_screen import first_screen
from synth.hump.trains.shown.one_train import one_train_exhibits
from synth.hump.trains.shown.positions import positions
from synth.hump.trains.speed_program import program_exhibits, pushed_chart, speed_program
from synth.hump.trains.traced_train import chosen_trains, one_train
from synth.hump.trains.train_figures import in_shifts
from synth.hump.trains.train_run import engine_for, run_of, run_trials
from synth.hump.trial.asked_trial import CHANCE_ONLY, MODEL_ONLY, NO_SAFETY, AskedTrial, asked_trial, write_inputs
from synth.hump.trial.made_trial import made_trial
from synth.hump.trial.trial import HumpTrial
from synth.kernels.cache import guarded

LIMITS_OF_USE = (
    MODEL_ONLY,
    CHANCE_ONLY,
    "A figure of 0 does not mean never: the upper end of its interval is what these trains show.",
    "Cuts that were misrouted, in contact, or stopped count as such; their couplings and gaps are not counted.",
    "Cuts that meet while both roll on their track roll on as one. Ahead of it a cut in contact does not push the one "
    "ahead, which comes as far and as fast as it would alone.",
    "Each train, or each shift of trains (tracks.shift_trains), finds standing cars of its own. In a shift tracks are "
    "pushed up and pulled between two trains, by a rule, as soon as that is needed: no train waits for it.",
    NO_SAFETY,
)


@dataclass(frozen=True)
class AskedTrains:
    """The trains of a trial, and what was typed: who humps them."""

    trial: AskedTrial
    options: SimulateOptions

    @property
    def number(self) -> int:
        """Trains that are humped."""
        return self.trial.config.settings.trains.number


def resolve(asked: Asked[TrialFile, SimulateOptions]) -> AskedTrains:
    """The trial with what was typed."""
    options = asked.options
    options.require_one("hump simulate")
    return AskedTrains(asked_trial(asked.settings, options, options.trains), options)


def head(asked: AskedTrains) -> Head:
    """What is said of it."""
    config = asked.trial.config
    return asked.trial.head(config.title, config.canonical_json)


def steps(asked: AskedTrains) -> Steps:
    """A step for each batch."""
    return Steps(batches(asked.number, asked.trial.config.settings.tracks.shift_trains), "humping", "batches")


def compute(asked: AskedTrains, work: Work) -> HumpedTrial:
    """All trains; the inputs are copied before, so that what ran can be repeated."""
    started, config = time.monotonic(), asked.trial.config
    write_inputs(asked.trial.file, config, work.directory)
    trial = guarded(made_trial, config)
    found = humped(asked, trial, work)
    work.progress.note(f"{asked.number} trains humped after {time.monotonic() - started:.1f} s")
    return HumpedTrial(config, trial, found)


def humped(asked: AskedTrains, trial: HumpTrial, work: Work) -> TrainOutcomes:
    """The outcomes of all trains, those of earlier runs among them. Raises `Unfinished` for a batch that fails."""
    run = run_of(asked.trial.config, trial, asked.number, work.directory)
    (found,) = run_trials((run,), partial(engine_for, asked.options, work.progress.note), work.progress)
    return found


def show(result: HumpedTrial) -> Iterator[Chapter]:
    """All trains first: whatever becomes of the one that is shown, their figures are written before it is humped."""
    yield Chapter("At a glance", tuple(first_screen(result)))
    yield Chapter("Figures", tuple(figures(result)))
    yield Chapter("Catch-ups", tuple(catch_ups(result)))
    yield Chapter("Couplings and gaps", tuple(couplings(result.found, result.trial.couplings)))
    yield Chapter("Positions", tuple(positions(result)))
    if in_shifts(result.found):
        yield Chapter("Shift", tuple(shift(result)))
    number = chosen_trains(result.found)[0].number
    shown = guarded(one_train, result.trial, number)
    traced = cache(shown.traced)
    yield Chapter(f"Train {number + 1}", tuple(one_train_exhibits(result, shown, traced)))
    program = program_exhibits(guarded(speed_program, result.trial, number, shown.plan), brief=False)
    yield Chapter("Hump speed", (*program, pushed_chart(number, traced)))


COMMAND = Command(
    name="hump simulate",
    read=parse_trial_file,
    options=SimulateOptions,
    resolve=resolve,
    head=head,
    steps=steps,
    compute=compute,
    show=show,
    limits=trial_limits,
    limits_of_use=LIMITS_OF_USE,
    text=trial_text,
    inputs=INPUTS,
)
