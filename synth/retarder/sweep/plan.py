"""The plan of a sweep: one unit of work for every condition and cut class, named by the hash of all it depends on; and
the fewest tables for a stated loss: start with coarse targets, bisect where lines between two tables lose too much.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any, Generic, TypeVar

from plant_models import Plant
from plant_models.library import BUILT_IN, Library
from synth.frame.workers.engine import software_sha256
from synth.problem.resolution import finer_for_check
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.retarder.sweep.sweep_file import Condition, SweepFile
from synth.solver.chain.grid import make_grid, memory_estimate_bytes
from tuning_tables.json_text import canonical_json

TARGETS_AT_ONCE = 8
"""Targets solved in one sweep of the programme: more save little time and take memory in proportion."""

PROCESS_BYTES = 350 * 2**20
"""What a worker takes before it solves anything: interpreter, libraries, compiled kernels, random numbers."""


@dataclass(frozen=True)
class Refinement:
    """Targets are refined until lines between two tables lose at most `loss_m_s`, steps kept at `smallest_step_m_s`."""

    loss_m_s: float
    smallest_step_m_s: float


@dataclass(frozen=True)
class UnitOrder:
    """All that a worker must know to compute one unit; made of plain values, to be sent to another process or machine.

    `key`: SHA-256 of what the result depends on; `tree`: the configuration with one [[cut]], as TOML would give it;
    `library` has the user's own types that it names.
    """

    key: str
    condition: str
    label: str
    tree: dict[str, Any]
    config_sha256: str
    created: str
    software: str
    refinement: Refinement | None
    library: Library = BUILT_IN

    @property
    def name(self) -> str:
        """The unit in messages."""
        return f"{self.condition}/{self.label}" if self.condition else self.label


@dataclass(frozen=True)
class Unit:
    """An order with what it will take: `memory_bytes` at its peak, `work` in proportion to its time."""

    order: UnitOrder
    memory_bytes: int
    work: float


@dataclass(frozen=True)
class Plan:
    """Every unit, conditions outermost, classes in the order of the configuration."""

    conditions: tuple[Condition, ...]
    units: tuple[Unit, ...]

    def of(self, condition: Condition) -> tuple[Unit, ...]:
        """The units of one condition."""
        return tuple(unit for unit in self.units if unit.order.condition == condition.name)


def plan_of(file: SweepFile, created: str) -> Plan:
    """The plan for what `file` asks; `created` is the date that all tables will bear."""
    return Plan(file.conditions, tuple(unit for each in file.conditions for unit in units_of(each, file, created)))


def units_of(condition: Condition, file: SweepFile, created: str) -> Iterator[Unit]:
    """The units of one condition."""
    settings, config, software = file.settings, condition.config, software_sha256()
    loss = settings.interpolation_loss_m_s
    refinement = None if loss is None else Refinement(loss, settings.smallest_step_m_s)
    for cut, tree, (label, plant) in zip(config.cuts, condition.tree["cut"], config.plants(), strict=True):
        one = replace(config, cuts=(cut,))
        order = UnitOrder(
            key=unit_key(one, condition.name, refinement, software),
            condition=condition.name,
            label=label,
            tree={**condition.tree, "cut": [tree]},
            config_sha256=config.sha256,
            created=created,
            software=software,
            refinement=refinement,
            library=condition.library,
        )
        yield Unit(order, unit_memory_bytes(plant, one), unit_work(plant, one))


def unit_key(config: ResolvedConfig, condition: str, refinement: Refinement | None, software: str) -> str:
    """SHA-256 of the canonical form (RFC 8785) of all that the tables of a unit depend on, their date excepted."""
    document = {
        "format": "retarder-sweep-unit",
        "condition": condition,
        "config": json.loads(config.canonical_json()),
        "refinement": None if refinement is None else vars(refinement),
        "software": software,
    }
    return hashlib.sha256(canonical_json(document)).hexdigest()


def unit_memory_bytes(plant: Plant, config: ResolvedConfig) -> int:
    """What a worker holds at its peak, from the sizes of the largest arrays; `config` has one class."""
    grid = make_grid(plant, config.resolution_of(plant))
    nodes, points, stages = len(grid.path_m), len(grid.speed_m_s), plant.top_stage + 1
    width = min(len(config.problems()), TARGETS_AT_ONCE)
    solved = 8 * width * nodes * points * 4 * stages
    return PROCESS_BYTES + memory_estimate_bytes(plant, config.grids(plant)) + solved


def unit_work(plant: Plant, config: ResolvedConfig) -> float:
    """In proportion to the time of a unit: state space of solver and check, times the targets."""
    design = config.resolution_of(plant)
    points = [
        len(grid.path_m) * len(grid.speed_m_s) * resolution.friction_nodes
        for resolution in (design, finer_for_check(design))
        for grid in (make_grid(plant, resolution),)
    ]
    return float(sum(points) * plant.top_stage * (2 + len(config.problems())))


ROUNDING = 1e-9

Table = TypeVar("Table")


@dataclass(frozen=True)
class Gap:
    """Between two targets: rms at the middle with its own table and with the lines between, exactly predicted.

    `refined`: the loss was too large, and the table at the middle is kept.
    """

    low_m_s: float
    high_m_s: float
    own_rms_m_s: float
    between_rms_m_s: float
    refined: bool

    @property
    def middle_m_s(self) -> float:
        """Where it was measured: where lines between two are farthest from both."""
        return 0.5 * (self.low_m_s + self.high_m_s)

    @property
    def loss_m_s(self) -> float:
        """How much the lines between lose; below 0 where they are better than the table's own."""
        return self.between_rms_m_s - self.own_rms_m_s


@dataclass(frozen=True)
class Bench(Generic[Table]):
    """What refining needs: `tune` makes tables for targets, the rms of one at its target, of lines between two."""

    tune: Callable[[Sequence[float]], list[Table]]
    own_rms_m_s: Callable[[Table], float]
    between_rms_m_s: Callable[[Table, Table, float], float]


def refined(
    targets_m_s: Sequence[float], bench: Bench[Table], wanted: Refinement
) -> tuple[list[Table], tuple[Gap, ...]]:
    """Tables by rising target, and every gap that was measured, by rising middle.

    All `targets_m_s` are kept. A gap is split while its loss exceeds the one wanted and its halves are no shorter than
    the smallest step. Every gap left has been measured, so that the loss of the book is known where it is too large.
    """
    rising = sorted(targets_m_s)
    kept = dict(zip(rising, bench.tune(rising), strict=True))
    measured: list[Gap] = []
    open_gaps = list(pairwise(rising))
    while open_gaps:
        middles = [0.5 * (low + high) for low, high in open_gaps]
        found = [
            measured_gap(low, high, kept[low], own, kept[high], bench, wanted)
            for (low, high), own in zip(open_gaps, bench.tune(middles), strict=True)
        ]
        measured += [gap for gap, _ in found]
        kept |= {gap.middle_m_s: own for gap, own in found if gap.refined}
        open_gaps = [
            half
            for gap, _ in found
            if gap.refined
            for half in ((gap.low_m_s, gap.middle_m_s), (gap.middle_m_s, gap.high_m_s))
        ]
    ordered = tuple(sorted(measured, key=lambda gap: gap.middle_m_s))
    return [kept[target] for target in sorted(kept)], ordered


def measured_gap(
    low_m_s: float, high_m_s: float, slower: Table, own: Table, faster: Table, bench: Bench[Table], wanted: Refinement
) -> tuple[Gap, Table]:
    """One gap measured, with the table tuned for its middle."""
    middle, half = 0.5 * (low_m_s + high_m_s), 0.5 * (high_m_s - low_m_s)
    best, between = bench.own_rms_m_s(own), bench.between_rms_m_s(slower, faster, middle)
    too_much = between - best > wanted.loss_m_s
    return Gap(low_m_s, high_m_s, best, between, too_much and half >= wanted.smallest_step_m_s - ROUNDING), own
