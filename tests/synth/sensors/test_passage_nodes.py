"""Nodes of passages on the path of a chain: each its own, next to its place, and none where the cut has left."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from plant_models import PointSensors, every_axle, first_axle
from plant_models.point_sensors import Axles, Passage, deciding_passages
from synth.problem.resolution import Resolution
from synth.retarder.configuration.config_file import parse_config
from synth.retarder.configuration.config_template import default_sensors_toml
from synth.solver.chain.chain import persistent_chain
from synth.solver.chain.sensor_passages import SensorPassages, nodes_of, with_point_sensors
from synth.solver.passage_speeds import SMALLEST_GAP_M_S, PassageSpeeds, ordered
from synth.solver.resolved_density import resolved_density
from tests.synth.conftest import pilot_plant


@given(
    places=st.lists(st.floats(0.0, 40.0), min_size=1, max_size=20).map(sorted),
    spare=st.integers(1, 40),
)
def test_nodes_rise_and_stay_on_the_path(places: list[float], spare: int) -> None:
    steps = len(places) + spare
    place_m, step_m = np.array(places), 40.0 / steps
    node = nodes_of(place_m, step_m, steps)
    assert (np.diff(node) > 0).all()
    assert node[0] >= 0
    assert node[-1] < steps
    alone = np.diff(place_m, prepend=-100.0, append=100.0).min() > 2.0 * step_m
    if alone and places[-1] < 40.0 - step_m:
        assert (np.abs(place_m - node * step_m) <= 0.5 * step_m + 1e-9).all()


def test_a_passage_right_before_the_exit_is_decided_there() -> None:
    # The last axles of a 6-axle car pass a sensor 0.3 m before the exit, nearer to the last node than to any other.
    config = parse_config(default_sensors_toml().replace('"first_axle"\n', '"every_axle"\n'), "x.toml")
    assert config.sensors is not None
    sensors, (_, six) = config.sensors.sensors, config.plants()[1]
    assert sensors.axles is every_axle
    plant = config.sensors.serving(six)
    met = deciding_passages(sensors, plant.cut, plant.exit_m)
    epochs = SensorPassages(sensors)
    grid = epochs.grid(plant, config.resolution)
    node = epochs.decisions(plant, grid).node
    assert plant.exit_m - met[-1].path_m < 0.5
    assert len(node) == len(met)
    assert node[-1] < len(grid.path_m) - 1
    epochs.measurement(plant, grid)  # looks up the brake at every node


@pytest.mark.parametrize("axles", [first_axle, every_axle])
def test_passages_are_nodes_and_the_figures_hardly_depend_on_the_path_step(axles: Axles) -> None:
    sensors = PointSensors((-5.0, 1.3, 6.1, 9.2, 14.7, 21.4), axles=axles)
    plant = with_point_sensors(pilot_plant(22.0), sensors)
    met = deciding_passages(sensors, plant.cut, plant.exit_m)
    rms = []
    for step_m in (0.5, 0.125):
        grid = Resolution(path_step_m=step_m, speed_step_m_s=0.015, friction_nodes=7, resistance_nodes=1)
        chain = persistent_chain(plant, grid, SensorPassages(sensors))
        at_nodes = chain.grid.path_m[chain.decisions.node]
        assert at_nodes == pytest.approx([each.path_m for each in met], abs=1e-9)
        assert np.diff(chain.grid.path_m).min() > 0.0
        speeds = hard_rule(met, plant.exit_m, plant.top_stage)
        rms.append(resolved_density(chain, speeds, 3.0).rms_m_s(3.0))
    assert rms[0] == pytest.approx(rms[1], rel=0.005)  # 0.1 with the passages at the nodes next to them


def hard_rule(met: Sequence[Passage], exit_m: float, top: int) -> PassageSpeeds:
    """Stage j + 1 where v² > v_t² + 2·a_j·(S_exit − s), a_j in steps of 0.22 m/s²."""
    left_m = np.array([exit_m - max(each.path_m, 0.0) for each in met])
    speeds = np.sqrt(9.0 + 2.0 * 0.22 * (np.arange(top) + 0.4) * left_m[:, None])
    return PassageSpeeds(ordered(np.repeat(speeds[:, None, :], top + 1, axis=1)))


def test_passages_at_one_place_have_nodes_of_their_own() -> None:
    sensors = PointSensors((-5.0, 3.65, 12.3), axles=every_axle)  # two axles of a gondola are 8.65 m apart
    plant = with_point_sensors(pilot_plant(22.0), sensors)
    epochs = SensorPassages(sensors)
    grid = epochs.grid(plant, Resolution())
    place = epochs.decisions(plant, grid).place_m
    assert np.diff(place).min() == pytest.approx(1e-3)
    assert np.diff(grid.path_m).min() > 0.0


def test_infinite_switching_speeds_keep_their_order() -> None:
    infinite = np.inf
    speeds = np.array([[[2.0, infinite], [infinite, infinite], [-infinite, 3.0]]])
    found = ordered(speeds)  # numpy's warnings are errors here
    assert found[0, 1].tolist() == [infinite, infinite]
    close = ordered(np.array([[[2.0, infinite], [2.0, 2.0], [1.0, 3.0]]]))
    assert close[0, 1, 1] - close[0, 1, 0] >= SMALLEST_GAP_M_S
