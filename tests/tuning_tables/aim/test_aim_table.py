"""What makes no aim table is refused, with key and value; what is made cannot be changed."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from tests.tuning_tables.aim.made_tables import category_table, measured_table, reported_of
from tuning_tables.aim import AimAxes, AimCategory, AimTable, AimTables, MeasuredResistance, ParkPosition, Required
from tuning_tables.errors import InvalidTable

NAN = float("nan")


def test_arrays_are_copies_that_cannot_be_written() -> None:
    cars, distance, speeds = np.array([1, 2]), np.array([10.0, 20.0]), np.array([[1.0, 1.1], [1.2, 1.3]])
    reported = reported_of(speeds)
    table = replace(category_table(), axes=AimAxes(cars, distance), exit_speed_m_s=speeds, reported=reported)
    speeds[:], distance[:], cars[:] = 99.0, 99.0, 99
    assert table.exit_speed_m_s.tolist() == [[1.0, 1.1], [1.2, 1.3]]
    held: list[npt.NDArray[Any]] = [table.exit_speed_m_s, *table.held[-4:]]
    held += [table.axes.free_distance_m, reported.p_overspeed, reported.mean_gap_m]
    with pytest.raises(ValueError, match="read-only"):
        table.axes.cars[0] = 0
    for array in held:
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 0


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: Required(0.0, 1.39), r"required.p_overspeed is 0.0, but it must lie within \(0, 1\)"),
        (lambda: Required(1.0, 1.39), r"within \(0, 1\)"),
        (lambda: Required(NAN, 1.39), "required.p_overspeed"),
        (lambda: AimCategory(2, "Л"), "category.number of the category Л is 2, but it must be 1"),
        (lambda: AimCategory(5, "own"), "category.number of the category own"),
        (lambda: MeasuredResistance(10.0, 10.0, 0.1), "measured.to_m"),
        (lambda: AimAxes(np.array([1.0]), np.array([1.0])), "axes.cars must hold"),
        (lambda: AimAxes(np.array([], int), np.array([1.0])), "axes.cars must hold"),
        (lambda: AimAxes(np.array([[1]]), np.array([1.0])), "axes.cars must hold"),
        (lambda: AimAxes(np.arange(1, 66), np.array([1.0])), "axes.cars must hold 1 to 64"),
        (lambda: AimAxes(np.array([0, 1]), np.array([1.0])), "axes.cars is"),
        (lambda: AimAxes(np.array([2, 2]), np.array([1.0])), "axes.cars is"),
        (lambda: AimAxes(np.array([2, 1]), np.array([1.0])), "axes.cars is"),
        (lambda: AimAxes(np.array([1001]), np.array([1.0])), "axes.cars is"),
        (lambda: AimAxes(np.array([1]), np.array([2.0, 1.0])), "axes.free_distance_m is .* must rise"),
        (lambda: AimAxes(np.array([1]), np.array([1.0, 1.0005])), "must rise, by 0.001"),
        (lambda: AimAxes(np.array([1]), np.array([-1.0])), "axes.free_distance_m must hold numbers in"),
        (lambda: AimAxes(np.array([1]), np.array([10001.0])), "axes.free_distance_m must hold numbers in"),
        (lambda: AimAxes(np.array([1]), np.array([NAN])), "axes.free_distance_m must hold numbers in"),
        (lambda: AimAxes(np.array([1]), np.array([-0.0])), "without a sign"),
        (lambda: AimAxes(np.array([1]), np.array([])), "axes.free_distance_m must hold one"),
        (lambda: AimAxes(np.array([1]), np.array([1.0]), np.array([1.0, 0.5])), "axes.resistance_n_per_kn is"),
        (lambda: AimAxes(np.array([1]), np.array([1.0]), np.array([1001.0])), "axes.resistance_n_per_kn must"),
        (lambda: AimAxes(np.array([1]), np.arange(1.0, 101.0), np.arange(10.0)), "axes give 1000 nodes"),
        (lambda: AimAxes(np.arange(1, 23), np.arange(1.0, 101.0), np.arange(9.5)), "axes give 1000 nodes"),
        (lambda: AimAxes(np.arange(1, 24), np.arange(1.0, 100.0), np.arange(9.0)), "20000 in all"),
    ],
)  # fmt: skip
def test_parts_that_make_no_sense_are_refused(make: Callable[[], object], words: str) -> None:
    with pytest.raises(InvalidTable, match=words):
        make()


def speeds_with(place: tuple[Any, ...], value: Any, measured: bool = False) -> dict[str, Any]:
    table = measured_table(0.0) if measured else category_table()
    speeds = table.exit_speed_m_s.copy()
    speeds[place] = value
    return {"exit_speed_m_s": speeds, "reported": reported_of(speeds)}


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        (speeds_with((1, 3), 7.1), r"exit_speed_m_s\[1\]\[3\] is 7.1, but it must be null, or within \[0.5, 7.0\]"),
        (speeds_with((0, 0), 0.4), r"exit_speed_m_s\[0\]\[0\] is 0.4"),
        (speeds_with((0, 0), float("inf")), "finite, or null"),
        (speeds_with((4, 0, 3), 1.9, True), r"\[4\]\[0\]\[4\] is .* must be no less than for a smaller"),
        (speeds_with((4, 0, slice(2, 4)), (1.9, NAN), True), r"\[4\]\[0\]\[4\] is .* than for a smaller resistance"),
        ({"exit_speed_m_s": np.ones((5, 6))}, r"exit_speed_m_s has the shape \(5, 6\), but the axes give \(5, 7\)"),
        ({"exit_speed_m_s": np.ones((5, 7, 1))}, "has the shape"),
        ({"exit_speed_m_s": [[1.0], [1.0, 2.0]]}, "exit_speed_m_s makes no array"),
        ({"exit_speed_m_s": "speeds"}, "exit_speed_m_s makes no array"),
        ({"bounds_m_s": (7.0, 0.5)}, "the lower bound must come first"),
        ({"bounds_m_s": [0.5, 7.0]}, "must be a tuple"),
        ({"measured": MeasuredResistance(0.0, 1.0, 0.1)}, "axes.resistance_n_per_kn must be an axis unless"),
        ({"generator": None}, "generator is None"),
        ({"position": "rnz"}, "position is 'rnz'"),
        ({"reported": reported_of(np.ones((5, 6)))}, r"reported.p_overspeed has the shape \(5, 6\)"),
    ],
)  # fmt: skip
def test_values_that_make_no_table_are_refused(changed: dict[str, Any], words: str) -> None:
    speeds = changed.get("exit_speed_m_s")
    table = measured_table(0.0) if isinstance(speeds, np.ndarray) and speeds.ndim == 3 else category_table()
    with pytest.raises(InvalidTable, match=words):
        replace(table, **changed)


def test_a_measured_table_needs_knowledge_of_it() -> None:
    with pytest.raises(InvalidTable, match="must be null where the category alone is known"):
        replace(measured_table(), measured=None)


@pytest.mark.parametrize(
    ("name", "value", "words"),
    [
        ("passes", 0, "reported.passes"),
        ("p_overspeed_low95", 0.2, "within its interval"),
        ("p_overspeed_high95", 0.05, "within its interval"),
        ("p_overspeed_high95", 1.1, r"within \[0, 1\]"),
        ("p_overspeed_low95", -0.1, r"within \[0, 1\]"),
        ("mean_gap_m", -1.0, "reported.mean_gap_m"),
        ("mean_gap_m", NAN, "reported.mean_gap_m"),
        ("p_overspeed", NAN, "null exactly where reported.p_overspeed is"),
        ("mean_gap_m", np.ones((5, 6)), "has the shape"),
    ],
)
def test_figures_that_cannot_be_are_refused(name: str, value: Any, words: str) -> None:
    reported = reported_of(category_table().exit_speed_m_s)
    if isinstance(value, float):
        nodes = np.array(getattr(reported, name))
        nodes[2, 3] = value
        value = nodes
    with pytest.raises(InvalidTable, match=words):
        replace(reported, **{name: value})


def test_a_node_may_have_a_speed_and_no_figures_but_not_the_other_way_round() -> None:
    table = category_table(1.5)
    some = np.where(np.arange(7) < 2, np.nan, table.exit_speed_m_s)
    assert np.isnan(replace(table, reported=reported_of(some)).reported.mean_gap_m[:, :2]).all()
    with pytest.raises(InvalidTable, match=r"reported.p_overspeed\[0\]\[3\] .* null where there is no exit speed"):
        replace(table, reported=reported_of(np.nan_to_num(table.exit_speed_m_s, nan=1.0)))


def test_a_table_may_have_no_answer_at_all() -> None:
    table = category_table()
    nothing = np.full_like(table.exit_speed_m_s, np.nan)
    assert (replace(table, exit_speed_m_s=nothing, reported=reported_of(nothing)).held.speed_m_s == -1.0).all()


def test_speeds_may_fall_with_distance_and_cars_and_be_null_anywhere() -> None:
    random = np.random.default_rng(3)
    for _ in range(50):
        speeds = random.uniform(0.5, 7.0, (5, 7))
        speeds[random.random((5, 7)) < 0.3] = NAN
        replace(category_table(), exit_speed_m_s=speeds, reported=reported_of(speeds))


def test_along_the_resistance_every_fall_is_refused_and_nothing_else() -> None:
    """Rows with faults at random, compared with a search of all pairs."""
    random = np.random.default_rng(4)
    refused = 0
    for _ in range(150):
        speeds = np.sort(random.choice([0.5, 1.0, 1.0000001, 2.0, 3.0, 7.0], (5, 7, 5)), axis=2)
        place = tuple(int(random.integers(0, length)) for length in speeds.shape)
        speeds[place] = random.choice([NAN, 0.5, 7.0, 1.5])
        speeds[random.random(speeds.shape) < 0.2] = NAN
        falls = any(row[i] > row[j] for row in speeds.reshape(35, 5) for j in range(5) for i in range(j))
        refused += falls
        if falls:
            with pytest.raises(InvalidTable, match="no less than for a smaller resistance"):
                replace(measured_table(), exit_speed_m_s=speeds, reported=reported_of(speeds))
        else:
            replace(measured_table(), exit_speed_m_s=speeds, reported=reported_of(speeds))
    assert 30 < refused < 120


def named(table: AimTable, name: str, **changed: Any) -> AimTable:
    return replace(table, id=name, **changed)


@pytest.mark.parametrize(
    ("tables", "words"),
    [
        ((), "at least one"),
        ((category_table(), named(category_table(), "b")), "are both for the category Л by it alone"),
        ((measured_table(), named(measured_table(), "b")), "by its measured resistance"),
        ((category_table(), replace(measured_table(), id="aim-1-category")), "is given to 2 aim tables"),
        ((category_table(), replace(measured_table(), position=ParkPosition("other", 338.0))), "export them apart"),
        ((category_table(), replace(measured_table(), position=ParkPosition("rnz-2m-park", 339.0))), "export them"),
        ((category_table(0.6, 16, "own"), measured_table(1.0, 16, "mine")), "stands for own and for mine"),
        ((category_table(0.6, 16, "own"), measured_table(1.0, 17, "own")), "stand for one name"),
    ],
)  # fmt: skip
def test_tables_that_make_no_set_are_refused(tables: tuple[AimTable, ...], words: str) -> None:
    with pytest.raises(InvalidTable, match=words):
        AimTables(tables)


def test_a_set_finds_its_tables() -> None:
    made = (category_table(), measured_table(), category_table(0.6, 5, "Т"))
    aims = AimTables(made)
    assert [aims.select(number, measured) for number, measured in ((1, False), (1, True), (5, False))] == [*made]
    assert [aims.select(number, measured) for number, measured in ((5, True), (2, False), (0, True))] == [None] * 3
