"""A table's loop by python-control and by the simulator: how far apart, in which order, and where they may part."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest

from plant_models import Plant
from synth.frame.summary import plain
from synth.retarder.control_loop import TOLERANCE_M_S
from synth.retarder.estimation.estimator_design import estimator_of
from synth.retarder.line_control_loop import ENTRIES, LineControlLoop, line_control_loop
from synth.retarder.served_class import ServedClass
from synth.simulation.closed_loop import TableController, close_loop
from synth.simulation.nominal_pass import nominal_entry_m_s, nominal_pass, nominal_plant, one_pass
from synth.simulation.nominal_response import commands_of, nominal_response, parting, response_difference
from tests.synth.test_control_system import table_for

pytest.importorskip("control")


@pytest.fixture(scope="module")
def loop(plant_52t: Plant) -> LineControlLoop:
    """The loop of a plausible table."""
    return line_control_loop(table_for(plant_52t), ServedClass("gondola", plant_52t))


def test_the_nominal_plant_has_no_chance_left(plant_52t: Plant) -> None:
    """Passes that differ in every random number but entry and phase end alike; on the real plant they do not."""
    one = one_pass(0.5, 0.5)
    other = replace(one, cut_z=one.cut_z + 2.0, resistance_u=0.9 * one.weight, noise_z=one.noise_z + np.float32(1.0))
    exits = {}
    for name, plant in (("nominal", nominal_plant(plant_52t)), ("real", plant_52t)):
        law = TableController(table_for(plant))
        closed = close_loop(plant, law.stages)
        exits[name] = {float(closed.run(law, closed.draws(passes)).exit_speed_m_s[0]) for passes in (one, other)}
    assert (len(exits["nominal"]), len(exits["real"])) == (1, 2)


def test_the_difference_falls_with_the_square_of_the_simulators_step(plant_52t: Plant) -> None:
    """The simulator plays transients in parts of constant pressure, python-control integrates them: second order."""
    plant, phase_s = nominal_plant(plant_52t), 0.5 * plant_52t.sensor.sample_period_s
    law = TableController(table_for(plant))
    errors: dict[int, list[float]] = {parts: [] for parts in (1, 2, 4, 8)}
    for entry_u in (0.05, 0.35, 0.65, 0.95):
        exact = nominal_response(plant, law, nominal_entry_m_s(plant, entry_u), phase_s)
        assert len(commands_of(exact)) >= 2
        for parts, found in errors.items():
            closed = close_loop(plant, law.stages, parts)
            trace = closed.follow(law, closed.draws(one_pass(entry_u, 0.5)))
            assert response_difference(exact, trace).parted_s is None
            found.append(exact.exit_speed_m_s - trace.exit_speed_m_s)
    rms = [float(np.sqrt(np.mean(np.square(found)))) for found in errors.values()]
    print("rms difference at the exit, m/s, by parts of a period:", dict(zip(errors, rms, strict=True)))
    assert rms[0] > 1e-4  # there is something to converge
    assert np.log2(rms[0] / rms[3]) / 3.0 > 1.5
    assert rms[3] < 2e-5


@pytest.mark.parametrize("entry_u", [0.1, 0.5, 0.9])
def test_a_table_with_estimator_is_followed_too(plant_52t: Plant, entry_u: float) -> None:
    """The estimator's own text runs in both; in python-control on the pressure that is integrated there."""
    plant = replace(
        plant_52t, sensor=replace(plant_52t.sensor, resolution_m_s=0.5)
    )  # coarse: there is much to estimate
    without_it = TableController(table_for(plant))
    law = TableController(replace(table_for(plant), estimator=estimator_of(plant)))
    phase_s = 0.3 * plant.sensor.sample_period_s
    response = nominal_response(plant, law, nominal_entry_m_s(plant, entry_u), phase_s)
    found = response_difference(response, nominal_pass(plant, law, entry_u, 0.3))
    assert found.parted_s is None
    assert abs(found.largest_m_s) < TOLERANCE_M_S
    without = nominal_pass(plant, without_it, entry_u, 0.3)
    assert abs(response.exit_speed_m_s - without.exit_speed_m_s) > TOLERANCE_M_S  # so the estimator does something


def test_the_loop_agrees_and_its_document_is_plain(loop: LineControlLoop) -> None:
    assert loop.agrees
    assert loop.difference.parted_s is None
    assert len(loop.portrait) == ENTRIES
    entries = [float(response.speed_m_s[0]) for response in loop.portrait]
    assert entries == sorted(entries)
    document = json.loads(json.dumps(plain(loop.document), allow_nan=False))
    assert document["difference"]["agrees"] is True
    assert document["python_control"]["commands"] == [list(each) for each in commands_of(loop.response)]
    assert document["simulator"]["exit_speed_m_s"] == loop.trace.exit_speed_m_s
    assert len(document["limit_cycles"]) == len(loop.hunting)


def test_a_difference_is_found(loop: LineControlLoop) -> None:
    """Planted: a pass that is 5 mm/s faster for a moment, and one that commands another stage from a sample on."""
    trace = loop.trace
    bump = np.where(np.arange(trace.time_s.size) == trace.time_s.size // 2, 0.005, 0.0)
    apart = response_difference(loop.response, replace(trace, speed_m_s=trace.speed_m_s + bump))
    assert apart.largest_m_s == pytest.approx(-0.005, abs=TOLERANCE_M_S)
    assert not replace(loop, trace=replace(trace, speed_m_s=trace.speed_m_s + bump)).agrees
    later = replace(trace, stage=np.where(trace.time_s > 0.6 * trace.time_s[-1], 4, trace.stage))
    parted = response_difference(loop.response, later)
    assert parted.parted_s is not None
    assert 0.0 < parted.parted_s < trace.time_s[-1]
    assert abs(parted.largest_m_s) <= TOLERANCE_M_S  # what comes after the parting does not count


@pytest.mark.parametrize(
    ("one", "other", "at"),
    [
        ((), (), None),
        (((0.1, 1),), ((0.1 + 1e-9, 1),), None),
        (((0.1, 1), (0.5, 2)), ((0.1, 1), (0.6, 2)), 0.5),
        (((0.1, 1), (0.5, 2)), ((0.1, 1), (0.5, 0)), 0.5),
        (((0.1, 1), (0.5, 2)), ((0.1, 1),), 0.5),
        (((0.1, 1),), ((0.1, 1), (0.7, 2)), 0.7),
    ],
)
def test_commands_part_where_they_first_differ(
    one: tuple[tuple[float, int], ...], other: tuple[tuple[float, int], ...], at: float | None
) -> None:
    assert parting(one, other) == at
    assert parting(other, one) == at
