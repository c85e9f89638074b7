"""Tables of point sensors by number, layout and axles, beside the table of the radar on the same passes, and
beside switching speeds that are made for the friction of every cut; and what it costs, and saves where a sensor is
dead, that a design counts passages as not heard.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from plant_models import PointSensors
from plant_models.frozen_arrays import Floats
from scripts.studies.cases import tuned_table
from scripts.studies.point_sensors.rows import MissedRow, RadarRow, SensorRow, Told
from scripts.studies.point_sensors.sensor_faults import DeadSensor, SensorFault, together
from scripts.studies.point_sensors.sites import (
    AXLES,
    Layouts,
    Places,
    Site,
    by_rule,
    equal_sections,
    planned,
    tabulated,
    unfinished_share,
)
from synth.problem.problem import Aim
from synth.problem.resolution import Resolution, finer_for_check
from synth.retarder.sensors.layout import LayoutCase
from synth.retarder.sensors.layout_plan import LayoutProblem
from synth.retarder.sensors.passage_table import PassageChains, TunedPassages, passage_chains, rounded, tuned_passages
from synth.retarder.tuned_table import predict
from synth.simulation.closed_loop import TableController
from synth.simulation.common_passes import common_passes
from synth.simulation.exit_statistics import ExitStatistics, brake_power, exit_statistics, rms_ratio
from synth.simulation.passage_controller import PassageSample, of_table
from synth.simulation.passes import ExitSample
from synth.simulation.random_passes import RandomPasses
from synth.solver.backward_induction import solve
from synth.solver.chain.chain import Chain, check_chain
from synth.solver.chain.sampling import with_point_sensors
from synth.solver.chain.scenarios import Scenarios, resistance_scenarios
from synth.solver.evaluation import scenario_densities
from synth.solver.passage_speeds import PassageSpeeds, polish_passages
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


def missed_row(
    site: Site, axles: str, sensors: int, share: float, resolution: Resolution, passes: RandomPasses
) -> MissedRow:
    """The planned layout of `sensors`, that behind the exit with them, when a `share` of passages is counted as lost.

    Every sensor that decides is dead once, on the same passes, by the table's tracker.
    """
    kind = replace(PointSensors((0.0,), axles=AXLES[axles]), missed_share=share)
    problem = LayoutProblem((LayoutCase(site.plant, (site.aim,)),), kind, resolution)
    (places,) = planned(problem, [sensors - 1])
    made = tabulated(site, tuned_at(problem, places))
    controller, draws = of_table(made.table, tracking=True), made.loop.draws(passes)

    def run(*faults: SensorFault) -> ExitStatistics:
        return exit_statistics(made.loop.run(controller, draws, together(made.loop.sensors, faults)), site.target_m_s)

    whole, dead = run(), [run(DeadSensor(sensor)) for sensor in range(len(places))]
    worst = max(range(len(dead)), key=lambda sensor: dead[sensor].rms_m_s)
    return MissedRow(
        case=site.title,
        axles=axles,
        sensors=sensors,
        missed_share=share,
        predicted_m_s=made.tuned.rms_m_s,
        rms_m_s=whole.rms_m_s,
        rms_ci95_m_s=whole.rms_ci95_m_s,
        worst=worst,
        dead_rms_m_s=dead[worst].rms_m_s,
        dead_rms_ci95_m_s=dead[worst].rms_ci95_m_s,
        most_stalled=max(each.stalled for each in dead),
        most_stalled_ci95=max(each.stalled_ci95 for each in dead),
    )
