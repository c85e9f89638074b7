"""What the same plant reaches when the friction of every cut is known: the reference of regret.

The reference has what the table has: the same readings of the speed, made into an estimate where the table has an
estimator, one stage a command, no command before a transient has ended unless the table may give one, the same path. It
is told ξ_cut besides. It is a regulator that could be built, and it passes the cuts that the table passes; so no figure
of it rests on a grid. Its lines begin at the table's and are polished for each friction; with an estimator, which
learns the friction, they are the table's. Where the table does better all the same, the reference is the table: who is
told the friction need not use it.
"""

from __future__ import annotations

from collections.abc import Sequence

from plant_models import Plant
from synth.problem.any_time_resolution import design_resolution
from synth.retarder.any_time.surface_table import trial_table
from synth.retarder.class_setup import ClassSetup
from synth.retarder.comparison.told_regulator import Told, best_by_others, by_lines, run_told
from synth.retarder.estimation.told_estimator import told_with_estimator, told_with_estimator_at_any_time
from synth.retarder.tuned_table import TunedTable, ValidatedLines
from synth.simulation.closed_loop import TableController
from synth.simulation.common_passes import CommonPasses
from synth.simulation.passes import ExitSample
from synth.solver.any_time.polynomial_surfaces import PolynomialSurfaces
from synth.solver.any_time.sampled_chain import sampled_chain
from synth.solver.any_time.told_surfaces import told_surfaces
from synth.solver.told_lines import told_lines


def friction_bound(setup: ClassSetup, tuned: TunedTable, validated: ValidatedLines) -> ExitSample:
    """The common passes under the reference of a table that was tuned and validated on `setup`."""
    regulators = told_regulators(setup, tuned, validated.table.target_speed_m_s)
    return bound_of(setup.passes, regulators, validated.sample, validated.table.target_speed_m_s)


def bound_of(passes: CommonPasses, regulators: Sequence[Told], sample: ExitSample, target_m_s: float) -> ExitSample:
    """`passes` under the best of `regulators` and of the table, of which their `sample` is there."""
    return best_by_others([*(run_told(passes.loop, passes.draws, each) for each in regulators), sample], target_m_s)


def told_regulators(setup: ClassSetup, tuned: TunedTable, target_m_s: float) -> Sequence[Told]:
    """Regulators of the table's kind that are told the friction; where that commands at any time, and one at rest."""
    told: list[Told] = []
    lines, surfaces = tuned.at_rest, tuned.at_any_time
    if setup.estimator is None or lines.estimate is None:
        if surfaces is not None:
            told.append(by_surfaces(setup.plant, target_m_s, surfaces.lines))
        return [*told, by_lines(told_lines(setup.design, target_m_s, lines.lines, tuned.design.fit.curvature))]
    tuning = setup.passes.of_others(setup.estimator.tuning)
    if surfaces is not None and surfaces.estimate is not None:
        told.append(told_with_estimator_at_any_time(setup.plant, surfaces.estimate, tuning, target_m_s))
    return [*told, told_with_estimator(lines.estimate, tuning, target_m_s)]


def by_surfaces(plant: Plant, target_m_s: float, common: PolynomialSurfaces) -> Told:
    """The regulator that compares the measured speed with surfaces for the friction, from those for all frictions."""
    design = sampled_chain(plant, design_resolution(plant, target_m_s))
    surfaces = told_surfaces(design, target_m_s, common)
    return lambda factor: TableController(trial_table(plant, surfaces.at(factor), target_m_s))
