"""Tables for point sensors as code for controllers."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Final

import numpy as np
import numpy.typing as npt

from tuning_tables.book_classes import exported_number
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
from tuning_tables.controller_code.odd_tables import odd_passages
from tuning_tables.language.records import SizedRecord, record_of
from tuning_tables.passages.golden_passages import golden_selections
from tuning_tables.passages.passage_book import PassageBook
from tuning_tables.passages.passage_table import PassageTable
from tuning_tables.passages.rule import held_by
from tuning_tables.programs.at_pulse import at_pulse, wanted_stage
from tuning_tables.programs.choose import Tables, choose
from tuning_tables.programs.held import HELD_PASSAGES, HeldPassages
from tuning_tables.programs.tracker import TRACKER, begin_cut, believed_passage
from tuning_tables.self_test_size import SelfTestSize

BEGIN_CUT: Final = Rule(begin_cut, "begin_cut")
AT_PULSE: Final = Rule(at_pulse, "at_pulse", "stage")
BELIEVED: Final = Rule(believed_passage, "believed_passage", "-1")
WANTED: Final = Rule(wanted_stage, "wanted_stage", "stage")
RULES: Final = (BEGIN_CUT, AT_PULSE, BELIEVED, WANTED)
"""What a regulator asks while a cut is in the position."""

HEAD: Final = (
    "A pair of pulses: an axle has passed the two coils of a sensor. Every pair of every axle over every sensor "
    "counts, in the order of the second pulses, also during a change of stage and behind the exit. A pair of which one "
    "pulse is missing has 0 s over the base.",
    "The interlock is the caller's: the regulator may take over a cut only when the cut ahead has left the position, "
    "its last axle out of the last retarder, and then only when the stage commanded is at most the entrance stage of "
    "the table. One tracker knows one cut.",
    "What a pair is taken for, and the stage wanted at a passage, are parts of the step, which it asks itself. The "
    "largest number of either sign as switching speed: never raise, or lower, so far.",
)


def passage_code(book: PassageBook, self_test: SelfTestSize) -> ControllerCode:
    """The export of a book. Raises `InvalidTable` for a category without number."""
    room = room_of(book.tables)
    record = HELD_PASSAGES.sized(room)
    held = tuple(HeldTable(table.id, held_values(table, record)) for table in book.tables)
    golden = [self_test.passages(table) for table in book.tables]
    return ControllerCode(
        stem="passages",
        title="Controller tables of a car retarder with point sensors, and what a regulator does at a pair of pulses.",
        head=HEAD,
        origin=tuple(origin_lines(book)),
        categories=category_names({table.cut.category: exported_number(table) for table in book.tables}),
        records={HELD_PASSAGES.name: "passage_table", TRACKER.name: "tracker"},
        declared=(HELD_PASSAGES, TRACKER, record_of(Tables)),
        room=room,
        tables=held,
        rules=RULES,
        chooses=(Rule(choose, "choose"),),
        questions=(
            Questions("stages", (WANTED,), numbered([each.stages for each in golden])),
            Questions("pairs", (BELIEVED,), numbered([each.pairs for each in golden])),
            Questions("pulses", (AT_PULSE,), numbered([each.pulses for each in golden])),
        ),
        commands=tuple(commands(book, record)),
        odd=tuple(odd_passages(record, held[0].values, (BELIEVED, WANTED, AT_PULSE))),
    )


def room_of(tables: Sequence[PassageTable]) -> Mapping[str, int]:
    """The least room that every one of the tables fits into."""
    stages = max(len(table.pressure_kpa) for table in tables)
    return {
        "tables": len(tables),
        "heard": max(len(table.heard_path_m) for table in tables),
        "passages": max(len(table.passages) for table in tables),
        "stages": stages,
        "thresholds": stages - 1,
    }


def held_values(table: PassageTable, record: SizedRecord) -> Values:
    """The numbers of a table; raises as `exported_number`."""
    return values_of(held_by(table)._replace(category=exported_number(table)), record)


def values_of(passages: HeldPassages, record: SizedRecord) -> Values:
    """The numbers of a table in the room of a record."""
    held = passages._asdict()
    return {
        name: padded(held[name], record.shape(name)) if member.axes else held[name]
        for name, member in record.members.items()
    }


def numbered(rows: Sequence[npt.NDArray[np.void]]) -> npt.NDArray[np.void]:
    """Golden rows of all tables, each with the number of its table."""
    together = np.concatenate(rows)
    found = np.zeros(len(together), [("table", "i4"), *together.dtype.descr])
    found["table"] = np.repeat(np.arange(len(rows)), [len(each) for each in rows])
    for name in together.dtype.names or ():
        found[name] = together[name]
    return found


def commands(book: PassageBook, record: SizedRecord) -> Iterator[Commanded]:
    """The golden choices."""
    for each in golden_selections(book):
        chosen = None if each.table is None else held_values(book.tables[each.table], record)
        yield Commanded(each.category, each.axles, each.commanded_m_s, int(each.status), chosen)


def origin_lines(book: PassageBook) -> Iterator[str]:
    """For which retarder the tables are, where its sensors stand, and what made them, in ASCII."""
    first = book.tables[0]
    places = ", ".join(f"{place:g}" for place in first.sensors.path_m)
    yield f"retarder   {comment_text(first.retarder.name)}"
    yield f"sensors    0 to {len(first.sensors.path_m) - 1}, middle of their bases at {places} m from the entrance"
    yield f"clock      {first.sensors.clock}"
    yield from made_by(book.tables)
