"""Questions to a table that no book has: one in which every condition of `decide` counts, and damaged ones.

The self-test makes it of a copy of table 0, change by change, whatever the tables of the book are. So it reaches what
these do not: gates before the entrance, commands at every sample, sizes out of range, an answer that leaves the table.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from tuning_tables.controller_code.code import OddQuestion, Place, Rule, Values
from tuning_tables.language.records import SizedRecord
from tuning_tables.programs.estimate import ESTIMATE
from tuning_tables.programs.line_table import LOWER, UPPER, LineTable


def odd_questions(record: SizedRecord, first: Values, decide: Rule, observe: Rule) -> tuple[OddQuestion, ...]:
    """The questions to copies of table 0, `first`; none where the record has no room for two stages."""
    held = {name: np.array(value) for name, value in first.items()}
    asked = [*decisions(record), *observations(record)] if record.room["stages"] > 1 else []
    found = []
    for changes, given in asked:
        for name, place, number in changes:
            held[name][place] = number
        rule = decide if "stage" in given else observe
        state = [] if rule is decide else [np.zeros(len(ESTIMATE.members), np.float32)]
        table = LineTable(**{name: as_held(held.get(name)) for name in LineTable._fields})
        found.append(OddQuestion(changes, rule, given, float(rule.function(table, *state, *given.values()))))
    return tuple(found)


def as_held(value: Any) -> Any:
    """A number, or an array; 0 for a member that the record has not."""
    return 0 if value is None else value[()] if value.ndim == 0 else value


Asked = tuple[tuple[tuple[str, Place, float], ...], Mapping[str, float]]


def decisions(record: SizedRecord) -> Iterator[Asked]:
    """Two stages, stage 0 raised above 3 m/s, stage 1 lowered below 2 m/s; then a change after the other."""
    stages, powers = record.room["stages"], record.room["powers"]
    lines = [("coefficient", (0, UPPER, 0), 3.0), ("coefficient", (1, LOWER, 0), 2.0)]
    has = [(0, LOWER, 0), (0, UPPER, 1), (1, LOWER, 1), (1, UPPER, 0)]
    numbers = [("stages", 2), ("powers", 1), ("at_any_time", 0), ("entrance_stage", 1), ("path_min_m", -1.0),
               ("path_max_m", 1.0)]  # fmt: skip
    gauge = [("has_gauge", (), 0.0)] if record.room["gauge"] else []
    base = (*((name, (), float(number)) for name, number in numbers),
            *(("has_line", (stage, side), float(there)) for stage, side, there in has), *lines, *gauge)  # fmt: skip
    yield base, for_decide(0, 0.5, 4.0)
    yield (), for_decide(0, 0.5, 3.0)
    yield (), for_decide(1, 0.5, 1.0)
    yield (), for_decide(1, 0.5, 4.0)
    yield (), for_decide(0, -0.5, 4.0)
    yield (("entrance_stage", (), 0.0),), for_decide(0, -0.5, 4.0)
    yield (), for_decide(0, 0.5, 4.0)
    yield (("at_any_time", (), 1.0),), for_decide(0, 0.5, 4.0)
    # An answer that leaves the table, below and above.
    yield (("has_line", (0, LOWER), 1.0), ("coefficient", (0, LOWER, 0), 2.0)), for_decide(0, 0.5, 1.0)
    yield (("has_line", (1, UPPER), 1.0), ("coefficient", (1, UPPER, 0), 3.0)), for_decide(1, 0.5, 4.0)
    yield (("stages", (), stages + 1.0),), for_decide(0, 0.5, 4.0)
    yield (("stages", (), 2.0), ("powers", (), powers + 1.0)), for_decide(0, 0.5, 4.0)
    yield (("powers", (), 0.0),), for_decide(0, 0.5, 4.0)
    yield (("powers", (), 1.0),), for_decide(0, 0.5, 4.0)
    if stages > 2:
        # Stage 1, too, is lowered at this speed: the opposite answer ends the command.
        turned = (("coefficient", (1, LOWER, 0), 5.0), ("at_any_time", (), 0.0), ("stages", (), 3.0))
        yield turned, for_decide(0, 0.5, 4.0)
        behind = (("stages", (), 2.0), ("has_line", (2, LOWER), 1.0), ("coefficient", (2, LOWER, 0), 5.0))
        yield behind, for_decide(2, 0.5, 1.0)


def for_decide(stage: int, s_m: float, v_m_s: float) -> Mapping[str, float]:
    """The numbers that `decide` takes."""
    return {"stage": stage, "s_m": s_m, "v_m_s": v_m_s, "pressure_kpa": 0.0}


def observations(record: SizedRecord) -> Iterator[Asked]:
    """Numbers of breaks for which there is no room."""
    for breaks in (1, record.room["breaks"] + 1) if record.room["breaks"] else ():
        yield (("breaks", (), float(breaks)),), {"s_m": 0.5, "v_m_s": 4.0, "overpressure_kpa": 0.0}
