"""Aim tables as code for controllers: the choice is a rule that looks at all tables, and answers the number of one."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Final

import numpy as np
import numpy.typing as npt

from tuning_tables.aim.aim_tables import AimTable, AimTables
from tuning_tables.aim.golden_aims import GoldenAims, golden_selections
from tuning_tables.category_number import category_names, comment_text
from tuning_tables.controller_code.code import ControllerCode, HeldTable, Questions, Rule, Values, made_by, padded
from tuning_tables.controller_code.odd_tables import odd_aims
from tuning_tables.language.records import SizedRecord, record_of
from tuning_tables.programs.aim_speed import AIM_GRID, Tables, exit_speed, select
from tuning_tables.self_test_size import SelfTestSize

SELECT: Final = Rule(select, "select")
EXIT_SPEED: Final = Rule(exit_speed, "exit_speed", "-1.0f")

HEAD: Final = (
    "Each table tells for a park position the exit speed at which a cut couples as fast as is allowed. There is one "
    "table at most for a category and a kind of knowledge: by measured resistance, or by the category alone.",
)


def aim_code(aims: AimTables, self_test: SelfTestSize) -> ControllerCode:
    """The export of a set; its names begin with AIM, which `ExportPrefix.of_kind` sees to."""
    room = room_of(aims)
    record = AIM_GRID.sized(room)
    held = tuple(HeldTable(table.id, held_values(table, record)) for table in aims.tables)
    return ControllerCode(
        stem="table",
        title="Aim tables of a park position, and the rule by which they are asked.",
        head=HEAD,
        origin=tuple(origin_lines(aims)),
        categories=category_names(aims.exported_numbers()),
        records={AIM_GRID.name: "table"},
        declared=(AIM_GRID, record_of(Tables)),
        room=room,
        tables=held,
        rules=(SELECT, EXIT_SPEED),
        chooses=(),
        questions=(
            Questions("aims", (EXIT_SPEED,), aim_rows([self_test.aims(table) for table in aims.tables])),
            Questions("selections", (SELECT,), selection_rows(aims)),
        ),
        commands=(),
        odd=tuple(odd_aims(record, held[0].values, EXIT_SPEED)),
        empty="listed",
    )


def room_of(aims: AimTables) -> Mapping[str, int]:
    """The least room that every table of the set fits into."""
    shapes = [table.held.speed_m_s.shape for table in aims.tables]
    most = {
        name: max(shape[axis] for shape in shapes) for axis, name in enumerate(("listed", "distances", "resistances"))
    }
    return {**most, "tables": len(aims.tables)}


def held_values(table: AimTable, record: SizedRecord) -> Values:
    """The numbers of a table, arrays with zeros up to the room of the export."""
    held = table.held._asdict()
    sized = {name: padded(held[name], record.shape(name)) for name in record.members if record.shape(name)}
    return {**held, **sized}


def aim_rows(golden: list[GoldenAims]) -> npt.NDArray[np.void]:
    """The golden aims of all tables as rows."""
    dtype = [
        ("table", "i4"),
        ("cars", "i4"),
        ("free_distance_m", "f4"),
        ("resistance_n_per_kn", "f4"),
        ("exit_speed_m_s", "f4"),
    ]
    rows = np.zeros(sum(map(len, golden)), dtype=dtype)
    rows["table"] = np.repeat(np.arange(len(golden)), [len(each) for each in golden])
    for name in ("cars", "free_distance_m", "resistance_n_per_kn", "exit_speed_m_s"):
        rows[name] = np.concatenate([getattr(each, name) for each in golden])
    return rows


def selection_rows(aims: AimTables) -> npt.NDArray[np.void]:
    """The golden selections as rows."""
    return np.array(list(golden_selections(aims)), dtype=[("category", "i4"), ("measured", "?"), ("table_no", "i4")])


def origin_lines(aims: AimTables) -> Iterator[str]:
    """What the tables are for and where they come from, in ASCII."""
    position = aims.tables[0].position
    yield f"position   {comment_text(position.name)}, left at {position.exit_at_m:g} m from the crest"
    yield from made_by(aims.tables)
