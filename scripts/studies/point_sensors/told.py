"""What switching speeds reach that are made for the friction of every cut: same sensors, same places, same readings."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from plant_models.frozen_arrays import Floats
from synth.problem.aim import Aim
from synth.retarder.sensors.tuned_passages import PassageChains, rounded
from synth.solver.backward_induction import solve
from synth.solver.chain.chain import Chain
from synth.solver.chain.scenarios import Scenarios, resistance_scenarios
from synth.solver.passage_polish import polish_passages
from synth.solver.passage_speeds import PassageSpeeds
from synth.solver.policy_density import scenario_densities
from synth.solver.told_lines import SQUARED_ERROR_ALONE, told_factors

RESISTANCES = 3
"""Values of the running resistance, which nobody is told, in a prediction."""

LEAST_SHARE = 0.01
"""A friction that makes less of the mean square error of the table is not worth speeds of its own."""


@dataclass(frozen=True)
class ToldBound:
    """rms predicted of the table, and of speeds for each friction; `table_better`: at how many frictions the table's
    are the better ones, so that they stand in the bound."""

    table_rms_m_s: float
    told_rms_m_s: float
    frictions: int
    table_better: int

    @property
    def regret(self) -> float:
        """The first over the second, 1 at least."""
        return self.table_rms_m_s / self.told_rms_m_s


def told_bound(chains: PassageChains, speeds: PassageSpeeds, target_m_s: float, frictions: int) -> ToldBound:
    """Mean squares at `frictions` values of ξ_cut, equally spaced from −4 to 4 standard deviations, by their weights.

    Each is predicted on the finer chain; the resistance adds its main effect at the mean friction.
    Where speeds for a friction are no better than the table's, the table's are taken: who is told need not use it.
    """
    factor, weight = told_factors(chains.design.plant, frictions)
    table = squares_at(chains.check, speeds, target_m_s, factor)
    told, better, best_at_mean = table.copy(), 0, speeds
    middle = int(np.argmin(np.abs(factor - 1.0)))
    for i in np.flatnonzero(weight * table >= LEAST_SHARE * float(weight @ table)):
        own = speeds_for(chains.design, target_m_s, float(factor[i]))
        square = float(squares_at(chains.check, own, target_m_s, factor[i : i + 1])[0])
        better += square >= table[i]
        if square < table[i]:
            told[i] = square
            best_at_mean = own if i == middle else best_at_mean
    mean_square = float(weight @ table) + resistance_effect(chains.check, speeds, target_m_s)
    least = float(weight @ told) + resistance_effect(chains.check, best_at_mean, target_m_s)
    rms = float(np.sqrt(mean_square))
    return ToldBound(rms, float(np.sqrt(min(least, mean_square))), len(factor), int(better))


def speeds_for(design: Chain, target_m_s: float, factor: float) -> PassageSpeeds:
    """Switching speeds of least mean square error for cuts of one friction, solved and polished."""
    known = with_known_friction(design, factor)
    return rounded(polish_passages(solve(known, Aim(target_m_s, SQUARED_ERROR_ALONE))).best)


def with_known_friction(chain: Chain, factor: float) -> Chain:
    """The same plant whose ξ_cut is known to be `factor` (friction-known bound)."""
    return replace(chain, scenarios=Scenarios(np.array([float(factor)]), np.zeros(1), np.ones(1)))


def squares_at(check: Chain, speeds: PassageSpeeds, target_m_s: float, factor: Floats) -> Floats:
    """Mean squared error at each friction factor (F,), the resistance at its mean."""
    nothing = np.zeros(len(factor))
    return mean_squares(check, speeds, target_m_s, Scenarios(factor, nothing, np.ones(len(factor))))


def resistance_effect(check: Chain, speeds: PassageSpeeds, target_m_s: float) -> float:
    """What the spread of the resistance adds to the mean square error at the mean friction."""
    extra, weight = resistance_scenarios(check.plant, RESISTANCES)
    at_ends = np.append(extra, 0.0)
    ones = np.ones(len(at_ends))
    found = mean_squares(check, speeds, target_m_s, Scenarios(ones, at_ends, ones))
    return float(weight @ found[:-1] - found[-1])


def mean_squares(check: Chain, speeds: PassageSpeeds, target_m_s: float, scenarios: Scenarios) -> Floats:
    """Mean squared error in every scenario."""
    densities = scenario_densities(replace(check, scenarios=scenarios), speeds)
    return np.array([each.rms_m_s(target_m_s) ** 2 for each in densities])
