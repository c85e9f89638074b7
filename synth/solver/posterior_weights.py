"""The common policy weighted by what is hidden as it really is at every place, stage and speed.

The sweep weighs friction factor, resistance, path noise and resting pressure by their prior. Where a cut is seen at a
given path, stage and speed says more: a fast cut near the exit is one that brakes badly. The posterior follows from the
forward density of the policy itself; policy and density are iterated, the weights damped.

Measured on six cases of the default book: the solver's lines change by −2 to +13 % in rms, and after the polish, whose
exact gradient weighs by the true occupancy anyway, by −2 to +4 %, mostly to the worse. So a tune uses the prior.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from synth.problem.criterion import Criterion
from synth.solver.backward_induction import Solution, hidden_prior, solve_all
from synth.solver.chain.transitions import Transitions
from synth.solver.policy_evaluation import commands, expected_cost, occupancy_of
from synth.solver.switching_lines import SwitchingLines

DAMPING = 0.5
"""Share of the new weights in the next round."""

CONVERGED = 0.01
"""The iteration ends when the exact cost changes by less than this share from one round to the next."""

UNSEEN = 1e-4
"""Expected samples, relative to the most at any place, below which the prior counts."""


@dataclass(frozen=True)
class PosteriorSolution:
    """The best solution met, exact costs of all rounds (the first is the prior's), and whether they settled."""

    solution: Solution
    costs_m2_s2: tuple[float, ...]
    converged: bool

    @property
    def status(self) -> str:
        """One sentence: how it ended."""
        word = "settled" if self.converged else "did not settle"
        best = int(np.argmin(self.costs_m2_s2))
        return f"the cost {word} in {len(self.costs_m2_s2)} rounds; the lines are those of round {best + 1}"


def solve_by_posterior(
    transitions: Transitions, target_speed_m_s: float, criterion: Criterion, most_rounds: int = 6
) -> PosteriorSolution:
    """Iterate policy and posterior; guard: of all rounds, the prior's too, the lines of least exact cost are kept."""
    weights: NDArray[np.float64] | None = None
    solutions: list[Solution] = []
    costs: list[float] = []
    converged = False
    while not converged and len(costs) < most_rounds:
        (solution,) = solve_all(transitions, [(target_speed_m_s, criterion)], weights)
        policy = commands(transitions, solution.lines, staircase=False)
        solutions.append(solution)
        costs.append(expected_cost(transitions, policy, target_speed_m_s, criterion))
        converged = len(costs) > 1 and abs(costs[-1] - costs[-2]) <= CONVERGED * costs[-2]
        found = posterior_weights(transitions, solution.lines)
        weights = found if weights is None else (1.0 - DAMPING) * weights + DAMPING * found
    best = solutions[int(np.argmin(costs))]
    return PosteriorSolution(best, tuple(costs), converged)


def posterior_weights(transitions: Transitions, lines: SwitchingLines) -> NDArray[np.float64]:
    """Weights (N, I, H, L, E) of what is hidden under the policy of `lines`; they sum to 1 in every stage.

    Where the policy never comes the prior stands in, and nearby both are mixed by the expected number of samples.
    """
    stage = transitions.actuator.mode_stage
    prior = hidden_prior(transitions)
    _, occupancy = occupancy_of(transitions, commands(transitions, lines, staircase=False))
    samples = np.moveaxis(np.maximum(occupancy.samples, 0.0), 1, 0)
    weights = np.empty_like(samples)
    in_stage = {k: samples[:, :, stage == k].sum(axis=(1, 2, 3)) for k in np.unique(stage)}
    few = UNSEEN * max(float(each.max()) for each in in_stage.values())
    for k, total in in_stage.items():
        here = stage == k
        share = prior[:, here] / prior[:, here].sum()
        weights[:, :, here] = samples[:, :, here] + few * share[None, ..., None]
        weights[:, :, here] /= (total + few)[:, None, None, None, :]
    return weights
