"""The rule as JavaScript gives the golden answers in every bit."""

from __future__ import annotations

import json
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from tests.controller_code.sample_book import approaching_book, estimating_book, park_book, sample_book, surface_book
from tests.in_javascript import ENGINES, Engine, needs_javascript, packed, told
from tests.tuning_tables.passages.made_tables import table_of
from tuning_tables.controller_code.code import ControllerCode, Questions
from tuning_tables.controller_code.js_rules import LINES, PASSAGES, JsObject, js_rules, rule_script
from tuning_tables.controller_code.line_code import line_code
from tuning_tables.controller_code.passage_code import passage_code
from tuning_tables.language.javascript import js_values
from tuning_tables.passages.passage_book import PassageBook
from tuning_tables.passages.sensor_layout import DecidesOn
from tuning_tables.programs.decide import decide
from tuning_tables.self_test_size import FULL
from tuning_tables.table_book import TableBook

ASKING = """
const column = ({ kind, text }) => kind === "f" ? floats(text) : wholes(text);
const tables = given.tables.map((values) => ASKED.table(values)), state = given.state;
const faults = [];
let asked = 0;
for (const { columns: packed, rules, expected, before } of given.questions) {
  const columns = Object.fromEntries(Object.entries(packed).map(([name, each]) => [name, column(each)]));
  const known = ASKED[state]();
  for (let row = 0; row < columns.table.length; row++) {
    const table = tables[columns.table[row]], answers = {};
    for (const member of before) known[member] = columns[`before_${member}`][row];
    if (columns.begins?.[row]) ASKED.begin_cut(known);
    for (const { name, takes, answer } of rules) {
      const of = { table, [state]: known };
      answers[answer] = ASKED[name](...takes.map((each) => of[each] ?? columns[each][row]));
    }
    for (const name of expected) {
      asked += 1;
      const found = name in answers ? answers[name] : known[name];
      if (!Object.is(found, columns[name][row])) {
        faults.push([row, name, found, columns[name][row]]);
      }
    }
  }
}
tell({ asked, faults: faults.slice(0, 5) });
"""


def asked_of(questions: Questions, code: ControllerCode) -> dict[str, Any]:
    """Questions as JSON that loses no bit."""
    rows, programs = questions.rows, {rule: code.program(rule) for rule in questions.rules}
    return {
        "columns": {
            name: {"kind": rows[name].dtype.kind, "text": packed(rows[name])} for name in rows.dtype.names or ()
        },
        "rules": [
            {
                "name": program.name,
                "takes": [each.name for each in program.parameters],
                "answer": program.answers[0].name,
            }
            for program in programs.values()
        ],
        "expected": list(questions.expected),
        "before": list(questions.members_before),
    }


def golden(script: JsObject, code: ControllerCode, tables: list[Any], engine: Engine | None = None) -> dict[str, Any]:
    """How many answers were compared, and the first that differ."""
    given = {
        "tables": tables,
        "questions": [asked_of(each, code) for each in code.questions],
        "state": list(script.made)[1],
    }
    asking = ASKING.replace("ASKED", script.name)
    found: dict[str, Any] = told(rule_script(script, code.sized) + asking, given, engine)
    return found


def held(code: ControllerCode) -> list[Any]:
    """The tables as a page is given them."""
    return [js_values(code.table, each.values) for each in code.tables]


@pytest.mark.requirement("CODE-03")
@needs_javascript
@pytest.mark.parametrize("book_of", [sample_book, estimating_book, approaching_book, surface_book, park_book])
def test_golden_questions_are_answered_alike_in_every_bit(book_of: Callable[[], TableBook]) -> None:
    code = line_code(book_of(), FULL)
    found = golden(LINES, code, held(code))
    assert found["asked"] > 2_000
    assert found["faults"] == []


@needs_javascript
@pytest.mark.parametrize("decides_on", DecidesOn)
def test_golden_pulses_are_answered_alike_in_every_bit(decides_on: DecidesOn) -> None:
    code = passage_code(PassageBook((table_of(decides_on),)), FULL)
    found = golden(PASSAGES, code, held(code))
    assert found["asked"] > 2_000
    assert found["faults"] == []


@pytest.mark.parametrize("engine", ENGINES)
def test_every_engine_answers_alike(engine: Engine) -> None:
    code = line_code(park_book(), FULL)
    found = golden(LINES, code, held(code), engine)
    assert found["asked"] > 2_000
    assert found["faults"] == []


@needs_javascript
def test_a_changed_line_is_noticed() -> None:
    code = line_code(park_book(), FULL)
    tables = held(code)
    first = tables[0]["coefficient"]
    place = next(place for place, value in enumerate(first) if value != 0.0)
    first[place] = float(np.nextafter(np.float32(first[place]), np.float32(np.inf)))
    assert golden(LINES, code, tables)["faults"] != []


def test_a_double_rounding_is_written_at_every_operation() -> None:
    """Without `Math.fround` the sums would be doubles: the text has one for each operation of REAL numbers."""
    rules = js_rules(estimating_book().tables)
    assert decide.__name__ in rules.text
    lines = [
        line for line in rules.text.splitlines() if " = " in line and not line.lstrip().startswith(("//", "const"))
    ]
    horner = next(line for line in lines if "line = rounded" in line)
    assert horner.count("rounded(") == 2


def test_tables_keep_every_float32_number() -> None:
    table = sample_book().tables[-1]
    (values,) = js_rules([table]).tables
    again = np.array(json.loads(json.dumps(values))["coefficient"], dtype=np.float32)
    used = np.where(np.isnan(table.coefficients), np.float32(0.0), table.coefficients)
    assert again.tobytes() == used.tobytes()
