"""The study of point sensors: its bound, its shares, its claims, each against a second computation or by hand."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from plant_models import PointSensors
from scripts.studies.point_sensors.fault_losses import fault_rows
from scripts.studies.point_sensors.sites import (
    AXLES,
    TEXTS,
    SensorTable,
    Site,
    equal_sections,
    planned,
    single_stage,
    site_of,
    sites,
    tabulated,
    unfinished_share,
)
from scripts.studies.point_sensors.worth import RESISTANCES, speeds_for, squares_at, told_bound
from synth.frame.faults import InputError
from synth.problem.resolution import Resolution
from synth.retarder.sensors.layout import LayoutCase, candidate_places, equal_layout, with_layout
from synth.retarder.sensors.layout_plan import LayoutProblem
from synth.retarder.sensors.passage_table import PassageChains, TunedPassages, passage_chains, tuned_passages
from synth.simulation.exit_statistics import exit_statistics
from synth.simulation.passage_controller import DECIDED, NOT_HEARD, UNFINISHED, PassageSample
from synth.simulation.stratified_passes import stratified_passes
from synth.solver.chain.sampling import with_point_sensors
from synth.solver.chain.scenarios import Scenarios, resistance_scenarios
from synth.solver.evaluation import exit_density
from synth.solver.told_lines import told_factors

COARSE = Resolution(path_step_m=0.5, speed_step_m_s=0.05, friction_nodes=5, resistance_nodes=1)
DECIDING = 5


@pytest.fixture(scope="module")
def site() -> Site:
    return site_of("park-22")


@pytest.fixture(scope="module")
def made(site: Site) -> tuple[PassageChains, TunedPassages, SensorTable]:
    """A table of six sensors in equal sections, every axle."""
    places = equal_layout(-3.4, site.plant.exit_m, DECIDING)
    sensors = with_layout(PointSensors((0.0,), axles=AXLES["every"]), places, site.plant.exit_m)
    chains = passage_chains(with_point_sensors(site.plant, sensors), sensors, COARSE)
    tuned = tuned_passages(chains, site.aim)
    return chains, tuned, tabulated(site, tuned)


# ------------------------------------------------------------------------------------------------ the bound


@pytest.mark.long
def test_the_bound_begins_with_the_prediction_of_the_table(
    site: Site, made: tuple[PassageChains, TunedPassages, SensorTable]
) -> None:
    """Mean squares of single frictions, and the main effect of the resistance, make up the density of all together."""
    chains, tuned, _ = made
    bound = told_bound(chains, tuned.speeds, site.target_m_s, 13)
    factor, weight = told_factors(chains.design.plant, 13)
    extra, share = resistance_scenarios(chains.check.plant, RESISTANCES)
    all_of_them = Scenarios(
        np.concatenate([factor, np.ones(len(extra))]),
        np.concatenate([np.zeros(len(factor)), extra]),
        np.concatenate([weight - (np.arange(len(factor)) == len(factor) // 2), share]),
    )
    together = exit_density(replace(chains.check, scenarios=all_of_them), tuned.speeds).rms_m_s(site.target_m_s)
    assert bound.table_rms_m_s == pytest.approx(together, rel=1e-6)
    assert bound.table_rms_m_s == pytest.approx(tuned.rms_m_s, rel=0.02)  # its last metres are on finer energies
    assert 1.0 < bound.regret < 2.0
    assert bound.table_better <= bound.frictions


def test_speeds_for_a_friction_do_in_the_loop_what_is_predicted_of_them(
    site: Site, made: tuple[PassageChains, TunedPassages, SensorTable]
) -> None:
    """Passes with that friction alone, the running resistance at its mean."""
    chains, tuned, _ = made
    factor = 0.9
    own = speeds_for(chains.design, site.target_m_s, factor)
    predicted = np.sqrt(squares_at(chains.check, own, site.target_m_s, np.array([factor])))[0]
    known = tabulated(site, replace(tuned, polish=replace(tuned.polish, best=own)))
    draws = known.loop.draws(stratified_passes(3, 0, 4000), cut_factor=factor)
    draws = draws._replace(resistance_n_kn=np.full_like(draws.resistance_n_kn, site.plant.resistance.mean_n_per_kn))
    found = exit_statistics(known.loop.run(known_controller(known), draws), site.target_m_s)
    assert predicted == pytest.approx(found.rms_m_s, rel=0.1)
    assert predicted < np.sqrt(squares_at(chains.check, tuned.speeds, site.target_m_s, np.array([factor])))[0]


def known_controller(table: SensorTable) -> Any:
    from synth.simulation.passage_controller import of_table

    return of_table(table.table, tracking=False)


def test_who_is_told_what_everybody_knows_gains_little(site: Site) -> None:
    """Without a spread of friction the regret is 1 but for what the polish leaves."""
    plant = replace(site.plant, friction=replace(site.plant.friction, common_cv=0.0))
    sensors = with_layout(PointSensors((0.0,)), equal_layout(-3.4, plant.exit_m, 3), plant.exit_m)
    chains = passage_chains(with_point_sensors(plant, sensors), sensors, COARSE)
    tuned = tuned_passages(chains, site.aim)
    bound = told_bound(chains, tuned.speeds, site.target_m_s, 3)
    assert bound.frictions == 1  # all nodes are the same factor
    assert 1.0 <= bound.regret < 1.1


# --------------------------------------------------------------------------------------- shares and layouts


def test_the_unfinished_share_is_of_the_passages_heard() -> None:
    outcome = np.array([[DECIDED, UNFINISHED, NOT_HEARD], [DECIDED, DECIDED, UNFINISHED]] * 100, dtype=np.uint8)
    weight = np.tile([1.0, 3.0], 100)
    nothing = np.zeros(200)
    sample = PassageSample(nothing, nothing > 0.0, nothing.astype(np.int32), nothing, weight, outcome=outcome)
    value, (low, high) = unfinished_share(sample)
    assert value == pytest.approx((1.0 + 3.0) / (2.0 + 9.0))
    assert low <= value <= high


@pytest.mark.parametrize("axles", list(AXLES))
def test_planned_layouts_can_be_tables_and_beat_equal_sections_by_the_cost_searched(site: Site, axles: str) -> None:
    kind = PointSensors((0.0,), axles=AXLES[axles])
    problem = LayoutProblem((LayoutCase(site.plant, (site.aim,)),), kind, COARSE)
    (places,) = planned(problem, [3])
    assert places[0] < 0.0
    assert list(places) == sorted(places)
    every = candidate_places(problem.cases[0], kind, 6.0)
    (equal,) = equal_sections(problem, [3])
    found, equally = every.mean_costs([places, equal])
    assert found < equally
    assert planned(problem, []) == ()


def test_sites_are_named() -> None:
    found = sites(tuple(TEXTS))
    assert len({site.title for site in found}) == len(TEXTS)
    oiled, dry = found[list(TEXTS).index("dumper-4")].plant, found[list(TEXTS).index("park-22")].plant
    slopes = [plant.position.force.slope_kn_per_kpa(plant.cut, 4) for plant in (oiled, dry)]
    assert slopes[0] < 0.7 * slopes[1]
    assert oiled.friction_cv == pytest.approx(0.25)
    assert single_stage(found[0], 300.0).plant.top_stage == 1
    with pytest.raises(InputError, match="there is no case 'park-23'; did you mean park-22"):
        site_of("park-23")


# --------------------------------------------------------------------------------------------------- faults


def test_without_fault_wide_limits_change_nothing(
    site: Site, made: tuple[PassageChains, TunedPassages, SensorTable]
) -> None:
    rows = list(fault_rows(site, "every", made[2], stratified_passes(4, 0, 400)))
    assert rows[0].fault == "no fault"
    assert rows[0].ratio == 1.0
    assert rows[0].wide_ratio == pytest.approx(1.0, rel=1e-9)
    names = [row.fault for row in rows]
    assert len(names) == len(set(names)) == 1 + 6 * (DECIDING + 1) + DECIDING + 7
    dead = [row for row in rows if row.fault.endswith("dead")]
    assert max(row.ratio for row in dead) > 1.0
