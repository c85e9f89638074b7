"""retarder-synth from Python: from a problem to a validated table. See docs/python.md.

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
    from synth.configuration.hump import load_hump
    from synth.problem.aim import Aim
    from synth.problem.criterion import Criterion
    from synth.problem.problem import Problem
    from synth.problem.resolution import Resolution

__all__ = [
    "Aim",
    "Criterion",
    "EntrySpeed",
    "FittedLines",
    "Plant",
    "Problem",
    "Resolution",
    "Simulated",
    "car_names",
    "fit",
    "load_car",
    "load_config",
    "load_hump",
    "load_position",
    "load_problem",
    "load_weight_categories",
    "plot_passes",
    "plot_table",
    "position_names",
    "predict",
    "simulate",
    "solve",
    "tabulate",
    "trace",
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
    "load_hump": "synth.configuration.hump",
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
