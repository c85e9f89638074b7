"""The program of a train as a table and a sentence: for the locomotive, the uncoupler and the hump operator."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING, Final

import numpy as np

from synth.frame.exhibits import Chart, Column, Exhibit, Row, Sentence, Table
from synth.frame.printed_numbers import decimals
from synth.hump.trains.speed_program import ProgramRow, SpeedProgram

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from synth.hump.trains.train_trace import TrainTrace

HOW_TO_READ: Final = (
    "The locomotive has the hump speed when the middle of a cut is at the crest; in between it changes evenly. Time "
    "and metres count from the first cut. Exit speeds are those planned for the positions on the way of the cut; the "
    "last one aims, by what is expected of the cut."
)
PUSHED: Final = (
    "Speed at which the train is pushed when the middle of each cut is at the crest; in between it changes evenly."
)
COLUMNS: Final = (
    Column("cut", "cut"),
    Column("cars", "cars"),
    Column("axles", "axles", spare=3),
    Column("mass_t", "mass", "t", decimals(1), spare=3),
    Column("length_m", "length", "m", decimals(2), spare=3),
    Column("category", "category", words=True, spare=2),
    Column("track", "track"),
    Column("track_name", "name of the track", words=True),
    Column("hump_speed_m_s", "hump speed", "m/s", decimals(2)),
    Column("time_s", "time", "s", decimals(1)),
    Column("pushed_m", "pushed", "m", decimals(2), spare=2),
)


def program_exhibits(program: SpeedProgram, brief: bool) -> Iterator[Exhibit]:
    """Of the whole train, and of each cut; `brief`: a terminal tells of the train, too."""
    told = {
        "train": program.number + 1,
        "planned_hump_speed_m_s": program.mean_m_s,
        "planned_cars_per_hour": program.cars_per_hour,
    }
    yield Sentence(
        f"train {program.number + 1}: cuts: {len(program.rows)}; over the crest in {program.rows[-1].time_s:.0f} s at "
        f"{program.mean_m_s:.2f} m/s, {program.cars_per_hour:.0f} cars an hour",
        told,
        brief=brief,
    )
    exits = tuple(
        Column(exit_key(place), f"exit speed {place}", "m/s", decimals(2), spare=1)
        for place in range(1, program.positions + 1)
    )
    title = f"Program of train {program.number + 1}"
    yield Table("program", title, (*COLUMNS, *exits), [row_of(each) for each in program.rows])
    yield Sentence(HOW_TO_READ)


def exit_key(place: int) -> str:
    """The column of the exit speed of a position, 1 being the first behind the crest."""
    return f"exit_{place}_m_s"


def row_of(row: ProgramRow) -> Row:
    """What is to be done with one cut; positions that are not on its way have nothing."""
    exits = {exit_key(place): speed for place, speed in enumerate(row.exit_m_s, start=1)}
    return {column.key: getattr(row, column.key) for column in COLUMNS} | exits


def planned_chart(program: SpeedProgram) -> Chart:
    """The hump speeds that are planned; times since the first cut was at the crest."""
    return chart_of(program.number, lambda: [(row.time_s, row.hump_speed_m_s, row.length_m) for row in program.rows])


def pushed_chart(number: int, traced: Callable[[], TrainTrace]) -> Chart:
    """The hump speeds that the train had, which a control may have slowed down."""
    return chart_of(number, lambda: [(cut.crest_s, cut.hump_speed_m_s, cut.length_m) for cut in traced().cuts])


def chart_of(number: int, pushed: Callable[[], Sequence[tuple[float, float, float]]]) -> Chart:
    """The picture of the train `number`, from 0; `pushed`: when each cut is at the crest, how fast, and its length."""

    def drawn() -> Figure:
        from synth.hump.trains.pictures.hump_speed_program import PushedTrain, hump_speed_program

        return hump_speed_program(PushedTrain(number, *map(np.array, zip(*pushed(), strict=True))))

    return Chart("hump-speed-program", f"Hump speed program of train {number + 1}", PUSHED, drawn)
