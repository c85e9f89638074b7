"""retarder-synth from Python: from a problem to a validated table. See docs/how-to/python.md.

Importing this package is instant: what a name stands for is imported when it is first used.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from plant_models import EntrySpeed, Plant
    from plant_models.library import car_names, load_car, load_position, load_weight_categories, position_names
    from synth.api import (
        FittedLines,
        Simulated,
        fit,
        load_config,
        load_problem,
        plot_passes,
        plot_table,
        predict,
        simulate,
        solve,
        tabulate,
        trace,
    )
    from synth.hump.control.event_file import read_events, write_events
    from synth.hump.control.hump_control import HumpControl, Operation
    from synth.hump.control.hump_state import replayed
    from synth.hump.control.machine_record import machine_record, record_of_word
    from synth.hump.control.moving_cut import moving_cut
    from synth.hump.control.practice_rules import PracticeRules
    from synth.hump.control.reference_track import ReferenceTrack
    from synth.hump.control.route_table import RouteTable
    from synth.hump.control.sorting_list_file import load_sorting_list
    from synth.hump.control.train_population import TrainPopulation
    from synth.hump.hump_file import load_hump
    from synth.problem.aim import Aim
    from synth.problem.criterion import Criterion
    from synth.problem.problem import Problem
    from synth.problem.resolution import Resolution
    from synth.simulation.passage_loop import close_passage_loop
    from synth.simulation.sensor_fault_figures import fault_figures, single_faults

__all__ = [
    "Aim",
    "Criterion",
    "EntrySpeed",
    "FittedLines",
    "HumpControl",
    "Operation",
    "Plant",
    "PracticeRules",
    "Problem",
    "ReferenceTrack",
    "Resolution",
    "RouteTable",
    "Simulated",
    "TrainPopulation",
    "car_names",
    "close_passage_loop",
    "fault_figures",
    "fit",
    "load_car",
    "load_config",
    "load_hump",
    "load_position",
    "load_problem",
    "load_sorting_list",
    "load_weight_categories",
    "machine_record",
    "moving_cut",
    "plot_passes",
    "plot_table",
    "position_names",
    "predict",
    "read_events",
    "record_of_word",
    "replayed",
    "simulate",
    "single_faults",
    "solve",
    "tabulate",
    "trace",
    "write_events",
]

_LIBRARY = ("car_names", "load_car", "load_position", "load_weight_categories", "position_names")

_HOMES = {
    **dict.fromkeys(_LIBRARY, "plant_models.library"),
    "Aim": "synth.problem.aim",
    "Criterion": "synth.problem.criterion",
    "EntrySpeed": "plant_models",
    "Plant": "plant_models",
    "Problem": "synth.problem.problem",
    "Resolution": "synth.problem.resolution",
    "load_hump": "synth.hump.hump_file",
    "HumpControl": "synth.hump.control.hump_control",
    "Operation": "synth.hump.control.hump_control",
    "PracticeRules": "synth.hump.control.practice_rules",
    "ReferenceTrack": "synth.hump.control.reference_track",
    "RouteTable": "synth.hump.control.route_table",
    "TrainPopulation": "synth.hump.control.train_population",
    "load_sorting_list": "synth.hump.control.sorting_list_file",
    "machine_record": "synth.hump.control.machine_record",
    "moving_cut": "synth.hump.control.moving_cut",
    "read_events": "synth.hump.control.event_file",
    "record_of_word": "synth.hump.control.machine_record",
    "replayed": "synth.hump.control.hump_state",
    "write_events": "synth.hump.control.event_file",
    "close_passage_loop": "synth.simulation.passage_loop",
    "fault_figures": "synth.simulation.sensor_fault_figures",
    "single_faults": "synth.simulation.sensor_fault_figures",
}
"""Where a public name is defined, if not in `synth.api`."""


def __getattr__(name: str) -> Any:
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = getattr(import_module(_HOMES.get(name, "synth.api")), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
