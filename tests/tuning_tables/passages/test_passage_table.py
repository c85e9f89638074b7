"""A table for point sensors is complete and consistent, or it does not exist."""

from __future__ import annotations

import math
import pickle
from collections.abc import Callable
from dataclasses import FrozenInstanceError, replace
from typing import Any

import numpy as np
import pytest

from plant_models import Cut, PointSensors, every_axle, first_axle
from plant_models.point_sensors import deciding_passages
from tests.tuning_tables.passages.made_tables import ROWS, table_of
from tuning_tables import Approach, CutId, InvalidTable, Predicted, Validated
from tuning_tables.passages.passage_row import PassageRow
from tuning_tables.passages.passage_table import PassageTable
from tuning_tables.passages.sensor_layout import DecidesOn, SensorLayout

NAN, INF = math.nan, math.inf


def test_arrays_hold_the_passages_and_are_read_only() -> None:
    table = table_of()
    assert table.switching_m_s.shape == (4, 3, 2)
    assert table.switching_m_s[2].tolist() == [list(row) for row in ROWS]
    assert table.path_m.tolist() == [-4.0, 3.0, 9.5, 30.0]
    assert table.sensor_of.tolist() == [0, 1, 2, 3]
    assert table.before_entrance == 1
    assert table.entrance_stage == 1
    assert table.limits.tolist() == [np.float32(x) for x in (0.3, 15.0, 0.5, 3.0, 0.05, 0.3)]
    for name in ("switching_m_s", "path_m", "sensor_of", "heard_path_m", "heard_sensor", "heard_passage", "limits"):
        with pytest.raises(ValueError, match="read-only"):
            getattr(table, name)[...] = 1


def test_the_tracker_hears_every_axle_over_every_sensor() -> None:
    table = table_of()
    assert len(table.heard_path_m) == 20
    assert np.all(np.diff(table.heard_path_m) >= 0.0)
    decided = table.heard_passage >= 0
    assert table.heard_passage[decided].tolist() == [0, 1, 2, 3]
    assert table.heard_path_m[decided].tolist() == table.path_m.tolist()
    assert table.heard_sensor[decided].tolist() == table.sensor_of.tolist()
    every = table_of(DecidesOn.EVERY_AXLE)
    assert every.heard_passage.tolist() == [*range(len(every.passages)), *[-1] * (20 - len(every.passages))]


@pytest.mark.parametrize(
    ("decides_on", "axles"), [(DecidesOn.FIRST_AXLE, first_axle), (DecidesOn.EVERY_AXLE, every_axle)]
)
def test_the_passages_are_those_of_the_plant(decides_on: DecidesOn, axles: Callable[[Cut], tuple[int, ...]]) -> None:
    table = table_of(decides_on, (-4.0, 0.15, 2.0, 9.0, 30.0, 45.0))
    cut = Cut("Л", 22.0, table.cut.axle_offsets_m, 4)
    wanted = deciding_passages(PointSensors(table.sensors.path_m, axles=axles), cut, table.retarder.exit_m)
    assert [(row.sensor, row.axle, row.path_m) for row in table.passages] == [
        (each.sensor, each.axle, each.path_m) for each in wanted
    ]


def test_a_table_is_a_value() -> None:
    table, twin = table_of(), table_of()
    assert twin == table
    assert hash(twin) == hash(table)
    assert twin != replace(table, id="other")
    copy = pickle.loads(pickle.dumps(table))
    assert copy == table
    assert np.array_equal(copy.switching_m_s, table.switching_m_s)
    with pytest.raises(FrozenInstanceError):
        table.id = "other"  # type: ignore[misc]  # the very thing that is refused
    assert replace(table, validated=None).with_validated(Validated(1, 0.1, (0.0, 0.2))).validated is not None


@pytest.mark.parametrize(
    ("change", "key"),
    [
        ({"pressure_kpa": (0.0,)}, "pressure_kpa"),
        ({"pressure_kpa": (0.0, 150.0)}, "passages"),
        ({"pressure_kpa": (0.0, 300.0, 150.0)}, r"pressure_kpa\[2\]"),
        ({"pressure_kpa": (0.0, NAN, 300.0)}, r"pressure_kpa\[1\]"),
        ({"pressure_kpa": [0.0, 150.0, 300.0]}, "pressure_kpa"),
        ({"approach": Approach(4.5, 1)}, "approach.length_m"),
        ({"approach": Approach(4.0, 3)}, "approach.entrance_stage"),
        ({"approach": None}, "approach"),
        ({"initial_stage": 2}, "initial_stage"),
        ({"initial_stage": True}, "initial_stage"),
        ({"passages": ()}, "passages"),
        ({"plausible": None}, "plausible"),
        ({"valid_v_m_s": (2.0, 2.0)}, "valid.v_m_s"),
        ({"valid_v_m_s": (-1.0, 2.0)}, "valid.v_m_s"),
        ({"predicted": Predicted(0.1, 0.0, 0.0, 1.0, passes=10)}, "predicted.passes"),
        ({"cut": CutId("Л", 22.0, (0.0, 2e4))}, "cut.axle_offsets_m"),
        ({"cut": CutId("Л", 22.0, tuple(float(x) for x in range(820)))}, "cut.axle_offsets_m"),
    ],
)
def test_values_that_make_no_table_are_refused(change: dict[str, Any], key: str) -> None:
    with pytest.raises(InvalidTable, match=f"^{key}"):
        replace(table_of(), **change)


@pytest.mark.parametrize(
    "change",
    [
        lambda rows: rows[1:],
        lambda rows: rows[:-1],
        lambda rows: (rows[1], rows[0], *rows[2:]),
        lambda rows: (replace(rows[0], sensor=1), *rows[1:]),
        lambda rows: (replace(rows[0], axle=1), *rows[1:]),
        lambda rows: (*rows[:-1], replace(rows[-1], path_m=rows[-1].path_m + 2e-6)),
        lambda rows: (*rows[:-1], replace(rows[-1], switching_m_s=((1.0,), (1.0,)))),
    ],
)
def test_the_passages_must_be_those_of_sensors_and_axles(
    change: Callable[[tuple[PassageRow, ...]], tuple[PassageRow, ...]],
) -> None:
    table = table_of(DecidesOn.EVERY_AXLE)
    moved = (*table.passages[:-1], replace(table.passages[-1], path_m=table.passages[-1].path_m + 5e-7))
    assert replace(table, passages=moved).heard_path_m.tolist() == table.heard_path_m.tolist()
    with pytest.raises(InvalidTable, match="passages"):
        replace(table, passages=change(table.passages))


def test_passages_of_one_path_stand_in_the_order_of_the_sensors() -> None:
    table = table_of(DecidesOn.EVERY_AXLE, (-4.0, 0.0, 2.0), (0.0, 2.0))
    met = [(row.sensor, row.axle, row.path_m) for row in table.passages]
    assert met == [(0, 0, -4.0), (0, 1, -2.0), (1, 0, 0.0), (1, 1, 2.0), (2, 0, 2.0), (2, 1, 4.0)]
    assert table.before_entrance == 2
    swapped = (*table.passages[:3], table.passages[4], table.passages[3], table.passages[5])
    with pytest.raises(InvalidTable, match=r"passages\[3\]"):
        replace(table, passages=swapped)


@pytest.mark.parametrize(
    "rows",
    [
        ((6.0, 5.0), *ROWS[1:]),
        (ROWS[0], (4.5, 4.5), ROWS[2]),
        (ROWS[0], (5.0, 4.5), ROWS[2]),
        ((-INF, 5.0), *ROWS[1:]),
        (*ROWS[:2], (4.0, INF)),
        (*ROWS[:2], (5.0, -INF)),
        ((NAN, 5.0), *ROWS[1:]),
        ((-0.0, 5.0), *ROWS[1:]),
        ((-1.0, 5.0), *ROWS[1:]),
        ((4.1, 5.0), *ROWS[1:]),
        ((1e39, INF), *ROWS[1:]),
        ((5.0,), *ROWS[1:]),
        ([5.0, INF], *ROWS[1:]),
        ((np.float32(5.0), INF), *ROWS[1:]),
        ROWS[:2],
    ],
)
def test_rows_that_cannot_be_decided_by_are_refused(rows: tuple[tuple[float, ...], ...]) -> None:
    with pytest.raises(InvalidTable, match="switching_m_s"):
        PassageTable(**fields_of(table_of(), rows))


def fields_of(table: PassageTable, rows: tuple[tuple[float, ...], ...]) -> dict[str, Any]:
    """The fields of `table` with these rows at every passage."""
    named = {name: getattr(table, name) for name, each in table.__dataclass_fields__.items() if each.init}
    return {**named, "passages": tuple(replace(row, switching_m_s=rows) for row in table.passages)}


@pytest.mark.parametrize(
    ("change", "key"),
    [
        ({"path_m": ()}, "path_m"),
        ({"path_m": (3.0, 2.0)}, "path_m"),
        ({"path_m": (-4.0, -3.8)}, "path_m"),
        ({"path_m": (-4.0, 500.5)}, "path_m"),
        ({"path_m": tuple(float(x) for x in range(33))}, "path_m"),
        ({"path_m": (-4.0, -3.6), "base_m": 0.4}, "path_m"),
        ({"decides_on": "first_axle"}, "decides_on"),
    ],
)
def test_sensors_that_cannot_be_are_refused(change: dict[str, Any], key: str) -> None:
    sensors = table_of().sensors
    assert isinstance(sensors, SensorLayout)
    with pytest.raises(InvalidTable, match=f"sensors.{key}"):
        replace(sensors, **change)


@pytest.mark.parametrize(
    ("change", "key"),
    [
        ({"speed_m_s": (2.0, 1.0)}, "speed_m_s"),
    ],
)
def test_limits_that_mean_nothing_are_refused(change: dict[str, Any], key: str) -> None:
    with pytest.raises(InvalidTable, match=f"plausible.{key}"):
        replace(table_of().plausible, **change)


def test_sensors_may_stand_as_near_as_the_plant_allows_though_differences_round() -> None:
    places = (-1.2, -0.9, 0.9, 1.2)  # 1.2 − 0.9 is 0.29999…
    assert replace(table_of().sensors, path_m=places).path_m == PointSensors(places).path_m
