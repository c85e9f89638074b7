"""The rules of tables as JavaScript, and the tables as its data: what a page asks as a controller would."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

from tuning_tables.controller_code import line_code, passage_code
from tuning_tables.controller_code.code import Rule, programs_of
from tuning_tables.language.javascript import indented, js_functions, js_maker, js_values
from tuning_tables.language.records import Record, SizedRecord
from tuning_tables.passages.passage_table import PassageTable
from tuning_tables.passages.rule import held_by
from tuning_tables.programs.held import ESTIMATE, HELD_PASSAGES, LINE_TABLE
from tuning_tables.programs.tracker import TRACKER
from tuning_tables.table import ControllerTable


@dataclass(frozen=True)
class JsObject:
    """What a script holds: the object `name` with the programs of `rules`, and a maker of each of the records by its
    name."""

    name: str
    rules: tuple[Rule, ...]
    made: Mapping[str, Record]


LINES: Final = JsObject("Rule", line_code.RULES, {"table": LINE_TABLE, "estimate": ESTIMATE})
PASSAGES: Final = JsObject("PassageRule", passage_code.RULES, {"table": HELD_PASSAGES, "tracker": TRACKER})


@dataclass(frozen=True)
class JsRules:
    """`text`: a script with one object, `Rule` or `PassageRule`. `tables`: what its `table` is given, JSON, a table
    each. `room`: the lengths of the axes of their arrays, which are flat. `alarms`: the bits of what `Rule.alarms`
    answers, each with its meaning."""

    text: str
    tables: tuple[Mapping[str, Any], ...]
    room: Mapping[str, int]
    alarms: tuple[tuple[int, str], ...] = ()


def js_rules(tables: Sequence[ControllerTable]) -> JsRules:
    """The rules for `tables`, one or more of any classes. Category and family are 0: nothing chooses between them."""
    room = line_code.room_of(tables)
    records, record = sized(LINES, room), LINE_TABLE.sized(room)
    held = tuple(js_values(record, line_code.values_of(each.held, record)) for each in tables)
    alarms = tuple((bit, meaning) for _, bit, meaning in line_code.NAMED)
    return JsRules(rule_script(LINES, records), held, room, alarms)


def js_passage_rules(tables: Sequence[PassageTable]) -> JsRules:
    """The same for tables for point sensors."""
    room = passage_code.room_of(tables)
    records, record = sized(PASSAGES, room), HELD_PASSAGES.sized(room)
    held = tuple(js_values(record, passage_code.values_of(held_by(each), record)) for each in tables)
    return JsRules(rule_script(PASSAGES, records), held, room)


def sized(script: JsObject, room: Mapping[str, int]) -> Mapping[str, SizedRecord]:
    """The records of a script with this room, by their names."""
    return {record.name: record.sized(room) for record in script.made.values()}


def rule_script(script: JsObject, records: Mapping[str, SizedRecord]) -> str:
    """The text for tables of this room."""
    programs = programs_of(script.rules, records)
    makers = [js_maker(name, records[record.name]) for name, record in script.made.items()]
    text = "\n".join([js_functions(programs, records), *makers])
    names = ", ".join([*script.made, *(each.name for each in programs)])
    return "\n".join(
        [
            '"use strict";',
            "// How a controller decides. Printed from the one text of the rule: do not edit.",
            f"const {script.name} = (() => {{",
            *indented(iter(text.split("\n"))),
            f"  return {{ {names} }};",
            "})();",
            "",
        ]
    )
