"""The rule of aim tables against scipy's interpolation, and the properties that it promises."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import numpy.typing as npt
import pytest
from scipy.interpolate import RegularGridInterpolator

from synth.kernels.aim_speeds import aim_exit_speeds
from tests.tuning_tables.aim.made_tables import (
    BOUNDS_M_S,
    DISTANCES_M,
    category_table,
    exact_speed,
    measured_table,
    random_table,
    reported_of,
)
from tuning_tables.aim import AimAxes, AimTable, aim_exit_speed

TABLES = [random_table(seed, measured) for seed in range(40) for measured in (False, True)]
Questions = tuple[npt.NDArray[np.int64], npt.NDArray[np.float64], npt.NDArray[np.float64]]


def questions_within(table: AimTable, count: int, seed: int) -> Questions:
    """Listed numbers of cars or some more, places on both axes, a few at nodes."""
    random = np.random.default_rng(seed)
    cars = np.minimum(random.choice(table.axes.cars, count) + random.integers(0, 3, count), table.axes.cars[-1])
    axes = (table.held.distance_m, table.held.resistance_n_per_kn)
    distance, resistance = (
        np.where(random.random(count) < 0.1, random.choice(axis, count), random.uniform(axis[0], axis[-1], count))
        for axis in axes
    )
    return cars, distance, resistance


def speeds_of(table: AimTable) -> npt.NDArray[np.float32]:
    """The speeds at the nodes, NaN for none."""
    return np.where(table.held.speed_m_s < 0.0, np.float32(np.nan), table.held.speed_m_s)


def rows_of(table: AimTable, cars: int) -> list[int]:
    """Where the greatest listed number not above `cars` and the least not below it stand."""
    listed = table.axes.cars.tolist()
    return [listed.index(max(n for n in listed if n <= cars)), listed.index(min(n for n in listed if n >= cars))]


def by_scipy(table: AimTable, row: int, point: tuple[float, float]) -> float:
    """Linear interpolation in double precision, on the nodes as float32 for a listed number of cars."""
    values = speeds_of(table)[row].astype(np.float64)
    axes = [table.held.distance_m, table.held.resistance_n_per_kn]
    # scipy takes no axis with a single node.
    kept = [axis for axis in (0, 1) if len(axes[axis]) > 1]
    if not kept:
        return float(values[0, 0])
    grid = [axes[axis].astype(np.float64) for axis in kept]
    interpolate = RegularGridInterpolator(grid, values.squeeze())
    return float(interpolate([float(np.float32(point[axis])) for axis in kept])[0])


@pytest.mark.requirement("AIM-01")
@pytest.mark.parametrize("table", TABLES, ids=lambda table: table.id)
def test_between_nodes_it_is_scipys_interpolation(table: AimTable) -> None:
    cars, distance, resistance = questions_within(table, 60, 7)
    found = aim_exit_speeds(table.held, cars, distance, resistance)
    compared = 0
    for place in np.flatnonzero(~np.isnan(found)):
        point = float(distance[place]), float(resistance[place])
        expected = np.min([by_scipy(table, row, point) for row in rows_of(table, int(cars[place]))])
        # scipy multiplies a missing speed by a weight of 0, so that at a node beside it there is none.
        if not np.isnan(expected):
            assert found[place] == pytest.approx(expected, abs=3e-6)
            compared += 1
    assert compared == np.count_nonzero(~np.isnan(found)) or np.isnan(table.exit_speed_m_s).any()


@pytest.mark.requirement("AIM-02")
@pytest.mark.parametrize("table", TABLES, ids=lambda table: table.id)
def test_no_answer_exactly_where_a_node_that_counts_has_none(table: AimTable) -> None:
    cars, distance, resistance = questions_within(table, 300, 8)
    found = aim_exit_speeds(table.held, cars, distance, resistance)
    missing = table.held.speed_m_s < 0.0
    for place in range(len(cars)):
        rows = np.array(rows_of(table, int(cars[place])))
        far, high = (np.flatnonzero(counted(*each)) for each in sides_of(table, distance[place], resistance[place]))
        assert bool(np.isnan(found[place])) == bool(missing[np.ix_(rows, far, high)].any())


def sides_of(table: AimTable, distance: float, resistance: float) -> list[tuple[npt.NDArray[np.float32], float]]:
    return [(table.held.distance_m, distance), (table.held.resistance_n_per_kn, resistance)]


def counted(nodes: npt.NDArray[np.float32], value: float) -> npt.NDArray[np.bool_]:
    """The nodes to which linear interpolation gives a weight above 0."""
    unit = np.eye(len(nodes))
    weights = np.array([np.interp(float(np.float32(value)), nodes.astype(np.float64), each) for each in unit])
    found: npt.NDArray[np.bool_] = weights > 0.0
    return found


def test_at_nodes_it_is_the_speed_of_the_table_to_the_last_bit() -> None:
    for table in TABLES:
        cars, distance, resistance = np.meshgrid(
            table.axes.cars, table.held.distance_m, table.held.resistance_n_per_kn, indexing="ij"
        )
        assert np.array_equal(aim_exit_speeds(table.held, cars, distance, resistance), speeds_of(table), equal_nan=True)


@pytest.mark.requirement("AIM-01")
def test_it_stays_within_the_nodes_around_it() -> None:
    for table in TABLES:
        nodes, first = table.held.distance_m, table.held.resistance_n_per_kn[0]
        dense = np.linspace(nodes[0], nodes[-1], 801, dtype=np.float32)
        below = np.searchsorted(nodes, dense, side="right") - 1
        above = np.minimum(np.searchsorted(nodes, dense), len(nodes) - 1)
        for row, cars in enumerate(table.axes.cars.tolist()):
            speeds = aim_exit_speeds(table.held, cars, dense, first)
            ends = speeds_of(table)[row, :, 0]
            low, high = np.fmin(ends[below], ends[above]), np.fmax(ends[below], ends[above])
            gone = np.isnan(speeds)
            assert ((speeds >= low) & (speeds <= high))[~gone].all()
            assert (speeds[~gone] >= np.float32(BOUNDS_M_S[0])).all()
            assert (speeds[~gone] <= np.float32(BOUNDS_M_S[1])).all()


def test_it_does_not_fall_with_the_resistance() -> None:
    """But by what rounding to float32 may take."""
    for table in TABLES:
        dense = np.linspace(
            table.held.resistance_n_per_kn[0] - 1.0, table.held.resistance_n_per_kn[-1] + 1.0, 400, dtype=np.float32
        )
        for cars in table.axes.cars.tolist():
            for distance in np.linspace(table.held.distance_m[0], table.held.distance_m[-1] + 10.0, 9):
                speeds = aim_exit_speeds(table.held, cars, distance, dense)
                assert np.diff(speeds[~np.isnan(speeds)]).min(initial=0.0) > -2e-6


@pytest.mark.requirement("AIM-03", "AIM-04")
def test_cars_between_two_listed_numbers_take_the_lesser_answer() -> None:
    table = category_table(1.0)  # 1 car: falls, and none at 400 m; from 3 on: rises
    for distance in (20.0, 37.0, 300.0, 350.0):
        speeds = {cars: aim_exit_speed(table, cars, distance) for cars in range(9)}
        assert speeds[4] == min(speeds[3] or 9.0, speeds[5] or 9.0)
        assert speeds[6] == speeds[7] == min(speeds[5] or 9.0, speeds[8] or 9.0)
    falling = replace(
        table, exit_speed_m_s=table.exit_speed_m_s[::-1], reported=reported_of(table.exit_speed_m_s[::-1])
    )
    assert aim_exit_speed(falling, 4, 20.0) == aim_exit_speed(falling, 5, 20.0) == falling.held.speed_m_s[3, 0, 0]
    assert aim_exit_speed(falling, 7, 350.0) is None is aim_exit_speed(falling, 8, 350.0)
    assert aim_exit_speed(falling, 5, 350.0) is not None
    for cars in (0, -1, 9, 1000, 2**40):
        assert aim_exit_speed(table, cars, 100.0) is None


@pytest.mark.requirement("AIM-05")
def test_beyond_the_last_distance_only_a_speed_that_does_not_fall_there_counts() -> None:
    table = category_table(1.0)
    assert table.held.speed_m_s[0, -1, 0] == -1.0
    assert table.held.speed_m_s[1, -1, 0] < table.held.speed_m_s[1, -2, 0]
    for distance in (np.nextafter(np.float32(400.0), np.float32(500.0)), 401.0, 3.4e38):
        assert aim_exit_speed(table, 1, float(distance)) is None is aim_exit_speed(table, 2, float(distance))
        assert aim_exit_speed(table, 3, float(distance)) == table.held.speed_m_s[2, -1, 0]
    assert aim_exit_speed(table, 2, 400.0) == table.held.speed_m_s[1, -1, 0]
    speeds = table.exit_speed_m_s.copy()
    speeds[:, -1] = speeds[:, -2] = 1.5
    speeds[4, -2] = np.nan
    flat = replace(table, exit_speed_m_s=speeds, reported=reported_of(speeds))
    assert aim_exit_speed(flat, 3, 500.0) == 1.5
    assert aim_exit_speed(flat, 8, 500.0) is None  # whether it falls is not known
    one = np.array([[1.5]])
    axes = AimAxes(np.array([1]), np.array([50.0]))
    single = replace(table, axes=axes, exit_speed_m_s=one, reported=reported_of(one))
    assert aim_exit_speed(single, 1, 50.0) == 1.5
    assert aim_exit_speed(single, 1, 50.1) is None


def test_beyond_the_last_distance_both_resistances_count() -> None:
    table = measured_table()
    falls = table.held.speed_m_s[4, -1] < table.held.speed_m_s[4, -2]
    missing = table.held.speed_m_s[4, -1] < 0.0
    assert (falls | missing).tolist() == [True, True, False, False, False]
    assert aim_exit_speed(table, 8, 500.0, 1.5) == table.held.speed_m_s[4, -1, 2]
    assert aim_exit_speed(table, 8, 500.0, 1.4999) is None
    assert aim_exit_speed(table, 8, 399.9, 1.4999) is not None


def test_outside_the_axes() -> None:
    table = measured_table()
    last = speeds_of(table)[4, -1]
    assert aim_exit_speed(table, 8, 3.4e38, 2.2) == last[3]
    assert aim_exit_speed(table, 8, 400.0, 99.0) == aim_exit_speed(table, 8, 400.0, 3.4e38) == last[4]
    assert aim_exit_speed(table, 8, 20.0, -5.0) == table.held.speed_m_s[4, 0, 0]
    before = float(np.nextafter(np.float32(20.0), np.float32(0.0)))
    assert aim_exit_speed(table, 8, before, 2.2) is None
    # Rounded to float32 first, as a controller receives it.
    assert aim_exit_speed(table, 8, np.nextafter(20.0, 0.0), 2.2) == table.held.speed_m_s[4, 0, 3]


@pytest.mark.requirement("AIM-04")
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
    together = aim_exit_speeds(table.held, cars, distance, resistance)
    for place in range(500):
        alone = aim_exit_speed(table, int(cars[place]), distance[place], resistance[place])
        assert np.array_equal(np.float32(np.nan if alone is None else alone), together[place], equal_nan=True)
    assert aim_exit_speeds(table.held, [[1], [2]], [20.0, 30.0, 40.0], 2.0).shape == (2, 3)


def test_between_nodes_the_chord_is_below_the_exact_speed() -> None:
    """On a constant grade the speed is concave in the distance, rising or falling: chords are on the safe side."""
    table = category_table(1.0)
    distance = np.linspace(DISTANCES_M[0], DISTANCES_M[-1], 999)
    for row, cars in enumerate(table.axes.cars.tolist()):
        exact = exact_speed(distance, 1.6 - 0.9 / np.sqrt(cars), 1.0)
        shortfall = exact - aim_exit_speeds(table.held, cars, distance)
        told = shortfall[~np.isnan(shortfall)]
        assert told.min() > -1e-6
        assert 1e-5 < told.max() < (0.05 if cars == 1 else 0.02)
        assert len(told) == (len(distance) if row else np.count_nonzero(distance <= 300.0))
