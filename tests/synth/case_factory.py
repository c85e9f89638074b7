"""Results of a tune that were never computed: right in shape and size, made in milliseconds."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from plant_models import (
    Cut,
    Plant,
    RollingResistance,
)
from synth.retarder.case_result import CaseResult, OffNominal, Outcome
from synth.retarder.comparison.measured import Comparison, Measured
from synth.retarder.off_nominal_trials import CONDITIONS
from synth.retarder.tuned_case import Feasibility, GridCheck
from synth.simulation.exit_statistics import UnavoidableError, brake_power, exit_statistics, rms_ratio
from synth.simulation.passes import TRACE_FACTORS, ExitSample, PassTrace
from synth.solver.backward_induction import PolicyMap
from synth.solver.descent import Descent
from synth.solver.exit_density import ExitDensity
from synth.solver.switching_lines import PolynomialLines, SwitchingLines
from synth.solver.tabulate import clock_of
from tests.synth.conftest import GONDOLA_OFFSETS_M, pilot_plant
from tuning_tables import ControllerTable, CutId, Generator, Predicted, RetarderId, Stage, ValidRange
from tuning_tables.stage import round_coefficients

PASSES = 4000
NAMES_AND_SPREAD = (
    ("table", 1.0),
    ("friction known", 0.9),
    ("relay", 3.5),
    ("energy rule", 2.0),
)


def make_plant(mass_t: float, stages: int) -> Plant:
    """A gondola on a two-retarder position."""
    cut = Cut("ЛС", mass_t, GONDOLA_OFFSETS_M, stages - 1)
    return replace(pilot_plant(mass_t), cut=cut, resistance=RollingResistance(1.5, 0.5))


def make_case(
    label: str = "gondola-36t", target: float = 3.0, stages: int = 4, spread: float = 0.04, feasible: bool = True
) -> CaseResult:
    """A case whose exit speeds are normal with `spread` m/s around the target; infeasible ones leave too fast."""
    plant = make_plant(36.0, stages)
    bias = 0.0 if feasible else 0.2
    samples = [make_sample(target + bias, factor * spread, seed) for seed, (_, factor) in enumerate(NAMES_AND_SPREAD)]
    density = make_density(target + bias, spread)
    promised = density.rms_m_s(target)
    known, *baselines = (
        measured(name, sample, samples[0], target)
        for (name, _), sample in zip(NAMES_AND_SPREAD[1:], samples[1:], strict=True)
    )
    table = make_table(label, plant, target)
    return CaseResult(
        label=label,
        plant=plant,
        table=replace(table, predicted=replace(table.predicted, rms_m_s=promised)),
        predicted=density,
        polish=Descent(make_polynomials(plant), 2.0 * spread**2, spread**2, 20, True, "Optimization terminated"),
        exit_speeds_m_s=samples[0].exit_speed_m_s.astype(np.float32),
        exit_weight=samples[0].weight,
        statistics=exit_statistics(samples[0], target),
        brake_power=brake_power(samples[0], samples[1], target),
        unavoidable=make_unavoidable(feasible),
        traces=tuple(make_trace(plant, target, factor) for factor in TRACE_FACTORS),
        grid=GridCheck(1.02 * promised, promised, again=False, most_off=1.25),
        finding=None,
        estimate=None,
        comparison=Comparison(known, tuple(baselines)),
        feasibility=Feasibility(
            limit_m_s=0.1,
            entry_m_s=np.linspace(5.0, 6.5, 5),
            entry_rms_m_s=np.full(5, make_unavoidable(feasible).rms_m_s),
            served_m_s=(5.0, 6.5) if feasible else None,
        ),
        ties=0.125,
        front=None,
        off_nominal=make_off_nominal(spread),
    )


def make_off_nominal(spread: float) -> tuple[OffNominal, ...]:
    """Every condition of a tune but the last, each worse than the one before it; the last cannot be."""
    return tuple(
        OffNominal(each.key, each.name, None, "cut: mass_t is too much")
        if each is CONDITIONS[-1]
        else OffNominal(
            each.key, each.name, make_outcome(next(iter(each.changes)), (1.2 + 0.3 * place) * spread, spread)
        )
        for place, each in enumerate(CONDITIONS)
    )


def make_outcome(change: str, rms: float, nominal: float) -> Outcome:
    """With intervals of 5 % to either side."""
    ratio, few = rms / nominal, (0.0, 0.001)
    rms_ci95, ratio_ci95 = ((0.95 * each, 1.05 * each) for each in (rms, ratio))
    return Outcome(change, PASSES, rms, rms_ci95, ratio, ratio_ci95, 0.012, (0.01, 0.015), 0.0, few)


def make_unavoidable(feasible: bool) -> UnavoidableError:
    """Twice the limit if infeasible, for want of brake power, else a fifth of it."""
    rms_m_s = 0.02 if feasible else 0.2
    return UnavoidableError(rms_m_s, (0.98 * rms_m_s, 1.02 * rms_m_s), too_fast=True)


def make_polynomials(plant: Plant) -> PolynomialLines:
    """Constant lines, for those who ask only how the polish ended."""
    stages = plant.top_stage + 1
    has_line = np.ones((stages, 2), dtype=bool)
    has_line[0, 0] = has_line[-1, 1] = False
    return PolynomialLines(plant.start_m, plant.exit_m, np.zeros((stages, 2, 4)), has_line)


def measured(name: str, sample: ExitSample, table: ExitSample, target: float) -> Measured:
    """`sample` beside that of the table."""
    ratio, interval = rms_ratio(table, sample, target)
    return Measured(name, exit_statistics(sample, target), table_ratio=ratio, table_ratio_ci95=interval)


def make_lines(plant: Plant, target: float, nodes: int) -> SwitchingLines:
    """Lines that fall to the target, 0.1 m/s apart, higher for higher stages."""
    s = np.linspace(0.0, plant.exit_m, nodes)
    stage = np.arange(plant.top_stage + 1)[:, None]
    middle = target + (6.0 - target) * (1.0 - s / plant.exit_m) ** 2 + 0.1 * stage
    lower, upper = middle - 0.05, middle + 0.05
    lower[0], upper[-1] = -np.inf, np.inf
    return SwitchingLines(s, lower, upper)


def make_policy_map(plant: Plant, target: float) -> PolicyMap:
    """Up above the lines, down below them, indifferent in the first third."""
    lines = make_lines(plant, target, 76)
    speed = np.sqrt(2.0 * 0.09 * np.arange(280))
    below = speed < lines.lower_m_s[:, :-1, None]
    above = speed > lines.upper_m_s[:, :-1, None]
    indifferent = np.broadcast_to(lines.nodes_m[:-1, None] < plant.exit_m / 3.0, below.shape).copy()
    return PolicyMap(lines.nodes_m[:-1], speed, (above.astype(np.int8) - below.astype(np.int8)), indifferent)


def make_density(mean: float, spread: float) -> ExitDensity:
    """Normal in speed, on an energy grid."""
    speed = np.sqrt(2.0 * 0.06 * np.arange(400))
    weight = np.exp(-0.5 * ((speed - mean) / max(spread, 0.03)) ** 2)
    return ExitDensity(speed, weight / weight.sum(), 0.0, 0.0, 9.5)


def make_sample(mean: float, spread: float, seed: int) -> ExitSample:
    """Normal exit speeds; nothing stalls."""
    rng = np.random.default_rng(seed)
    speed = mean + spread * rng.standard_normal(PASSES)
    return ExitSample(
        speed, np.zeros(PASSES, bool), np.full(PASSES, 9, np.int32), np.full(PASSES, 12.0), np.ones(PASSES)
    )


def make_trace(plant: Plant, target: float, factor: float) -> PassTrace:
    """Braking at the top stage, then released."""
    s = np.linspace(0.0, plant.exit_m, 120)
    speed = np.maximum(6.0 - 0.25 * factor * s, target)
    time = np.concatenate([[0.0], np.cumsum(np.diff(s) / speed[1:])])
    stage: NDArray[np.int64] = np.where(speed > target, plant.top_stage, 0).astype(np.int64)
    return PassTrace(time, s, speed, 120.0 * stage.astype(float), stage, speed + 0.01, False)


def make_table(label: str, plant: Plant, target: float) -> ControllerTable:
    """A table of parallel straight lines, as cubics."""
    position = plant.position
    stages = tuple(
        Stage(
            k,
            position.stage_pressures_kpa[k],
            None if k == 0 else round_coefficients((target + 1.0, -0.02, 0.0, 0.0)),
            None if k == plant.top_stage else round_coefficients((target + 1.2, -0.02, 0.0, 0.0)),
        )
        for k in range(plant.top_stage + 1)
    )
    return ControllerTable(
        id=f"{label}-{target:g}",
        created="2026-11-20T22:46:00Z",
        generator=Generator("retarder-synth", "0.1.0", "ab" * 32),
        retarder=RetarderId(position.name, position.zones_m, plant.exit_m, position.pneumatics.dead_band_kpa),
        cut=CutId(plant.cut.category, plant.cut.mass_t, plant.cut.axle_offsets_m),
        target_speed_m_s=target,
        clock=clock_of(plant),
        degree=3,
        stages=stages,
        valid=ValidRange((0.0, plant.exit_m), (0.3, 9.0)),
        predicted=Predicted(0.05, 0.0, 0.0, 9.5),
    )
