"""What the same plant reaches when the friction of every cut is known: the reference of regret, and feasibility.

The reference has what the table has: the same readings of the speed, made into an estimate where the table has an
estimator, one stage a command, no command before a transient has ended unless the table may give one, the same path. It
is told ξ_cut besides. It is a regulator that could be built, and it passes the cuts that the table passes; so no figure
of it rests on a grid. Its lines begin at the table's and are polished for each friction. Where the table does better
all the same, the reference is the table: who is told the friction need not use it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from plant_models import Plant
from synth.book.any_time.surface_table import trial_table
from synth.book.class_setup import ClassSetup
from synth.book.comparison.measured import Feasibility
from synth.book.comparison.told_regulator import Told, best_by_others, by_lines, picked, run_told
from synth.book.estimation.told_estimator import told_with_estimator, told_with_estimator_at_any_time
from synth.book.tuned_table import TunedTable, ValidatedTable
from synth.problem.any_time_resolution import design_resolution
from synth.simulation.closed_loop import TableController
from synth.simulation.common_passes import CommonPasses
from synth.simulation.controllers import fixed
from synth.simulation.exit_statistics import exit_statistics
from synth.simulation.passes import ExitSample
from synth.simulation.replicates import Interval, rms_of
from synth.solver.any_time.polynomial_surfaces import PolynomialSurfaces
from synth.solver.any_time.sampled_chain import sampled_chain
from synth.solver.any_time.told_surfaces import told_surfaces
from synth.solver.told_lines import told_lines
from tuning_tables import ControllerTable

ENTRY_POINTS, ENTRY_PASSES = 16, 200
"""Entry speeds at which the reference is simulated, and passes at each of them: the same, but for the speed."""


@dataclass(frozen=True)
class FrictionBound:
    """The reference of one table on the common passes, and what it says of the entry speeds that can be served."""

    sample: ExitSample
    feasibility: Feasibility


def friction_bound(setup: ClassSetup, tuned: TunedTable, validated: ValidatedTable, limit_m_s: float) -> FrictionBound:
    """The reference of a table that was tuned and validated on `setup`."""
    regulators = told_regulators(setup, tuned, validated.table.target_speed_m_s)
    return bound_of(setup.passes, regulators, validated.table, validated.sample, limit_m_s)


def bound_of(
    passes: CommonPasses, regulators: Sequence[Told], table: ControllerTable, sample: ExitSample, limit_m_s: float
) -> FrictionBound:
    """The best of `regulators` and `table`, whose `sample` of `passes` is there.

    The position is feasible for the target if the interval of the reference reaches `limit_m_s`.
    """
    target_m_s = table.target_speed_m_s
    candidates: list[Told] = [*regulators, lambda _: TableController(table)]
    samples = [*(run_told(passes.loop, passes.draws, each) for each in regulators), sample]
    best = candidates[int(np.argmin([mean_square(each, target_m_s) for each in samples]))]
    reference = best_by_others(samples, target_m_s)
    rms_ci95 = exit_statistics(reference, target_m_s).rms_ci95_m_s
    return FrictionBound(reference, feasibility_of(passes, best, target_m_s, rms_ci95, limit_m_s))


def told_regulators(setup: ClassSetup, tuned: TunedTable, target_m_s: float) -> Sequence[Told]:
    """Regulators of the table's kind that are told the friction; where that commands at any time, and one at rest."""
    told: list[Told]
    curvature = tuned.design.fit.curvature
    if tuned.estimate is not None and tuned.table.estimator is not None and setup.estimator is not None:
        tuning = setup.passes.of_others(setup.estimator.tuning)
        told = [*told_with_estimator(tuned.estimate, setup.estimator.design, curvature, tuning, target_m_s)]
    else:
        told = [by_lines(told_lines(setup.design, target_m_s, tuned.design.kept.lines, curvature))]
    if tuned.surfaces is None:
        return told
    if tuned.surfaces.estimate is not None and tuned.table.estimator is not None and setup.estimator is not None:
        tuning = setup.passes.of_others(setup.estimator.tuning)
        return [*told_with_estimator_at_any_time(setup.plant, tuned.surfaces.estimate, tuning, target_m_s), *told]
    return [by_surfaces(setup.plant, target_m_s, tuned.surfaces.polish.surfaces), *told]


def by_surfaces(plant: Plant, target_m_s: float, common: PolynomialSurfaces) -> Told:
    """The regulator that compares the measured speed with surfaces for the friction, from those for all frictions."""
    design = sampled_chain(plant, design_resolution(plant, target_m_s))
    surfaces = told_surfaces(design, target_m_s, common)
    return lambda factor: TableController(trial_table(plant, surfaces.at(factor), target_m_s))


def mean_square(sample: ExitSample, target_m_s: float) -> float:
    """Mean squared error of the exit speed over all cuts."""
    return rms_of(sample.exit_speed_m_s - target_m_s, sample.weight)[0] ** 2


def feasibility_of(
    passes: CommonPasses,
    told: Told,
    target_m_s: float,
    rms_ci95_m_s: Interval,
    limit_m_s: float,
    entry_passes: int = ENTRY_PASSES,
) -> Feasibility:
    """Range of entry speeds that the position can serve, simulated under `told`: the first `entry_passes` at each.

    `rms_ci95_m_s`: interval of the reference over the configured entry speeds.
    """
    plant = passes.plant
    entry = np.linspace(max(target_m_s, 0.5), plant.position.max_entry_speed_m_s, ENTRY_POINTS)
    few = passes.first(entry_passes).draws
    count = len(few.weight)
    each = picked(few, np.tile(np.arange(count), ENTRY_POINTS))
    start_m_s = plant.start_speed_m_s(np.repeat(entry, count), each.resistance_n_kn)
    sample = run_told(passes.loop, each._replace(entry_m_s=fixed(start_m_s, np.float64)), told)
    squares = (sample.exit_speed_m_s - target_m_s).reshape(ENTRY_POINTS, count) ** 2
    rms = np.sqrt(squares @ few.weight / few.weight.sum())
    return Feasibility(
        entry_m_s=entry,
        bound_rms_m_s=rms,
        limit_m_s=limit_m_s,
        served_m_s=served(entry, rms, limit_m_s),
        feasible=rms_ci95_m_s[0] <= limit_m_s,
        undecided=rms_ci95_m_s[0] <= limit_m_s < rms_ci95_m_s[1],
    )


def served(
    entry_m_s: NDArray[np.float64], rms_m_s: NDArray[np.float64], limit_m_s: float
) -> tuple[float, float] | None:
    """From the first to the last entry speed at which the rms meets the limit, the rms being linear in between."""
    within = np.nonzero(rms_m_s <= limit_m_s)[0]
    if not len(within):
        return None

    def end(inside: int, outside: int) -> float:
        if not 0 <= outside < len(entry_m_s):
            return float(entry_m_s[inside])
        part = (limit_m_s - rms_m_s[inside]) / (rms_m_s[outside] - rms_m_s[inside])
        return float(entry_m_s[inside] + part * (entry_m_s[outside] - entry_m_s[inside]))

    first, last = int(within[0]), int(within[-1])
    return end(first, first - 1), end(last, last + 1)
