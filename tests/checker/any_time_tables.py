"""Sound tables that decide at any time, made by hand: with and without a gauge, an estimator and an approach."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

from tuning_tables import (
    Approach,
    ControllerTable,
    CutId,
    Decisions,
    Estimator,
    Generator,
    Predicted,
    RegulatorClock,
    RetarderId,
    Stage,
    ValidRange,
    to_csv,
    to_json,
    write_book,
)
from tuning_tables.stage import round_coefficients

SLOPES = ((None, -0.003), (-0.004, -0.003), (-0.002, None))
"""Lower and upper, m/s per kPa; those of stage 1 come nearer to each other where the pressure is low."""


def line(*coefficients: float) -> tuple[float, ...]:
    return round_coefficients(coefficients)


def sound_table(name: str) -> ControllerTable:
    """At any time, without a gauge; the class may use all three stages, and stage 1 has lines 0.4 m/s apart."""
    return ControllerTable(
        id=name,
        created="2026-11-23T00:00:00Z",
        generator=Generator("retarder-synth", "0.1.0", "0123456789abcdef" * 4),
        retarder=RetarderId("one", ((0.0, 10.0),), 20.5, 15.0),
        cut=CutId("medium", 22.0, (0.0, 1.85, 8.65, 10.5)),
        target_speed_m_s=4.0,
        clock=RegulatorClock(sample_period_s=0.1, computing_delay_s=0.02),
        degree=1,
        stages=(
            Stage(0, 0.0, None, line(4.3, -0.01)),
            Stage(1, 150.0, line(4.0, -0.01), line(4.4, -0.01)),
            Stage(2, 300.0, line(4.1, -0.01), None),
        ),
        valid=ValidRange((0.0, 20.5), (0.3, 9.0)),
        predicted=Predicted(0.05, -0.001, 0.01, 4.1),
        decisions=Decisions.AT_ANY_TIME,
    )


def sloped(table: ControllerTable, slopes: tuple[tuple[float | None, float | None], ...] = SLOPES) -> ControllerTable:
    """The table with a gauge."""
    rounded = [[None if each is None else line(each)[0] for each in pair] for pair in slopes]
    stages = tuple(
        replace(stage, lower_slope_m_s_per_kpa=lower, upper_slope_m_s_per_kpa=upper)
        for stage, (lower, upper) in zip(table.stages, rounded, strict=True)
    )
    return replace(table, id=f"{table.id}-gauge", stages=stages)


def with_stage_out_of_use(table: ControllerTable, slope: float = -0.00390625) -> ControllerTable:
    """The table with a gauge, and a stage above those that the class may use, which is left at once."""
    stage = Stage(len(table.stages), 450.0, line(15.0, 0.0), None, slope)
    return replace(table, id=f"{table.id}-more", stages=(*table.stages, stage))


def estimated(table: ControllerTable) -> ControllerTable:
    """The table for an estimated speed."""
    breaks, drive, brake = (-4.0, 0.0, 10.0, 20.5), (0.0, 0.03, 0.1, 0.2), (0.0, 0.0, 0.02, 0.03)
    estimator = Estimator(0.05, 0.15, 0.006, 0.1, 2.0, 7, 20, 0.2, 0.5, 50.0, breaks, drive, brake)
    predicted = replace(table.predicted, passes=1000)
    return replace(table, id=f"{table.id}-estimated", estimator=estimator, predicted=predicted)


def approached(table: ControllerTable) -> ControllerTable:
    """The table with 4 m of approach."""
    valid = replace(table.valid, s_m=(-4.0, table.valid.s_m[1]))
    return replace(table, id=f"{table.id}-approached", valid=valid, approach=Approach(4.0, 1))


def every_kind() -> Iterator[ControllerTable]:
    """All eight, of one class: their targets differ, and those beside one another differ in what they need."""
    plain = sound_table("plain")
    for table in (plain, with_stage_out_of_use(sloped(plain))):
        for each in (table, estimated(table)):
            yield from (each, approached(each))


def leave(tables: list[ControllerTable], folder: Path) -> Path:
    """JSON, CSV and book of the tables in `folder`, as a tune leaves them, but without summary and controller code."""
    (folder / "tables").mkdir()
    for table in tables:
        (folder / "tables" / f"{table.id}.json").write_bytes(to_json(table))
        (folder / "tables" / f"{table.id}.csv").write_bytes(to_csv(table))
    write_book(tables, folder / "book.h5")
    return folder
