"""From the columns of a book back to its tables for point sensors, row by row."""

from __future__ import annotations

from tuning_tables.approach import Approach
from tuning_tables.book_layout import Columns
from tuning_tables.errors import InvalidTable
from tuning_tables.passages.passage_row import PassageRow
from tuning_tables.passages.passage_table import PassageTable
from tuning_tables.passages.plausible_motion import PlausibleMotion
from tuning_tables.passages.sensor_layout import DecidesOn, SensorLayout
from tuning_tables.row_parts import (
    Row,
    cut_of,
    generator_of,
    pair_of,
    predicted_of,
    present,
    retarder_of,
    text_of,
    validated_of,
)


def passage_tables_of(columns: Columns) -> tuple[PassageTable, ...]:
    """The tables in the arrays of a book, which must have the names, types and numbers of axes of its layout.

    Raises `InvalidTable` for values that make no table, `UnicodeDecodeError` for text that is no UTF-8.
    """
    return tuple(_table({name: column[row] for name, column in columns.items()}) for row in range(len(columns["id"])))


def _table(row: Row) -> PassageTable:
    """The table in one row of every column."""
    stages = int(row["n_stages"])
    return PassageTable(
        id=text_of(row["id"]),
        created=text_of(row["created"]),
        generator=generator_of(row),
        retarder=retarder_of(row),
        cut=cut_of(row),
        target_speed_m_s=float(row["target_speed_m_s"]),
        pressure_kpa=tuple(row["pressure_kpa"][: max(stages, 0)].tolist()),
        sensors=_sensors(row),
        approach=Approach(float(row["approach_length_m"]), int(row["approach_entrance_stage"])),
        initial_stage=int(row["approach_initial_stage"]),
        passages=_passages(row, stages),
        plausible=_plausible(row),
        valid_v_m_s=pair_of(row["valid_v_m_s"]),
        predicted=predicted_of(row),
        validated=validated_of(row),
    )


def _sensors(row: Row) -> SensorLayout:
    word, known = text_of(row["sensor_decides_on"]), [each.value for each in DecidesOn]
    if word not in known:
        raise InvalidTable(f"sensor_decides_on is {word!r:.60}, but it must be one of {', '.join(known)}.")
    return SensorLayout(
        present(row["sensor_path_m"]),
        float(row["sensor_base_m"]),
        float(row["sensor_base_tolerance"]),
        float(row["sensor_timer_noise_s"]),
        float(row["sensor_timer_resolution_s"]),
        float(row["sensor_computing_delay_s"]),
        float(row["sensor_scan_period_s"]),
        DecidesOn(word),
    )


def _passages(row: Row, stages: int) -> tuple[PassageRow, ...]:
    passages = int(row["n_passages"])
    most_passages, most_stages, most_speeds = row["switching_m_s"].shape
    if not (1 <= passages <= most_passages and 2 <= stages <= min(most_stages, most_speeds + 1)):
        raise InvalidTable(f"n_passages {passages} or n_stages {stages} exceeds the switching speeds of the book.")
    speeds = row["switching_m_s"][:passages, :stages, : stages - 1].astype(float).tolist()
    return tuple(
        PassageRow(
            int(row["passage_sensor"][index]),
            int(row["passage_axle"][index]),
            float(row["passage_path_m"][index]),
            tuple(map(tuple, speeds[index])),
        )
        for index in range(passages)
    )


def _plausible(row: Row) -> PlausibleMotion:
    return PlausibleMotion(
        pair_of(row["plausible_speed_m_s"]),
        float(row["plausible_acceleration_m_s2"]),
        float(row["plausible_deceleration_m_s2"]),
        float(row["plausible_speed_tolerance"]),
        float(row["plausible_path_tolerance_m"]),
    )
