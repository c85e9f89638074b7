"""Tables of point sensors by number, layout and axles, beside the table of the radar on the same passes."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from plant_models import PointSensors
from scripts.studies.point_sensors.layouts import Layouts, Places, by_rule, equal_sections, planned
from scripts.studies.point_sensors.rows import RadarRow, SensorRow, Told
from scripts.studies.point_sensors.sensor_table import AXLES, tabulated, unfinished_share
from scripts.studies.point_sensors.sites import Site
from scripts.studies.point_sensors.told import told_bound
from scripts.studies.tuned_table import tuned_table
from synth.problem.resolution import Resolution, finer_for_check
from synth.retarder.rounded_table import predict
from synth.retarder.sensors.candidate_places import LayoutCase
from synth.retarder.sensors.layout_plan import LayoutProblem
from synth.retarder.sensors.tuned_passages import TunedPassages, passage_chains, tuned_passages
from synth.simulation.closed_loop import TableController
from synth.simulation.common_passes import common_passes
from synth.simulation.exit_statistics import brake_power, exit_statistics, rms_ratio
from synth.simulation.passage_sample import PassageSample
from synth.simulation.passes import ExitSample
from synth.simulation.random_passes import RandomPasses
from synth.solver.chain.chain import check_chain
from synth.solver.chain.sensor_passages import with_point_sensors


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


def radar_row(site: Site, passes: RandomPasses) -> tuple[RadarRow, ExitSample]:
    """The table of the radar as a tune makes it, and its exits."""
    common = common_passes(site.plant, passes)
    table = tuned_table(site.config, site.plant, site.target_m_s)
    check = check_chain(site.plant, finer_for_check(site.config.resolution))
    sample = common.run(TableController(table))
    found = exit_statistics(sample, site.target_m_s)
    out = brake_power(sample, common.at_full_brake, site.target_m_s).brake_saturated
    predicted = predict(check, table).rms_m_s(site.target_m_s)
    row = RadarRow(
        site.title, predicted, found.rms_m_s, found.rms_ci95_m_s, found.switchings, found.stalled, found.stalled_ci95,
        found.overspeed, found.overspeed_ci95, out,
    )  # fmt: skip
    return row, sample


def sensor_rows(
    given: Compared, axles: str, sensors: Sequence[int], to_plan: Sequence[int], plan: Layouts = planned
) -> Iterator[MadeLayout]:
    """A row for every layout; `sensors` are counted with the one behind the exit, which decides nothing.

    Equal sections for each number, planned ones for those `to_plan`, the rule's own. Regret is asked of planned
    layouts, and of equal sections where none is planned.
    """
    site = given.site
    kind = PointSensors((0.0,), axles=AXLES[axles])
    problem = LayoutProblem((LayoutCase(site.plant, (site.aim,)),), kind, given.resolution)
    planned_at = dict(zip(to_plan, plan(problem, [count - 1 for count in to_plan]), strict=True))
    for count, places in zip(sensors, equal_sections(problem, [count - 1 for count in sensors]), strict=True):
        tuned = tuned_at(problem, places)
        sample = run_of(given, tuned)
        told = None if count in planned_at else told_row(given, tuned)
        yield MadeLayout(row_of(given, (axles, "equal"), tuned, (sample, None), told), tuned)
        if count in planned_at:
            better = tuned_at(problem, planned_at[count])
            pair = run_of(given, better), sample
            yield MadeLayout(row_of(given, (axles, "planned"), better, pair, told_row(given, better)), better)
    tuned = tuned_at(problem, by_rule(problem))
    yield MadeLayout(row_of(given, (axles, "rule"), tuned, (run_of(given, tuned), None), None), tuned)


def tuned_at(problem: LayoutProblem, places: Places) -> TunedPassages:
    """The only table of a layout for one case and one aim."""
    (case,), sensors = problem.cases, problem.placed(places)
    chains = passage_chains(with_point_sensors(case.plant, sensors), sensors, problem.resolution)
    (aim,) = case.aims
    return tuned_passages(chains, aim)


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
