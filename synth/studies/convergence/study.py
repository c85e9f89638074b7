"""How value, lines and prediction change as path, speed and transient steps are halved.

Each step is refined from twice the default on, one at a time and all together. Per level: rms of the solver's own
lines; how far they are from those of the next level; rms of one fixed cubic, and its least exit probability (cubic
interpolation can ripple below zero: a sign of too coarse a speed step). Then the grid that tables are predicted on
against half its steps with twice the scenarios.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from plant_models import Plant
from synth.configuration.config_file import load_config
from synth.configuration.resolved_config import ResolvedConfig
from synth.problem.aim import Aim
from synth.problem.resolution import Resolution, finer_for_check
from synth.solver.backward_induction import Solution, solve
from synth.solver.chain.chain import check_chain, persistent_chain
from synth.solver.evaluation import Evaluation
from synth.solver.policy_density import density_and_occupancy, exit_density
from synth.solver.polynomial_fit import stage_occupancy
from synth.solver.polynomial_lines import PolynomialLines
from synth.solver.resolved_density import resolved_density
from synth.solver.tuned_lines import fitted
from synth.studies.cases import Case, named_cases
from synth.studies.convergence.findings import CaseRow, Convergence, Level, Refinement
from synth.studies.options import option
from synth.studies.side_by_side import side_by_side
from synth.studies.study import Method, Tell

KINDS = ("path step", "speed step", "transient step", "all together")
COARSEST = 2.0
"""Times the default steps, at level 0; each level halves them."""

DEGREE = 3
NEAR_LINE_M_S, FAR_LINE_M_S = 0.1, 20.0
"""Samples so near a line count for it; a line beyond the second is none."""


@dataclass(frozen=True)
class Options:
    """What is studied."""

    config: Path | None = option(None, "configuration; the built-in default book without it")
    cases: tuple[str, ...] = option(("22:2", "52:3"), "mass, t : target, m/s")
    levels: int = option(4, "from twice the default steps on, each half of the one before", (3, 6))


def at_level(base: Resolution, kind: str, level: int) -> Resolution:
    """`base` with the step of `kind` at 2, 1, 1/2, 1/4 … times its default for level 0, 1, 2, 3 …"""
    share = COARSEST / 2**level
    changes = {
        "path step": replace(base, path_step_m=base.path_step_m * share),
        "speed step": replace(base, speed_step_m_s=base.speed_step_m_s * share),
        "transient step": replace(base, transient_substeps=max(1, round(base.transient_substeps / share))),
    }
    if kind != "all together":
        return changes[kind]
    return replace(
        changes["path step"], speed_step_m_s=changes["speed step"].speed_step_m_s,
        transient_substeps=changes["transient step"].transient_substeps,
    )  # fmt: skip


def samples_of(solution: Solution) -> NDArray[np.float64]:
    """How often the solver's own lines are asked, (nodes, stages, speeds)."""
    chain = solution.chain
    _, occupancy = density_and_occupancy(chain, solution.lines)
    return stage_occupancy(occupancy.samples, chain.actuator.mode_stage, chain.actuator.stages)


def own_rms(solution: Solution) -> float:
    """rms of the solver's own lines on their own grid."""
    return Evaluation(solution.chain, solution.aim).rms_m_s(solution.lines)


def lines_apart(coarse: Solution, fine: Solution) -> float:
    """Mean distance of the lines, m/s, weighted by the samples taken near the coarse ones."""
    grid = coarse.chain.grid
    samples = samples_of(coarse)
    total = weights = 0.0
    for a, b in ((coarse.lines.lower_m_s, fine.lines.lower_m_s), (coarse.lines.upper_m_s, fine.lines.upper_m_s)):
        for k in range(a.shape[0]):
            finite = np.nan_to_num(b[k], posinf=1e9, neginf=-1e9)
            there = np.interp(grid.path_m[:-1], fine.chain.grid.path_m, finite)
            for n in np.flatnonzero(np.isfinite(a[k, :-1]) & (np.abs(there) < FAR_LINE_M_S)):
                weight = float(samples[n, k, np.abs(grid.speed_m_s - a[k, n]) < NEAR_LINE_M_S].sum())
                total += weight * abs(a[k, n] - there[n])
                weights += weight
    return total / weights


def refined(case: Case, config: ResolvedConfig, kind: str, levels: int, cubic: PolynomialLines) -> Refinement:
    """One level after the other."""
    rows: list[Level] = []
    before: Solution | None = None
    for level in range(levels):
        chain = persistent_chain(case.plant, at_level(config.resolution, kind, level))
        solution = solve(chain, Aim(case.target_m_s, config.criterion))
        density = exit_density(chain, cubic.at(chain.grid.path_m))
        if before is not None:
            rows[-1] = replace(rows[-1], lines_move_m_s=lines_apart(before, solution))
        rows.append(
            Level(
                COARSEST / 2**level, own_rms(solution), density.rms_m_s(case.target_m_s),
                float(density.probability.min()), None,
            )
        )  # fmt: skip
        before = solution
    return Refinement(kind, tuple(rows))


def prediction_rms(plant: Plant, resolution: Resolution, cubic: PolynomialLines, target_m_s: float) -> float:
    """Predicted rms of the cubic as of an exported table."""
    chain = check_chain(plant, resolution)
    return resolved_density(chain, cubic.at(chain.grid.path_m), target_m_s).rms_m_s(target_m_s)


def halved(check: Resolution) -> Resolution:
    """Half of all steps, and twice as many intervals between the nodes of the hidden quantities."""
    return replace(
        at_level(check, "all together", 2),
        friction_nodes=2 * check.friction_nodes - 1,
        path_levels=2 * check.path_levels - 1,
        resistance_nodes=2 * check.resistance_nodes - 1,
    )


def studied(case: Case, config: ResolvedConfig, levels: int) -> CaseRow:
    """Everything about one case."""
    default = solve(persistent_chain(case.plant, config.resolution), Aim(case.target_m_s, config.criterion))
    cubic = fitted(default, DEGREE).lines
    check = finer_for_check(config.resolution)
    return CaseRow(
        case=case.name,
        default_own_rms_m_s=own_rms(default),
        refinements=tuple(refined(case, config, kind, levels, cubic) for kind in KINDS),
        check_rms_m_s=prediction_rms(case.plant, check, cubic, case.target_m_s),
        halved_check_rms_m_s=prediction_rms(case.plant, halved(check), cubic, case.target_m_s),
    )


def run(options: Options, tell: Tell) -> Convergence:
    """All cases."""
    config = load_config(options.config)

    def row_of(case: Case) -> CaseRow:
        row = studied(case, config, options.levels)
        tell(f"{case.name}: {options.levels} levels of {len(KINDS)} refinements")
        return row

    return Convergence(config.sha256, side_by_side(row_of, named_cases(config, options.cases)))


METHOD = Method(Options, Options(cases=("52:3",), levels=3), Convergence, run)
