"""The laws that a table has to beat, each tuned as a competent engineer would, and run on the passes that it had.

Both are switching lines. They are tuned on the rms exit error of simulated passes: a coarse grid, then a simplex
search from its best point.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import product
from math import ceil
from typing import Any

import numpy as np

from plant_models.frozen_arrays import Floats
from synth.retarder.comparison.measured import Measured
from synth.simulation.closed_loop import ClosedLoop, LineController
from synth.simulation.common_passes import CommonPasses
from synth.simulation.exit_statistics import exit_statistics, rms_ratio
from synth.simulation.passes import ExitSample
from synth.solver.switching_lines import SwitchingLines
from tuning_tables import ControllerTable, Decisions

LINE_NODES = 129
"""Nodes of the lines; only the energy rule's are not constant."""

FIRST_LOOK_PASSES, COARSE_PASSES = 50, 150
"""Passes for the coarse grid: all of its points, then the best of them; far too early or late shows in few.

In the default book (15 cases) the same point wins as with 150 passes for all.
"""

LOOKED_AT_AGAIN = 0.25
"""Share of the grid that is worth more passes."""

REFINEMENTS_PER_PARAMETER = 10
"""Simulations that the simplex search may take, for each continuous parameter of a law."""

PASSES_PER_PARAMETER = 150
"""Passes of each such simulation, for each continuous parameter; more parameters need a finer eye.

With 600 for every law, the simpler ones came out 0.2 to 0.5 % better on the average of the default book (20 000 fresh
passes).
"""


@dataclass(frozen=True)
class TunedBaseline:
    """A baseline with the parameters found, and its rms on the passes for tuning."""

    name: str
    parameters: dict[str, float]
    controller: LineController
    rms_m_s: float


@dataclass(frozen=True)
class Family:
    """A law with free parameters.

    `build(loop, target, brake_stage, *values)` makes the controller; `names`, `grids` and `bounds` belong to
    `values`. A law that chooses its stages itself (`one_stage` false) is only built with the top stage.
    """

    name: str
    build: Callable[..., LineController]
    one_stage: bool
    names: tuple[str, ...]
    grids: tuple[tuple[float, ...], ...]
    bounds: tuple[tuple[float, float], ...]

    def deciding(self, decisions: Decisions) -> Family:
        """The same law, asked at rest or at any time."""

        def build(*arguments: Any) -> LineController:
            return replace(self.build(*arguments), decisions=decisions)

        return replace(self, build=build)


def relay(
    loop: ClosedLoop, target_m_s: float, brake_stage: int, release_m_s: float, width_m_s: float
) -> LineController:
    """Brake with one stage above V_target + release + width, release below V_target + release.

    Without width it is a single threshold.
    """
    lower = np.full((loop.stages, LINE_NODES), -np.inf)
    upper = np.full((loop.stages, LINE_NODES), np.inf)
    lower[1:] = target_m_s + release_m_s
    upper[:brake_stage] = target_m_s + release_m_s + width_m_s
    return LineController(SwitchingLines(line_nodes_m(loop), lower, upper))


def energy_rule(
    loop: ClosedLoop,
    target_m_s: float,
    top_stage: int,
    friction: float,
    offset_m_s: float,
    lead_s: float,
    hysteresis_m_s: float,
) -> LineController:
    """The least stage whose remaining work suffices: up above V_k(s), down below V_{k−1}(s) − hysteresis.

    V_k(s)² = (V_target + offset)² + 2·(work of stage k at the friction factor `friction` and of the mean
    resistance − work of gravity, from s to the exit), per unit of inertia.
    """
    path = loop.path
    nodes = line_nodes_m(loop)
    resistance = path.drag_m_s2_per_n_kn * loop.plant.resistance.mean_n_per_kn
    pressures = loop.stage_overpressures_kpa[: top_stage + 1, None]
    slowing = friction * path.brake_m_s2_per_kpa * pressures + resistance - path.gravity_m_s2
    done = np.zeros((top_stage + 1, len(path.edges_m)))
    np.cumsum(slowing * np.diff(path.edges_m), axis=1, out=done[:, 1:])
    left = done[:, -1:] - np.stack([np.interp(nodes, path.edges_m, row) for row in done])
    speeds = np.sqrt(np.maximum((target_m_s + offset_m_s) ** 2 + 2.0 * left, 0.0))
    lower = np.full((loop.stages, LINE_NODES), -np.inf)
    upper = np.full((loop.stages, LINE_NODES), np.inf)
    lower[1 : top_stage + 1] = speeds[:-1] - hysteresis_m_s
    upper[:top_stage] = speeds[:-1]
    return LineController(SwitchingLines(nodes, lower, upper), lead_s=lead_s)


def line_nodes_m(loop: ClosedLoop) -> Floats:
    """Equally spaced nodes from where the regulator acts to the exit."""
    return np.linspace(loop.plant.start_m, loop.plant.exit_m, LINE_NODES)


SPEED_BOUNDS, TIME_BOUNDS = (-1.0, 2.0), (0.0, 2.0)

FAMILIES = (
    Family(
        name="relay",
        build=relay,
        one_stage=True,
        names=("release_m_s", "width_m_s"),
        grids=((-0.2, 0.0, 0.1, 0.2, 0.4), (0.0, 0.2)),
        bounds=(SPEED_BOUNDS, (0.0, 2.0)),
    ),
    Family(
        name="energy rule",
        build=energy_rule,
        one_stage=False,
        names=("friction", "offset_m_s", "lead_s", "hysteresis_m_s"),
        grids=((0.7, 0.85, 1.0, 1.2), (0.0, 0.1, 0.2), (0.0, 0.3), (0.0, 0.15)),
        bounds=((0.2, 2.0), SPEED_BOUNDS, TIME_BOUNDS, (0.0, 2.0)),
    ),
)


def tune_baselines(
    passes: CommonPasses, target_m_s: float, decisions: Sequence[Decisions] = (Decisions.AT_REST,)
) -> tuple[TunedBaseline, ...]:
    """Both baselines, tuned for least rms exit error on `passes` (600 are as many as the richest law uses).

    Of those that are asked at rest and at any time (at every sample, with the stage commanded last), as `decisions`
    permits, the better of each family.
    """
    families = ([tune(family.deciding(each), passes, target_m_s) for each in decisions] for family in FAMILIES)
    return tuple(min(members, key=lambda member: member.rms_m_s) for members in families)


def tune(family: Family, passes: CommonPasses, target_m_s: float) -> TunedBaseline:
    """The best member of `family`; deterministic.

    A coarse grid on the first few `passes`, its best part on some more, then a simplex search on more still.
    """
    from scipy.optimize import minimize  # start-up: scipy only where it is needed

    loop = passes.loop(passes.plant.top_stage + 1)
    least, few = passes.first(FIRST_LOOK_PASSES), passes.first(COARSE_PASSES)
    more = passes.first(PASSES_PER_PARAMETER * len(family.names))

    def rms(stage: int, values: tuple[float, ...], passes: CommonPasses) -> float:
        exits = passes.run(family.build(loop, target_m_s, stage, *values)).exit_speed_m_s
        return float(np.sqrt(np.mean((exits - target_m_s) ** 2)))

    top = loop.stages - 1
    members = list(product(range(1, top + 1) if family.one_stage else (top,), product(*family.grids)))
    members.sort(key=lambda member: rms(member[0], member[1], least))
    best = members[: ceil(LOOKED_AT_AGAIN * len(members))]
    stage, start = min(best, key=lambda member: rms(member[0], member[1], few))
    steps = [0.5 * (grid[1] - grid[0]) for grid in family.grids]

    def cost(x: Floats) -> float:
        return rms(stage, tuple(x), more)

    found = minimize(
        cost,
        np.array(start, dtype=np.float64),
        method="Nelder-Mead",
        bounds=family.bounds,
        options={
            "initial_simplex": np.vstack([start, start + np.diag(steps)]),
            "maxfev": REFINEMENTS_PER_PARAMETER * len(family.grids),
        },
    )
    values = tuple(float(value) for value in found.x)
    parameters = dict(zip(family.names, values, strict=True))
    if family.one_stage:
        parameters = {"brake_stage": float(stage), **parameters}
    controller = family.build(loop, target_m_s, stage, *values)
    return TunedBaseline(family.name, parameters, controller, rms(stage, values, passes))


@dataclass(frozen=True, eq=False)
class ComparedLaw:
    """A law as it was tuned, the passes under it, and its figures beside those of the table."""

    law: TunedBaseline
    sample: ExitSample
    measured: Measured


def compared_laws(
    tuning: CommonPasses, passes: CommonPasses, table: ExitSample, target_m_s: float, decisions: Sequence[Decisions]
) -> tuple[ComparedLaw, ...]:
    """Every baseline, tuned on `tuning` and run on `passes`; `table`: the table's sample of these."""
    found = []
    for law in tune_baselines(tuning, target_m_s, decisions):
        sample = passes.run(law.controller)
        found.append(ComparedLaw(law, sample, beside_table(law.name, sample, table, target_m_s)))
    return tuple(found)


def best_law(laws: Sequence[ComparedLaw]) -> ComparedLaw:
    """The law of least rms."""
    return min(laws, key=lambda each: each.measured.statistics.rms_m_s)


def permitted(table: ControllerTable) -> tuple[Decisions, ...]:
    """When laws that a table is compared with may command: as it, or less often."""
    return tuple(dict.fromkeys((Decisions.AT_REST, table.decisions)))


def beside_table(name: str, sample: ExitSample, table: ExitSample, target_m_s: float) -> Measured:
    """Figures of a controller's `sample`, and how the table fares on the same passes."""
    found = exit_statistics(sample, target_m_s)
    if found.rms_m_s == 0.0:
        return Measured(name, found)
    ratio, ci95 = rms_ratio(table, sample, target_m_s)
    return Measured(name, found, table_ratio=ratio, table_ratio_ci95=ci95)
