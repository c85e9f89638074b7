"""The command `computer`: how fast the control computer of a hump must be, how reliable it is, and what it pays.

What computes and what shows is imported where it is called: a refusal needs neither.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from synth.computer.settings import ComputerSettings
from synth.computer.uncertainty import ComputerOptions
from synth.frame.command import Asked, Command, Head, Limit, Steps, Work
from synth.frame.exhibits import Chapter
from synth.frame.settings.settings_file import changed, parse_settings

if TYPE_CHECKING:
    from synth.computer.computer_results import ComputerResults
    from synth.computer.resolved_computer import ResolvedComputer

PARTS = 3
"""Sizing, what it pays at the configured values, and over all uncertain inputs."""

LIMITS_OF_USE = (
    "Prices, traffic, failure rates and their ranges are inputs. Where they are assumed, so is every amount here.",
    "Uncertain inputs are independent of each other; intervals cover the chance of the draws, not of the model.",
    "Waits of trains are those of a steady queue. Near full load a hump needs weeks to come there.",
    "Controllers carry retarder positions only: no switch control, no communication. Their speeds are assumed.",
    "Failures are those of the computer. Nothing here proves a safety integrity level.",
)


def read(text: str, place: str) -> ComputerSettings:
    """The settings in the text of a file."""
    return parse_settings(ComputerSettings, text, place)


def resolve(asked: Asked[ComputerSettings, ComputerOptions]) -> ResolvedComputer:
    """The file with what is given on the command line."""
    from synth.computer.resolved_computer import resolve_computer

    given = asked.options.model_dump(exclude={"config"}, exclude_none=True)
    uncertainty = changed(asked.settings.uncertainty, **given)
    return resolve_computer(changed(asked.settings, uncertainty=uncertainty), asked.folder, asked.place)


def head(config: ResolvedComputer) -> Head:
    """What is said of the configuration."""
    return config.head


def steps(config: ResolvedComputer) -> Steps:
    """What progress counts."""
    return Steps(PARTS, "computing", "parts")


def compute(config: ResolvedComputer, work: Work) -> ComputerResults:
    """Everything."""
    from synth.computer.computer_results import computer_results

    return computer_results(config, work.progress.done)


def limits(found: ComputerResults) -> Iterator[Limit]:
    """The limits of the configuration."""
    from synth.computer.computer_results import computer_limits

    return computer_limits(found)


def show(found: ComputerResults) -> Iterator[Chapter]:
    """What is shown of it."""
    from synth.computer.shown_money import first_screen, money
    from synth.computer.shown_sizing import reliability, sizing

    yield Chapter("What it pays", (*first_screen(found), *money(found)))
    yield Chapter("How reliable", tuple(reliability(found)))
    yield Chapter("How fast", tuple(sizing(found)))


COMMAND = Command(
    name="computer",
    read=read,
    options=ComputerOptions,
    resolve=resolve,
    head=head,
    steps=steps,
    compute=compute,
    show=show,
    limits=limits,
    limits_of_use=LIMITS_OF_USE,
)
