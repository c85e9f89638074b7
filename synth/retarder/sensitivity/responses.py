"""The numbers of a plant that nobody at the yard has measured, and how far each may be from what is assumed; the tables
that stay as they are, tuned here or read from a file; and what these do, an output each, at the points of a hypercube:
every point another plant, the same passes.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

import numpy as np

from plant_models import Plant, PlantError
from plant_models.frozen_arrays import Floats
from plant_models.library.sourced_value import SET_BY_USER
from synth.frame.printed_numbers import counted
from synth.frame.workers.engine import Tell
from synth.problem.problem import OVERSPEED_M_S
from synth.retarder.class_setup import class_setup, origin_of, validation_passes
from synth.retarder.configuration.cut_class import CutClass
from synth.retarder.configuration.plant_values import Parameter, parameters, sensible_range, with_values
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.retarder.forms.tables_at import tables_at
from synth.retarder.served_class import plant_for
from synth.retarder.tuned_table import solutions, tuned_table
from synth.simulation.closed_loop import TableController
from synth.simulation.common_passes import common_passes
from synth.simulation.passes import ExitSample
from synth.simulation.random_passes import RandomPasses
from synth.solver.descent import one_blas_thread
from tuning_tables import ControllerTable

MASS: Final = "cut.mass_t"

NEVER_VARIED: Final = {
    "retarder.stage_pressures_kpa": "read at a gauge; the library has no range for all of them together",
    "retarder.pneumatics.closing_delay_s": "with a narrow dead band the stages would hunt, which the model refuses",
}
"""Keys that are held although the library has a range for them, and why."""


def varied_parameters(
    config: ResolvedConfig, cut_class: CutClass, plant: Plant, target_m_s: float
) -> tuple[Parameter, ...]:
    """Every parameter of `plant` that has a range in the library, uniform from its `low` to its `high`.

    `target_m_s`: the highest that the cut is to leave with. Ranges are those of the library, within what physics and
    use allow, and wide enough to hold the value itself. The mass goes over its category: every cut has its own. What
    the user's configuration sets is held: the yard knows it.
    """
    known = set_by_user(config, cut_class)
    own = {"cut." + value.key.partition(".")[2]: sensible_range(value) for value in cut_class.provenance}
    found = []
    for parameter in parameters(config, cut_class, plant, target_m_s):
        if parameter.key in NEVER_VARIED:
            continue
        span = parameter.sensible or own.get(parameter.key)
        if parameter.key == MASS:
            span = parameter.low, parameter.high
        if parameter.key in known:
            span = parameter.nominal, parameter.nominal
        if span is not None:
            found.append(within_limits(parameter, span))
    return tuple(found)


def within_limits(parameter: Parameter, span: tuple[float, float]) -> Parameter:
    """`parameter` over `span` as far as its limits allow."""
    nominal = parameter.nominal
    low, high = max(min(span[0], nominal), parameter.low), min(max(span[1], nominal), parameter.high)
    return replace(parameter, low=low, high=high)


def set_by_user(config: ResolvedConfig, cut_class: CutClass) -> frozenset[str]:
    """Keys that the user's configuration sets, but the mass of a class, which only says which category it is."""
    retarder = (value.key for value in config.retarder.provenance if value.source == SET_BY_USER)
    cut = ("cut." + v.key.partition(".")[2] for v in cut_class.provenance if v.source == SET_BY_USER)
    return frozenset((*retarder, *cut)) - {MASS}


def moving(classes: Sequence[Sequence[Parameter]]) -> tuple[str, ...]:
    """Keys that are not held in all classes, in the order of the first class."""
    free = {each.key for varied in classes for each in varied if each.high > each.low}
    return tuple(each.key for each in classes[0] if each.key in free)


def values_at(
    varied: Mapping[str, Parameter], keys: Sequence[str], row: Sequence[float]
) -> Iterator[tuple[str, float]]:
    """(key, value) at the point `row` of the unit cube; its numbers belong to `keys`."""
    for key, u in zip(keys, row, strict=True):
        if varied[key].high > varied[key].low:  # so that a number that is held keeps every bit
            yield key, varied[key].low + (varied[key].high - varied[key].low) * u


@dataclass(frozen=True)
class FixedTables:
    """The tables of one class, in the order of their targets, and its nominal plant."""

    cut_class: CutClass
    plant: Plant
    tables: tuple[ControllerTable, ...]


def tables_in(path: Path, config: ResolvedConfig, source: str) -> tuple[FixedTables, ...]:
    """The tables in `path` with the classes of `config` that they fit; `InputError` where there is none."""
    tables = tables_at(path).only_lines("sensitivity --table")
    labels = [plant_for(table, config, source)[0] for table in tables]
    found = []
    for cut_class in config.cuts:
        own = [table for table, label in zip(tables, labels, strict=True) if label == cut_class.label]
        if own:
            ordered = tuple(sorted(own, key=lambda table: table.target_speed_m_s))
            found.append(FixedTables(cut_class, config.plant_of(cut_class), ordered))
    return tuple(found)


@one_blas_thread()
def tables_tuned(config: ResolvedConfig, created: str, workers: int, tell: Tell) -> tuple[FixedTables, ...]:
    """The tables that a tune of `config` makes: the same lines, to the bit."""

    def of(cut_class: CutClass) -> FixedTables:
        plant = config.plant_of(cut_class)
        origin = origin_of(config.sha256, created)
        setup = class_setup(config, cut_class.label, plant, validation_passes(config).part(0, 1), origin)
        found = solutions(setup.design, config.aims_of(cut_class.label))
        tables = tuple(tuned_table(setup, solution).table for solution in found)
        tell(f"{cut_class.label}: {counted(len(tables), 'table')} tuned")
        return FixedTables(cut_class, plant, tables)

    with ThreadPoolExecutor(max_workers=workers) as pool:
        return tuple(pool.map(of, config.cuts))


@dataclass(frozen=True)
class Output:
    """`figure` makes the number from the exit errors (n,) and weights (n,) of the passes."""

    name: str
    title: str
    unit: str
    figure: Callable[[Floats, Floats], float]

    def of(self, sample: ExitSample, target_m_s: float) -> float:
        """The number of a sample; a stalled pass counts with exit speed 0, as in `exit_statistics`."""
        return self.figure(sample.exit_speed_m_s - target_m_s, sample.weight)


OUTPUTS: Final = (
    Output("rms_m_s", "rms exit error", "m/s", lambda e, w: math.sqrt(float(w @ e**2 / w.sum()))),
    Output("bias_m_s", "mean exit error", "m/s", lambda e, w: float(w @ e / w.sum())),
    Output(
        "overspeed", f"share over +{OVERSPEED_M_S:g} m/s", "1", lambda e, w: float(w @ (e > OVERSPEED_M_S) / w.sum())
    ),
)
"""The first is what the ranking is told by."""

AT_ONCE = 25
"""Points of one task of a thread."""


def responses(
    plant: Plant,
    tables: Sequence[ControllerTable],
    varied: Mapping[str, Parameter],
    keys: Sequence[str],
    unit: Floats,
    passes: RandomPasses,
    threads: int,
) -> Floats:
    """The outputs, (tables, outputs, points), at the points `unit` (points, keys); `threads` change no bit of them.

    Raises `PlantError` that names the values of a point which the plant refuses.
    """
    controllers = [TableController(table) for table in tables]

    def at(row: list[float]) -> list[list[float]]:
        values = dict(values_at(varied, keys, row))
        try:
            run = common_passes(with_values(plant, values), passes).run
        except PlantError as fault:
            told = ", ".join(f"{key} {value:.6g}" for key, value in values.items())
            raise PlantError(f"{fault} (at the values {told})") from fault
        samples = [run(controller) for controller in controllers]
        return [
            [output.of(sample, table.target_speed_m_s) for output in OUTPUTS]
            for sample, table in zip(samples, tables, strict=True)
        ]

    def part(first: int) -> list[list[list[float]]]:
        return [at(row) for row in unit[first : first + AT_ONCE].tolist()]

    with ThreadPoolExecutor(max_workers=threads) as pool:
        found = [point for points in pool.map(part, range(0, len(unit), AT_ONCE)) for point in points]
    return np.moveaxis(np.array(found), 0, -1)
