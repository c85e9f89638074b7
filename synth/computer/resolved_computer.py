"""The configuration of a control computer with every default filled in, the origin of each number, and how long
the work will take: told before it begins, where it is long.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

from plant_models.hump import HumpGraph, Retarder
from plant_models.library import SourcedValue
from plant_models.library.hump_entry import HumpEntry
from synth.computer.asked import HumpFigures, asked_case, asked_mix, asked_ranges, figure_sources
from synth.computer.economics.economic_case import EconomicCase
from synth.computer.economics.ranges import Constant, Range
from synth.computer.settings import ComputerSettings, unpriced
from synth.computer.sizing.task import TaskMix
from synth.frame.command import Head
from synth.frame.faults import InputError
from synth.frame.settings.numbers import numbers_of, range_warnings
from synth.frame.settings.settings_file import in_file
from synth.hump.configuration.trial_file import hump_source
from synth.hump.hump_file import read_graph
from synth.hump.railml.write import to_railml
from tuning_tables.json_text import canonical_json

LONG_S: Final = 60.0
"""Work that takes longer than this is told."""

REQUEST_S: Final = 8e-6
MODEL_S: Final = 2e-4
"""Seconds for a simulated request, and for the money of one draw, measured on one core; only the order counts."""


def long_work(settings: ComputerSettings, ranges: Mapping[str, Range]) -> Iterator[str]:
    """A sentence on each number of `settings` that alone takes longer than `LONG_S`; `ranges` of the inputs."""
    asked, uncertain = settings.uncertainty, sum(not isinstance(each, Constant) for each in ranges.values())
    expected_s = {
        ("service.simulated_requests", settings.service.simulated_requests): REQUEST_S,
        ("uncertainty.draws", asked.draws): MODEL_S if uncertain else 0.0,
        ("uncertainty.sobol_points", asked.sobol_points): MODEL_S * (uncertain + 2) if uncertain else 0.0,
    }
    for (key, number), each_s in expected_s.items():
        takes_s = number * each_s
        if takes_s > LONG_S:
            yield (
                f"{key} is {number}; that takes about {takes_s / 60.0:.0f} min; a number up to "
                f"{int(LONG_S / each_s)} takes a minute at most"
            )


SIMULATED = "trials of 'hump simulate'"


@dataclass(frozen=True)
class ResolvedComputer:
    """Everything that the results depend on.

    `ranges`: uncertain inputs by their keys. `place`: what messages call the file.
    """

    place: str
    head: Head
    hump: HumpGraph
    settings: ComputerSettings
    mix: TaskMix
    case: EconomicCase
    ranges: Mapping[str, Range]

    @property
    def positions(self) -> int:
        """Retarders of the hump, each with its own controller task."""
        return sum(isinstance(vertex, Retarder) for vertex in self.hump.vertices)


def resolve_computer(settings: ComputerSettings, folder: Path, place: str) -> ResolvedComputer:
    """Fill in what `settings` leave open; `InputError` names file, key and value of whatever does not fit.

    `place`: what messages call the file. Paths in it begin at `folder`.
    """
    try:
        hump = read_graph(hump_source(settings.hump, folder)).entry
    except InputError as fault:
        raise InputError(*(f"{place}: hump: {sentence}" for sentence in fault.sentences)) from None
    figures = figure_sources(settings.rates, folder, place)
    with in_file(place):
        mix, case = asked_mix(settings.task), asked_case(settings, figures)
        ranges = asked_ranges(settings, figures)
    return ResolvedComputer(
        place=place,
        head=head_of(settings, hump, figures, ranges),
        hump=hump.graph,
        settings=settings,
        mix=mix,
        case=case,
        ranges=ranges,
    )


def head_of(settings: ComputerSettings, hump: HumpEntry, figures: HumpFigures, ranges: Mapping[str, Range]) -> Head:
    """What is said of the configuration; what is only shown is not in its hash."""
    parameters = tuple(numbers(settings, figures))
    tree = {
        "hump_sha256": hashlib.sha256(to_railml(hump)).hexdigest(),
        "trials_sha256": dict(figures.sha256),
        "today": figures.today.model_dump(),
        "change": figures.change.model_dump(),
        **settings.model_dump(mode="json", exclude={"title", "hump", "rates", "acceptance", "output"}),
        "acceptance": settings.acceptance.model_dump(),
    }
    return Head(
        title=settings.title or f"Control computer of: {hump.title}",
        canonical_json=canonical_json(tree).decode(),
        parameters=parameters,
        output=settings.output,
        warnings=(*range_warnings(parameters), *long_work(settings, ranges), *unpriced(settings)),
        reads=figures.reads,
    )


def numbers(settings: ComputerSettings, figures: HumpFigures) -> Iterator[SourcedValue]:
    """Every number with its origin; the figures of simulated trains stand in the place of those of the file."""
    simulated = {} if figures.found is None else {"today": figures.today, "change": figures.change}
    for each in numbers_of(settings):
        section, _, rest = each.key.partition(".")
        part, _, key = rest.partition(".")
        if section == "rates" and part in simulated:
            yield replace(each, value=getattr(simulated[part], key), source=SIMULATED)
        else:
            yield each
