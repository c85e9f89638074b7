"""Tables of point sensors by number, layout and axles, beside the table of the radar on the same passes."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

from plant_models import PointSensors
from synth.book.sensors.candidate_places import LayoutCase
from synth.book.sensors.layout import rule_layout
from synth.book.sensors.layout_plan import PLACE_STEP_M, JudgedLayout, LayoutProblem, plan_layouts
from synth.book.sensors.tuned_passages import TunedPassages, passage_chains
from synth.book.tuned_table import predict
from synth.problem.resolution import Resolution, finer_for_check
from synth.simulation.closed_loop import TableController
from synth.simulation.common_passes import common_passes
from synth.simulation.exit_statistics import brake_power, exit_statistics, rms_ratio
from synth.simulation.passage_sample import PassageSample
from synth.simulation.passes import ExitSample
from synth.simulation.random_passes import RandomPasses
from synth.solver.chain.chain import check_chain
from synth.studies.point_sensors.findings import RadarRow, SensorRow, Told
from synth.studies.point_sensors.sensor_table import AXLES, tabulated, unfinished_share
from synth.studies.point_sensors.sites import Site
from synth.studies.point_sensors.told import told_bound
from synth.studies.tuned_table import tuned_table

Layouts = Callable[[LayoutProblem, Sequence[int]], "dict[str, list[JudgedLayout]]"]
"""Layouts by their kind, for numbers of deciding sensors, each with its tuned tables."""


@dataclass(frozen=True)
class Compared:
    """What every layout of a site is given: the site, passes, the grid of the tables, the radar's exits."""

    site: Site
    passes: RandomPasses
    resolution: Resolution
    frictions: int
    radar: ExitSample


@dataclass(frozen=True)
class MadeLayout:
    """One layout with its row and, by `tuned`, its table."""

    row: SensorRow
    tuned: TunedPassages


def planned_and_others(problem: LayoutProblem, deciding: Sequence[int]) -> dict[str, list[JudgedLayout]]:
    """'planned' and 'equal' for each number of deciding sensors, and 'rule': the one layout of zhukovitsky-2012."""
    plans = plan_layouts(problem, deciding)
    (case,) = problem.cases
    by_rule = rule_layout(case.plant, problem.sensors, case.aims[0].target_speed_m_s)
    return {
        "planned": [exportable(problem, plan.best) for plan in plans],
        "equal": [plan.equal for plan in plans],
        "rule": [problem.judged(by_rule)],
    }


def exportable(problem: LayoutProblem, layout: JudgedLayout) -> JudgedLayout:
    """The layout, its first sensor moved ahead where it stands at the entrance: no table can begin there."""
    first_m, *others = layout.deciding_m
    return layout if first_m < 0.0 else problem.judged((-PLACE_STEP_M, *others))


def radar_row(site: Site, passes: RandomPasses) -> tuple[RadarRow, ExitSample]:
    """The table of the radar as a tune makes it, and its exits."""
    common = common_passes(site.plant, passes)
    table = tuned_table(site.config, site.plant, site.target_m_s)
    check = check_chain(site.plant, finer_for_check(site.config.resolution))
    sample = common.run(TableController(table))
    found = exit_statistics(sample, site.target_m_s)
    out = brake_power(sample, common.at_full_brake, site.target_m_s).out_of_brake
    predicted = predict(check, table).rms_m_s(site.target_m_s)
    row = RadarRow(
        site.title, predicted, found.rms_m_s, found.rms_ci95_m_s, found.switchings, found.stalled, found.stalled_ci95,
        found.overspeed, found.overspeed_ci95, out,
    )  # fmt: skip
    return row, sample


def sensor_rows(
    given: Compared, axles: str, sensors: Sequence[int], layouts: Layouts = planned_and_others
) -> Iterator[MadeLayout]:
    """A row for every layout; `sensors` are counted with the one behind the exit, which decides nothing."""
    site = given.site
    problem = LayoutProblem((LayoutCase(site.plant, (site.aim,)),), PointSensors((0.0,), axles=AXLES[axles]),
                            given.resolution)  # fmt: skip
    found = layouts(problem, [count - 1 for count in sensors])
    equal = {len(each.deciding_m): run_of(given, tuned_of(each)) for each in found.get("equal", [])}
    for kind, made in found.items():
        for each in made:
            tuned = tuned_of(each)
            sample = equal[len(each.deciding_m)] if kind == "equal" else run_of(given, tuned)
            beside = equal.get(len(each.deciding_m)) if kind == "planned" else None
            told = told_row(given, tuned) if kind == "planned" else None
            yield MadeLayout(row_of(given, (axles, kind), tuned, (sample, beside), told), tuned)


def tuned_of(layout: JudgedLayout) -> TunedPassages:
    """The only table of a layout that was made for one case and one aim."""
    ((tuned,),) = layout.tuned
    return tuned


def run_of(given: Compared, tuned: TunedPassages) -> PassageSample:
    """The common passes under a table."""
    return tabulated(given.site, tuned).run(given.passes)


def told_row(given: Compared, tuned: TunedPassages) -> Told:
    """What speeds for each friction reach with the same sensors."""
    chains = passage_chains(tuned.plant, tuned.sensors, given.resolution)
    bound = told_bound(chains, tuned.speeds, given.site.target_m_s, given.frictions)
    return Told(bound.table_rms_m_s, bound.told_rms_m_s, bound.regret, bound.frictions, bound.table_better)


def row_of(
    given: Compared,
    what: tuple[str, str],
    tuned: TunedPassages,
    samples: tuple[PassageSample, PassageSample | None],
    told: Told | None,
) -> SensorRow:
    """The figures of one layout; `samples`: its own, and those of equal sections where it is compared with them."""
    target, (sample, equal) = given.site.target_m_s, samples
    found = exit_statistics(sample, target)
    ratio, ratio_ci95 = rms_ratio(sample, given.radar, target)
    unfinished, unfinished_ci95 = unfinished_share(sample)
    return SensorRow(
        case=given.site.title,
        axles=what[0],
        layout=what[1],
        places_m=tuned.sensors.path_m,
        predicted_m_s=tuned.rms_m_s,
        rms_m_s=found.rms_m_s,
        rms_ci95_m_s=found.rms_ci95_m_s,
        radar_ratio=ratio,
        radar_ratio_ci95=ratio_ci95,
        equal_ratio=None if equal is None else rms_ratio(sample, equal, target),
        told=told,
        unfinished=unfinished,
        unfinished_ci95=unfinished_ci95,
        switchings=found.switchings,
        stalled=found.stalled,
        stalled_ci95=found.stalled_ci95,
        overspeed=found.overspeed,
        overspeed_ci95=found.overspeed_ci95,
    )
