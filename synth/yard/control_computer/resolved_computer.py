"""The configuration of a control computer with every default filled in, and the origin of each number."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from dataclasses import dataclass

from plant_models.errors import require
from plant_models.hump import HumpGraph, Retarder
from plant_models.library import SourcedValue
from synth.configuration.computer.computer_file import ComputerFile
from synth.configuration.computer.settings import ComputerSettings
from synth.configuration.plant_fault import in_file
from synth.configuration.railml.write import to_railml
from synth.configuration.resolved_config import range_warnings
from synth.yard.control_computer.asked_money import asked_case, asked_ranges, figure_sources
from synth.yard.control_computer.asked_service import Service, asked_cycle, asked_mix, asked_service
from synth.yard.control_computer.computer_parameters import computer_numbers
from synth.yard.control_computer.economics.economic_case import EconomicCase
from synth.yard.control_computer.economics.uncertainty.ranges import Range
from synth.yard.control_computer.long_work import long_work
from synth.yard.control_computer.reliability.upkeep import Upkeep, asked_upkeep
from synth.yard.control_computer.sizing.carried_positions import PositionTimes
from synth.yard.control_computer.sizing.cyclic_service import Cycle
from synth.yard.control_computer.sizing.task import TaskMix
from tuning_tables.canonical import canonical_json


@dataclass(frozen=True)
class ResolvedComputer:
    """Everything that the results depend on.

    `ranges`: uncertain inputs by their keys. `parameters`: every number with unit, range, source and whether it is
    assumed; `warnings`: sentences about values outside their sensible range, and about long work. `place`: what
    messages call the file.
    """

    place: str
    title: str
    hump: HumpGraph
    mix: TaskMix
    service: Service
    cycle: Cycle
    times: PositionTimes
    upkeep: Upkeep
    case: EconomicCase
    ranges: Mapping[str, Range]
    settings: ComputerSettings
    parameters: tuple[SourcedValue, ...]
    warnings: tuple[str, ...]
    names: Mapping[str, object]

    @property
    def positions(self) -> int:
        """Retarders of the hump, each with its own controller task."""
        return sum(isinstance(vertex, Retarder) for vertex in self.hump.vertices)

    @property
    def canonical_json(self) -> str:
        """What the figures depend on, in one form: the same for the same figures, whatever files are called."""
        numbers = {value.key: value.value for value in self.parameters}
        tree = {"format": "control-computer", "version": 1, **self.names, "numbers": numbers}
        return canonical_json(tree).decode("utf-8")

    @property
    def sha256(self) -> str:
        """SHA-256 of `canonical_json` in UTF-8, hexadecimal."""
        return hashlib.sha256(self.canonical_json.encode()).hexdigest()


def resolve_computer(file: ComputerFile) -> ResolvedComputer:
    """Fill in the defaults; `InputError` names file, key and value of whatever does not fit."""
    settings, place = file.settings, file.place
    figures = figure_sources(settings.rates, file.folder, place)
    with in_file(place, lambda sentence: sentence):
        mix, service, cycle = asked_mix(settings.task), asked_service(settings.service), asked_cycle(settings.cycle)
        times = PositionTimes(**settings.position.model_dump())
        upkeep = asked_upkeep(settings.reliability)
        case = asked_case(settings, figures)
        ranges = asked_ranges(settings, figures)
        points = settings.uncertainty.sobol_points
        require(points & (points - 1) == 0, f"uncertainty.sobol_points is {points}; it must be a power of 2")
    parameters = tuple(computer_numbers(settings, figures))
    return ResolvedComputer(
        place=place,
        title=settings.title or f"Control computer of: {file.hump.title}",
        hump=file.hump.graph,
        mix=mix,
        service=service,
        cycle=cycle,
        times=times,
        upkeep=upkeep,
        case=case,
        ranges=ranges,
        settings=settings,
        parameters=parameters,
        warnings=(*range_warnings(parameters), *long_work(settings, ranges)),
        names={
            "hump_sha256": hashlib.sha256(to_railml(file.hump)).hexdigest(),
            "tasks": [json.loads(task.model_dump_json()) for task in settings.task],
            "discipline": settings.service.discipline,
            "reliability": [settings.reliability.structure, settings.reliability.failed_check_to],
            "ranges": [json.loads(each.model_dump_json()) for each in settings.range],
            "trials": figures.sha256,
            "currency": settings.prices.currency,
        },
    )
