"""Tables with switching lines as code for controllers."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from tuning_tables.active_table import ActiveTable, active
from tuning_tables.category_number import category_names, comment_text
from tuning_tables.controller_code.code import (
    Commanded,
    ControllerCode,
    HeldTable,
    Questions,
    Rule,
    Values,
    made_by,
    padded,
)
from tuning_tables.controller_code.odd_tables import odd_questions
from tuning_tables.golden_choices import golden_choices
from tuning_tables.golden_tracks import golden_tracks
from tuning_tables.golden_vectors import GoldenVectors
from tuning_tables.language.records import SizedRecord, record_of
from tuning_tables.programs.choose import Tables, blend, choose
from tuning_tables.programs.decide import HEAVIER_ALARM, LIGHTER_ALARM, LOST_ALARM, SENSOR_ALARM, alarms, decide
from tuning_tables.programs.held import ESTIMATE, LINE_TABLE, LineTable
from tuning_tables.programs.motion_filter import begin_cut
from tuning_tables.programs.observe import observe
from tuning_tables.self_test_size import SelfTestSize
from tuning_tables.table import ControllerTable
from tuning_tables.table_book import TableBook

BEGIN: Final = Rule(begin_cut, "begin")
OBSERVE: Final = Rule(observe, "observe", "-1.0f")
DECIDE: Final = Rule(decide, "decide", "stage")
ALARMS: Final = Rule(alarms, "alarms", "0")
RULES: Final = (BEGIN, OBSERVE, DECIDE, ALARMS)
"""What a regulator asks while a cut is in the position."""

CHOOSE: Final = Rule(choose, "choose")
BLEND: Final = Rule(blend, "blend")

HEAD: Final = (
    "The first axle is at `s_m`, 0 at the entrance of the first retarder, negative before it. The interlock is "
    "the caller's: the regulator may take over a cut, `approach_m` before the entrance, only when the cut ahead "
    "has left the position, its last axle out of the last retarder, and then only when the stage commanded is at "
    "most `entrance_stage`.",
    "When to ask. A table whose `at_any_time` is 1 is asked at every sample, also while the pressure still "
    "changes, with the stage commanded last. Every other table is asked only when the pressure of the stage is "
    "reached.",
    "The gauge. The lines of a table whose `has_gauge` is 1 depend on the pressure, because a cut is braked by "
    "the pressure that is there, and not by the stage that was commanded. Where the gauge fails, hand over what "
    "is no number (NaN): then the lines at the pressure of the stage count. Other tables do not look at the "
    "pressure; hand over 0.",
    "A reading of 0 of a table without estimator is believed: the cut stands, so the brake is released. If the "
    "radar shows 0 where it has lost its target, hand over -1 in place of that 0. The state counts in `unseen` for "
    "how many samples no reading was believed; the supervision compares it with a limit of its own, and acts.",
    "Alarms. 1: the speed is known too badly, and `observe` answers less than the estimate; 2: readings of the "
    "radar are doubted, or one repeats itself; 4, 8: the brake works more, or less, on this cut than on any of "
    "its category.",
)

NAMED: Final = (
    ("LOST", LOST_ALARM, "alarm: the speed is known too badly"),
    ("SENSOR_DOUBTED", SENSOR_ALARM, "alarm: readings are doubted, or one repeats itself"),
    ("LIGHTER", LIGHTER_ALARM, "alarm: the brake works more on this cut than on any of its category"),
    ("HEAVIER", HEAVIER_ALARM, "alarm: it works less"),
)


def line_code(book: TableBook, self_test: SelfTestSize) -> ControllerCode:
    """The export of a book. Raises `InvalidTable` for a category without number."""
    room = room_of(book.tables)
    record = LINE_TABLE.sized(room)
    held = tuple(HeldTable(table.id, held_values(book, number, record)) for number, table in enumerate(book.tables))
    return ControllerCode(
        stem="table",
        title="Controller tables of a car retarder, and the rules by which they decide.",
        head=HEAD,
        origin=tuple(origin_lines(book)),
        categories=category_names(book.exported_numbers()),
        records={LINE_TABLE.name: "table", ESTIMATE.name: "estimate"},
        declared=(LINE_TABLE, ESTIMATE, record_of(Tables)),
        room=room,
        tables=held,
        rules=RULES,
        chooses=(CHOOSE, BLEND) if book.has_pairs else (CHOOSE,),
        questions=(decisions(book, self_test), estimates(book)),
        commands=tuple(commands(book, record)),
        named=NAMED,
        odd=odd_questions(record, held[0].values, DECIDE, OBSERVE),
    )


def room_of(tables: Sequence[ControllerTable]) -> Mapping[str, int]:
    """The least room that every one of the tables fits into."""
    held = [table.held for table in tables]
    return {
        "tables": len(tables),
        "stages": max(each.stages for each in held),
        "powers": max(each.powers for each in held),
        "breaks": max(each.breaks for each in held),
        "gauge": max(each.has_gauge for each in held),
    }


def held_values(book: TableBook, number: int, record: SizedRecord, lines: ActiveTable | None = None) -> Values:
    """The numbers of table `number` of the book, or of `lines` made from it; raises as `book.number_of`."""
    source = book.tables[number]
    held = (lines or active(source)).held._replace(
        category=book.number_of(source.cut.category),
        axles=len(source.cut.axle_offsets_m),
        family_no=book.families[number],
        mass_t=np.float32(source.cut.mass_t),
        sample_period_s=np.float32(source.clock.sample_period_s),
        computing_delay_s=np.float32(source.clock.computing_delay_s),
    )
    return values_of(held, record)


def values_of(held: LineTable, record: SizedRecord) -> Values:
    """The numbers of a table in the room of a record."""
    if held.has_gauge == 0:  # a difference of pressures that nobody looks at must not keep two tables apart
        held = held._replace(highest_kpa=np.float32(0.0), pressure_kpa=np.zeros_like(held.pressure_kpa))
    return {name: sized(getattr(held, name), record.shape(name)) for name in record.members}


def sized(value: Any, shape: tuple[int, ...]) -> Any:
    """A number as it is; an array with zeros where it is no number, and up to the shape."""
    if not shape:
        return value
    array = np.where(np.isnan(value), np.float32(0.0), value) if value.dtype == np.float32 else value.astype(np.int32)
    return padded(array, shape)


def decisions(book: TableBook, self_test: SelfTestSize) -> Questions:
    """The golden vectors of all tables."""
    rows = [decision_rows(number, self_test.vectors(table)) for number, table in enumerate(book.tables)]
    return Questions("decisions", (DECIDE,), np.concatenate(rows))


def decision_rows(number: int, vectors: GoldenVectors) -> npt.NDArray[np.void]:
    """The golden vectors of a table as rows."""
    dtype = [("table", "i4"), ("stage", "i4"), ("s_m", "f4"), ("v_m_s", "f4"), ("pressure_kpa", "f4"), ("wanted", "i4")]
    rows = np.zeros(len(vectors), dtype=dtype)
    columns = (vectors.stage, vectors.s_m, vectors.v_m_s, vectors.pressure_kpa, vectors.answer)
    for name, column in zip(("stage", "s_m", "v_m_s", "pressure_kpa", "wanted"), columns, strict=True):
        rows[name] = column
    rows["table"] = number
    return rows


def estimates(book: TableBook) -> Questions:
    """The golden tracks of all estimators."""
    dtype = [("table", "i4"), ("begins", "i4"), ("s_m", "f4"), ("v_m_s", "f4"), ("overpressure_kpa", "f4"),
             ("observed", "f4"), ("raised", "i4"), ("unseen", "f4")]  # fmt: skip
    found = []
    for track in golden_tracks(book):
        rows = np.zeros(len(track), dtype=dtype)
        rows["table"], rows["begins"][0] = track.number, 1
        for name, column in zip(
            ("s_m", "v_m_s", "overpressure_kpa", "observed", "unseen", "raised"), track.samples, strict=True
        ):
            rows[name] = column
        found.append(rows)
    return Questions("estimates", (OBSERVE, ALARMS), np.concatenate(found))


def commands(book: TableBook, record: SizedRecord) -> Iterator[Commanded]:
    """The golden choices."""
    for choice in golden_choices(book):
        chosen = None
        if choice.table is not None:
            chosen = held_values(book, choice.numbers[0], record, choice.table)
        yield Commanded(choice.category, choice.axles, choice.commanded_m_s, int(choice.status), chosen)


def origin_lines(book: TableBook) -> Iterator[str]:
    """What the book is for and where it comes from, in ASCII."""
    yield f"retarder   {comment_text(book.tables[0].retarder.name)}"
    yield f"clock      {book.tables[0].clock}"
    yield from made_by(book.tables)
