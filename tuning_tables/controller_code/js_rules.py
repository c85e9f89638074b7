"""The rules of tables with lines as JavaScript, and the tables as its data: what a page asks as a controller would."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from tuning_tables.controller_code.code import programs_of
from tuning_tables.controller_code.line_code import NAMED, RULES, room_of, values_of
from tuning_tables.language.javascript import indented, js_functions, js_maker, js_values
from tuning_tables.language.records import SizedRecord
from tuning_tables.programs.estimate import ESTIMATE
from tuning_tables.programs.line_table import LINE_TABLE
from tuning_tables.table import ControllerTable


@dataclass(frozen=True)
class JsRules:
    """`text`: a script with one object, `Rule`: the programs by their names, and `table` and `estimate`, which make a
    record. `tables`: what `Rule.table` is given, JSON, a table each. `alarms`: the bits of what `Rule.alarms` answers,
    each with its meaning."""

    text: str
    tables: tuple[Mapping[str, Any], ...]
    alarms: tuple[tuple[int, str], ...]


def js_rules(tables: Sequence[ControllerTable]) -> JsRules:
    """The rules for `tables`, one or more of any classes. Category and family are 0: nothing chooses between them."""
    room = room_of(tables)
    records = {record.name: record.sized(room) for record in (LINE_TABLE, ESTIMATE)}
    held = tuple(js_values(records[LINE_TABLE.name], values_of(each.held, records[LINE_TABLE.name])) for each in tables)
    return JsRules(rule_script(records), held, tuple((bit, meaning) for _, bit, meaning in NAMED))


def rule_script(records: Mapping[str, SizedRecord]) -> str:
    """The text for tables of this room."""
    programs = programs_of(RULES, records)
    made = {"table": records[LINE_TABLE.name], "estimate": records[ESTIMATE.name]}
    makers = [js_maker(name, record) for name, record in made.items()]
    text = "\n".join([js_functions(programs, records), *makers])
    names = ", ".join([*made, *(each.name for each in programs)])
    return "\n".join(
        [
            '"use strict";',
            "// How a controller decides. Printed from the one text of the rule: do not edit.",
            "const Rule = (() => {",
            *indented(iter(text.split("\n"))),
            f"  return {{ {names} }};",
            "})();",
            "",
        ]
    )
