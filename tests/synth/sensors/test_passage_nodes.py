"""Nodes of passages on the path of a chain: each its own, next to its place, and none where the cut has left."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from plant_models import every_axle
from plant_models.point_sensors import deciding_passages
from synth.configuration.config_file import parse_config
from synth.configuration.point_sensors.template import default_sensors_toml
from synth.solver.chain.sensor_passages import SensorPassages, nodes_of
from synth.solver.passage_speeds import SMALLEST_GAP_M_S, ordered


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


def test_infinite_switching_speeds_keep_their_order() -> None:
    infinite = np.inf
    speeds = np.array([[[2.0, infinite], [infinite, infinite], [-infinite, 3.0]]])
    found = ordered(speeds)  # numpy's warnings are errors here
    assert found[0, 1].tolist() == [infinite, infinite]
    close = ordered(np.array([[[2.0, infinite], [2.0, 2.0], [1.0, 3.0]]]))
    assert close[0, 1, 1] - close[0, 1, 0] >= SMALLEST_GAP_M_S
