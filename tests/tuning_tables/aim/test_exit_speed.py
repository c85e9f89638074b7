"""The rule of aim tables against scipy's interpolation, and the properties that it promises."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import pytest
from scipy.interpolate import RegularGridInterpolator

from tests.tuning_tables.aim.made_tables import (
    BOUNDS_M_S,
    DISTANCES_M,
    category_table,
    exact_speed,
    measured_table,
    random_table,
)
from tuning_tables.aim import AimTable, aim_exit_speed, aim_exit_speeds

TABLES = [random_table(seed, measured) for seed in range(40) for measured in (False, True)]
Questions = tuple[npt.NDArray[np.int64], npt.NDArray[np.float64], npt.NDArray[np.float64]]


def questions_within(table: AimTable, count: int, seed: int) -> Questions:
    """Listed numbers of cars or some more, places on both axes, a few at nodes."""
    random = np.random.default_rng(seed)
    cars = random.choice(table.axes.cars, count) + random.integers(0, 3, count)
    axes = (table.distance_nodes, table.resistance_nodes)
    distance, resistance = (
        np.where(random.random(count) < 0.1, random.choice(axis, count), random.uniform(axis[0], axis[-1], count))
        for axis in axes
    )
    return cars, distance, resistance


def by_scipy(table: AimTable, cars: int, point: tuple[float, float]) -> float:
    """Linear interpolation in double precision, on the nodes as float32 for a listed number of cars."""
    values = table.speed_nodes[np.flatnonzero(table.axes.cars <= cars)[-1]].astype(np.float64)
    axes = [table.distance_nodes, table.resistance_nodes]
    # scipy takes no axis with a single node.
    kept = [axis for axis in (0, 1) if len(axes[axis]) > 1]
    if not kept:
        return float(values[0, 0])
    grid = [axes[axis].astype(np.float64) for axis in kept]
    interpolate = RegularGridInterpolator(grid, values.squeeze())
    return float(interpolate([float(np.float32(point[axis])) for axis in kept])[0])


@pytest.mark.parametrize("table", TABLES, ids=lambda table: table.id)
def test_between_nodes_it_is_scipys_interpolation(table: AimTable) -> None:
    cars, distance, resistance = questions_within(table, 60, 7)
    found = aim_exit_speeds(table, cars, distance, resistance)
    compared = 0
    for place in np.flatnonzero(~np.isnan(found)):
        expected = by_scipy(table, int(cars[place]), (float(distance[place]), float(resistance[place])))
        # scipy multiplies a missing speed by a weight of 0, so that at a node beside it there is none.
        if not np.isnan(expected):
            assert found[place] == pytest.approx(expected, abs=3e-6)
            compared += 1
    assert compared == np.count_nonzero(~np.isnan(found)) or np.isnan(table.exit_speed_m_s).any()


@pytest.mark.parametrize("table", TABLES, ids=lambda table: table.id)
def test_no_answer_exactly_where_a_node_that_counts_has_none(table: AimTable) -> None:
    cars, distance, resistance = questions_within(table, 300, 8)
    found = aim_exit_speeds(table, cars, distance, resistance)
    missing = np.isnan(table.speed_nodes)
    for place in range(len(cars)):
        row = int(np.flatnonzero(table.axes.cars <= cars[place])[-1])
        far = counted(table.distance_nodes, distance[place])
        high = counted(table.resistance_nodes, resistance[place])
        assert bool(np.isnan(found[place])) == bool(missing[row][np.ix_(far, high)].any())


def counted(nodes: npt.NDArray[np.float32], value: float) -> npt.NDArray[np.bool_]:
    """The nodes to which linear interpolation gives a weight above 0."""
    unit = np.eye(len(nodes))
    weights = np.array([np.interp(float(np.float32(value)), nodes.astype(np.float64), each) for each in unit])
    found: npt.NDArray[np.bool_] = weights > 0.0
    return found


def test_at_nodes_it_is_the_speed_of_the_table_to_the_last_bit() -> None:
    for table in TABLES:
        cars, distance, resistance = np.meshgrid(
            table.axes.cars, table.distance_nodes, table.resistance_nodes, indexing="ij"
        )
        assert np.array_equal(aim_exit_speeds(table, cars, distance, resistance), table.speed_nodes, equal_nan=True)


def test_it_stays_within_its_nodes_and_does_not_fall() -> None:
    """With the distance not at all in a table by category; else by what rounding to float32 may take, one step."""
    for table in TABLES:
        low, high = map(np.float32, BOUNDS_M_S)
        nodes = table.distance_nodes
        dense = np.unique(np.concatenate([np.linspace(nodes[0], nodes[-1] + 50.0, 800, dtype=np.float32), nodes]))
        for cars in table.axes.cars.tolist():
            for resistance in np.linspace(table.resistance_nodes[0] - 1.0, table.resistance_nodes[-1] + 1.0, 7):
                speeds = aim_exit_speeds(table, cars, dense, resistance)
                gone = np.isnan(speeds)
                assert not (gone[:-1] & ~gone[1:]).any()
                answers = speeds[~gone]
                assert ((answers >= low) & (answers <= high)).all()
                assert np.diff(answers).min(initial=0.0) >= (-1e-6 if table.is_measured else 0.0)


def test_cars_between_two_listed_numbers_take_the_lower() -> None:
    table = category_table()
    for cars, row in ((1, 0), (2, 1), (4, 2), (5, 3), (7, 3), (8, 4), (1000, 4), (2**40, 4)):
        assert aim_exit_speed(table, cars, 100.0) == table.speed_nodes[row, 2, 0]


def test_beyond_the_axes() -> None:
    table = measured_table()
    last = table.speed_nodes[4, -1]
    assert aim_exit_speed(table, 8, 3.4e38, 2.2) == last[3]
    assert aim_exit_speed(table, 8, 400.0, 99.0) == aim_exit_speed(table, 8, 400.0, 3.4e38) == last[4]
    assert aim_exit_speed(table, 8, 20.0, -5.0) == table.speed_nodes[4, 0, 0]
    before = float(np.nextafter(np.float32(20.0), np.float32(0.0)))
    assert aim_exit_speed(table, 8, before, 2.2) is None
    # Rounded to float32 first, as a controller receives it.
    assert aim_exit_speed(table, 8, np.nextafter(20.0, 0.0), 2.2) == table.speed_nodes[4, 0, 3]


@pytest.mark.parametrize(
    ("cars", "distance", "resistance"),
    [
        (0, 100.0, 2.0), (-1, 100.0, 2.0), (1, 19.9, 2.0), (1, -100.0, 2.0), (1, np.nan, 2.0), (1, np.inf, 2.0),
        (1, 1e39, 2.0), (1, 100.0, np.nan), (1, 100.0, np.inf), (1, 100.0, -np.inf), (1, 100.0, 1e39),
        (1, 100.0, None), (1, 400.0, 0.4), (1, 390.0, 1.2),
    ],
)  # fmt: skip
def test_what_has_no_answer(cars: int, distance: float, resistance: float | None) -> None:
    assert aim_exit_speed(measured_table(2.0), cars, distance, resistance) is None


def test_a_table_by_category_does_not_look_at_the_resistance() -> None:
    table = category_table()
    for resistance in (None, np.nan, np.inf, -7.0):
        assert aim_exit_speed(table, 2, 60.0, resistance) == aim_exit_speed(table, 2, 60.0)


def test_cars_are_whole_numbers() -> None:
    for cars in (1.0, True, np.float32(2.0)):
        with pytest.raises(TypeError, match="whole number of cars"):
            aim_exit_speed(category_table(), cars, 100.0)  # type: ignore[arg-type]  # what is tested


def test_one_question_is_answered_as_many() -> None:
    table = measured_table()
    cars, distance, resistance = questions_within(table, 500, 9)
    together = aim_exit_speeds(table, cars, distance, resistance)
    for place in range(500):
        alone = aim_exit_speed(table, int(cars[place]), distance[place], resistance[place])
        assert np.array_equal(np.float32(np.nan if alone is None else alone), together[place], equal_nan=True)
    assert aim_exit_speeds(table, [[1], [2]], [20.0, 30.0, 40.0], 2.0).shape == (2, 3)


def test_between_nodes_the_chord_is_below_the_exact_speed() -> None:
    """On a constant grade the speed is concave in the distance: what interpolation adds is on the safe side."""
    table = category_table()
    distance = np.linspace(DISTANCES_M[0], DISTANCES_M[-1], 999)
    for row, cars in enumerate(table.axes.cars.tolist()):
        exact = exact_speed(distance, 1.6 - 0.9 / np.sqrt(cars), 0.6)
        shortfall = exact - aim_exit_speeds(table, cars, distance)
        assert shortfall.min() > -1e-6
        assert shortfall.max() < 0.02
        assert row < 3 or shortfall.max() > 1e-3
