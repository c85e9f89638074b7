"""The command `hump design`: the design test of a hump, by single cars that run badly and well; the numbers that it
depends on, and all of that in one text.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import replace
from typing import Final

from plant_models.library import SourcedValue
from synth.frame.command import Asked, Command, Head, Steps, Work
from synth.frame.exhibits import Chapter
from synth.frame.faults import InputError
from synth.frame.settings.numbers import numbers_of
from synth.hump.configuration.sections import DesignSettings
from synth.hump.configuration.trial_file import TrialFile, parse_trial_file, trial_text
from synth.hump.design.found_design import FoundDesign, design_limits, found_design
from synth.hump.design.hump_under_test import hump_under_test
from synth.hump.design.options import DesignOptions
from synth.hump.design.shown import design, fall_and_brakes, triple
from synth.hump.trial.asked_trial import MODEL_ONLY, NO_SAFETY, AskedTrial
from synth.hump.trial.resolved_trial import ResolvedTrial, resolve_trial
from synth.kernels.cache import guarded
from tuning_tables.json_text import canonical_json

OF_TRIAL: Final = ("hump.", "position.", "exit_speeds.usable_share", "couplings.allowed_m_s", "hump_speed.early_s")
"""Beginnings of the keys of a trial that count for its hump."""


def design_parameters(config: ResolvedTrial) -> tuple[SourcedValue, ...]:
    """Those of hump, positions and runners."""
    of_hump = (each for each in config.parameters if each.key.startswith(OF_TRIAL))
    return (*of_hump, *numbers_of(config.settings.design, "design", DesignSettings()))


def design_json(config: ResolvedTrial) -> str:
    """What the figures depend on, in one form."""
    names = json.loads(config.trains_json)
    numbers = {each.key: each.value for each in design_parameters(config) if not each.key.startswith("hump.")}
    kept = {key: names[key] for key in ("hump_sha256", "lead", "categories", "positions", "roles")}
    return canonical_json({"format": "hump-design", **kept, "numbers": numbers}).decode("utf-8")


LIMITS_OF_USE = (
    MODEL_ONLY,
    "The test has three single cars whose resistance is told and known, and positions without error. What chance and "
    "errors do to whole trains is told by hump simulate.",
    "Time that the beams of a retarder need between two cars is not in the test: the interval at a retarder is the "
    "time in which it is empty.",
    NO_SAFETY,
)


def resolve(asked: Asked[TrialFile, DesignOptions]) -> AskedTrial:
    """The trial, with the hump speed that was typed."""
    file, speed = asked.settings, asked.options.speed
    if speed is not None:
        design = file.settings.design.model_copy(update={"hump_speed_m_s": speed})
        file = replace(file, settings=file.settings.model_copy(update={"design": design}))
    config = resolve_trial(file)
    if len(config.routes.routes) < 2:
        raise InputError(f"{asked.place}: the hump has one track; the test needs two that part")
    return AskedTrial(file, config)


def head(asked: AskedTrial) -> Head:
    """What is said of it."""
    told = asked.head(f"Design test. {asked.config.hump.title}", design_json(asked.config))
    return replace(told, parameters=design_parameters(asked.config))


def compute(asked: AskedTrial, work: Work) -> FoundDesign:
    """The whole test."""
    found = guarded(found_design, asked, hump_under_test(asked.config))
    work.progress.done(f"{len(found.intervals.pairs)} pairs of tracks")
    return found


def show(found: FoundDesign) -> Iterator[Chapter]:
    """What is found first, then what it rests on."""
    yield Chapter("Design test", tuple(design(found)))
    yield Chapter("Fall and brakes", tuple(fall_and_brakes(found)))
    yield Chapter("The worst triple", tuple(triple(found)))


COMMAND = Command(
    name="hump design",
    read=parse_trial_file,
    options=DesignOptions,
    resolve=resolve,
    head=head,
    steps=lambda asked: Steps(1, "testing", "humps"),
    compute=compute,
    show=show,
    limits=design_limits,
    limits_of_use=LIMITS_OF_USE,
    text=trial_text,
)
