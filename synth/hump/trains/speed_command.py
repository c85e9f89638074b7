"""The command `hump speed`: the plan of one train, which humps nothing."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass

from synth.frame.command import Asked, Command, Head, Steps, Work
from synth.frame.exhibits import Chapter
from synth.hump.configuration.trial_file import TrialFile, parse_trial_file, trial_text
from synth.hump.limits_of_use import MODEL_ONLY, NO_SAFETY
from synth.hump.trains.asked_trial import AskedTrial, asked_trial
from synth.hump.trains.made_trial import made_trial
from synth.hump.trains.shown.program import planned_chart, program_exhibits
from synth.hump.trains.speed_program import SpeedProgram, speed_program
from synth.hump.trains.trial_options import SpeedOptions
from synth.kernels.cache import guarded
from tuning_tables.canonical import canonical_json

LIMITS_OF_USE = (
    "A plan expects of each cut what is usual of its weight category, and brakes each position evenly along the path; "
    "how such trains fare is told by hump simulate.",
    MODEL_ONLY,
    NO_SAFETY,
)


@dataclass(frozen=True)
class AskedProgram:
    """The program of the train `number`, from 0, of a trial."""

    trial: AskedTrial
    number: int


def resolve(asked: Asked[TrialFile, SpeedOptions]) -> AskedProgram:
    """The trial with what was typed, and the train that is planned."""
    return AskedProgram(asked_trial(asked.settings, asked.options), asked.options.train - 1)


def head(asked: AskedProgram) -> Head:
    """What is said of it."""
    config = asked.trial.config
    depends = {"train": asked.number + 1, "trial": json.loads(config.trains_json)}
    title = f"Program of train {asked.number + 1}: {config.title}"
    return asked.trial.head(title, canonical_json(depends).decode("utf-8"))


def compute(asked: AskedProgram, work: Work) -> SpeedProgram:
    """The program."""
    program = guarded(speed_program, guarded(made_trial, asked.trial.config), asked.number)
    work.progress.done(f"train {asked.number + 1}: {len(program.rows)} cuts")
    return program


def show(program: SpeedProgram) -> Iterator[Chapter]:
    """What is shown of it."""
    yield Chapter("Program", (*program_exhibits(program, brief=True), planned_chart(program)))


COMMAND = Command(
    name="hump speed",
    read=parse_trial_file,
    options=SpeedOptions,
    resolve=resolve,
    head=head,
    steps=lambda asked: Steps(1, "planning", "trains"),
    compute=compute,
    show=show,
    limits_of_use=LIMITS_OF_USE,
    text=trial_text,
)
