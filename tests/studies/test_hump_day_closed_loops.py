"""Positions in their closed loop in the study `hump-day`: what they make of their commands, comparisons."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import pytest

from plant_models.library.catalogue import load_weight_categories
from scripts.studies.aiming.trial import Value
from scripts.studies.humping.base_trial import OPEN, Day, with_stds
from scripts.studies.humping.books import PARK
from scripts.studies.humping.closed_loops import REGULATED, REGULATORS, TABLES, ClosedLoops
from scripts.studies.humping.exits import exits_of
from scripts.studies.humping.frontier import (
    CONTROLS,
    OPEN_LOOP,
    WITH_FEEDBACK,
    Frontier,
    frontier_groups,
    lines_of,
    normal_families,
    sigma,
)
from scripts.studies.humping.gains import normal_gains, table_gains
from scripts.studies.humping.runs import OUTCOMES
from scripts.studies.humping.table_positions import TablePositions
from synth.hump.trains.hump_position import Arrivals, HumpPosition, Passed
from synth.hump.trains.outcomes import TrainOutcomes, joined
from synth.hump.trains.trial import HumpTrial
from tests.synth.hump.trains.coarse_book import coarse_classes

TRAINS, STDS_M_S = 4, (0.03, 0.15, 0.35)


@pytest.fixture(scope="module")
def trial() -> HumpTrial:
    return Day(seed=3, cuts=8, design_cuts=200).trial()


@pytest.fixture(scope="module")
def loops(trial: HumpTrial) -> ClosedLoops:
    made = TablePositions((coarse_classes(),) * 3, load_weight_categories())
    return ClosedLoops(trial, dict.fromkeys(REGULATORS, made), STDS_M_S)


@dataclass(frozen=True)
class Slower:
    """`position`, whose passes take longer."""

    position: HumpPosition

    def passed(self, arrivals: Arrivals) -> Passed:
        """See `HumpPosition`."""
        passed = self.position.passed(arrivals)
        return replace(passed, time_s=1.08 * passed.time_s)


@pytest.mark.long
def test_errors_of_normal_positions_are_found_again(trial: HumpTrial) -> None:
    """In the last position not all cuts are held."""
    found = exits_of({"normal": with_stds(trial, (0.1, 0.2, 0.05))}, 60)
    assert [each.number for each in found] == [1, 2, 3]
    assert found[2].rms_m_s.value > 0.06
    for each, std in zip(found, (0.1, 0.2), strict=False):
        assert each.passes > 300
        near = 4.0 * std / np.sqrt(2.0 * each.passes)
        assert each.rms_m_s.value == pytest.approx(std, abs=near + 0.02 * std)
        assert each.mean_m_s.value == pytest.approx(0.0, abs=2.0 * near + 0.05 * std)
        assert each.rms_m_s.ci95[0] < each.rms_m_s.value < each.rms_m_s.ci95[1]
        assert each.longer_than_even.value == pytest.approx(0.0, abs=1e-12)
    slower = replace(trial, positions=tuple(map(Slower, trial.positions)))
    for each in exits_of({"slower": slower}, 10):
        assert each.longer_than_even.value == pytest.approx(0.08)


@pytest.mark.long
def test_families_are_run_on_common_programs_and_every_comparison_has_its_curves(loops: ClosedLoops) -> None:
    families = loops.families()
    normal = normal_families(loops.base, STDS_M_S)
    lines = lines_of(normal, families)
    assert len(set(lines)) == len(lines)
    assert {c for name, c in lines if name in REGULATORS} == set(REGULATED)
    assert {c for name, c in lines if name == sigma(0.03)} == set(CONTROLS)
    least = (1.0, 0.0)
    for part in (normal, families):
        groups = frontier_groups(part, least)
        assert [next(iter(g.trials.values())).planner.least_s for g in groups] == list(least)
        assert all(len(group.trials) == len(lines_of(part)) for group in groups)
    assert {(name, WITH_FEEDBACK) for name in (loops.best, loops.commanded)} < set(lines)


def made_up(trial: HumpTrial, names: list[str], controls: tuple[str, ...]) -> Frontier:
    """Positions number k of `names` need 1 / (1 + k / 10) of the time of others; of their two programs the first has no
    catch-ups, the second is twice as fast and has one a train of eight cuts."""
    few = joined([replace(trial, control=OPEN).batch(0, TRAINS)] * 6)
    outcomes: dict[str, TrainOutcomes] = {}
    for place, name in enumerate(names):
        for least, caught in ((1.0, 0), (0.0, 1)):
            span = few.span_s / (1.0 + 0.1 * place) / (1.0 + caught)
            each = replace(few, span_s=span, caught=np.full(len(few), caught))
            outcomes |= {f"{name}, {control}, {least:g} s": each for control in controls}
    lines = tuple((name, control) for name in names for control in controls)
    return Frontier(outcomes, lines, (1.0, 0.0), (1.0 / 16.0,), (), 1)


@pytest.mark.long
def test_gains_are_differences_of_the_curves_that_they_name(trial: HumpTrial, loops: ClosedLoops) -> None:
    names = [*map(sigma, STDS_M_S), *REGULATORS, loops.commanded]
    frontier = made_up(trial, names, tuple(CONTROLS))
    slow = frontier.outcomes[f"{names[0]}, {OPEN_LOOP}, 1 s"]
    cars = 1.5 * 3600.0 * slow.span_cars.sum() / slow.span_s.sum()  # the limit is halfway from once to twice as fast
    found = {(g.more, g.than): g.cars_per_hour for g in table_gains(frontier, loops)}
    assert len(found) == len(REGULATED) * 5 + 4
    value = found[f"{TABLES}, {OPEN_LOOP}", f"{sigma(0.15)}, {OPEN_LOOP}"]
    assert value is not None
    assert value.value == pytest.approx(0.1 * (names.index(TABLES) - 1) * cars)
    assert found[f"{TABLES}, {WITH_FEEDBACK}", f"{TABLES}, {OPEN_LOOP}"] == Value(0.0, (0.0, 0.0))
    parts = [(TABLES, loops.commanded), (loops.commanded, loops.best), (TABLES, loops.best)]
    told = [found[f"{more}, {WITH_FEEDBACK}", f"{than}, {WITH_FEEDBACK}"] for more, than in parts]
    values = [each.value for each in told if each is not None]
    assert sum(values[:-1]) == pytest.approx(values[-1])
    assert len(normal_gains(frontier, STDS_M_S)) == 13


def test_a_curve_that_was_not_run_in_open_loop_has_nothing_to_be_better_than(trial: HumpTrial) -> None:
    (group,) = frontier_groups(normal_families(trial, (0.35,)), (1.0,))
    outcomes = dict(zip(group.trials, group.batch(0, TRAINS, OUTCOMES), strict=True))
    line = (sigma(0.35), WITH_FEEDBACK)
    alone = Frontier(outcomes, (line,), (1.0,), (0.5,), (), 1).curve(line)
    beside = Frontier(outcomes, (line, (sigma(0.35), OPEN_LOOP)), (1.0,), (0.5,), (), 1).curve(line)
    assert alone.points[0].fewer is None
    assert beside.points[0].fewer is not None
    assert alone.points[0].figures == beside.points[0].figures


def test_books_differ_in_the_estimator_alone() -> None:
    plain, estimating = PARK.config(estimator=False), PARK.config(estimator=True)
    assert not plain.regulator.estimator
    assert estimating.regulator.estimator
    assert [label for label, _ in plain.plants()] == [label for label, _ in estimating.plants()]
