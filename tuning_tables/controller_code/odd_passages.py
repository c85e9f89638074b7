"""Questions to a table for point sensors that no book has: one in which every condition counts, and damaged ones.

The self-test makes it of a copy of table 0, change by change, as far as the book has room for it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from tuning_tables.controller_code.code import OddQuestion, Place, Rule, Values
from tuning_tables.controller_code.odd_tables import as_held
from tuning_tables.language.records import SizedRecord
from tuning_tables.programs.passage_table import HeldPassages
from tuning_tables.programs.tracker import LONGEST_WAIT_S, TRACKER, begin_cut

AskedOfRule = tuple[Rule, Mapping[str, float], tuple[tuple[str, Place, float], ...]]
"""A rule, what it is asked with, and what is changed before."""


def odd_passages(record: SizedRecord, first: Values, rules: tuple[Rule, Rule, Rule]) -> Iterator[OddQuestion]:
    """The questions to copies of table 0, `first`; `rules`: believed_passage, wanted_stage and at_pulse."""
    held = {name: np.array(value) for name, value in first.items()}
    for rule, given, changes in asked(record, HeldPassages(**first), *rules):
        for name, place, number in changes:
            held[name][place] = number
        table = HeldPassages(**{name: as_held(value) for name, value in held.items()})
        state = [] if "passage" in given else [np.zeros(len(TRACKER.members), np.float32)]
        for each in state:
            begin_cut(each)
        yield OddQuestion(changes, rule, given, float(rule.function(table, *state, *given.values())))


def asked(
    record: SizedRecord, held: HeldPassages, believed: Rule, wanted: Rule, at_pulse: Rule
) -> Iterator[AskedOfRule]:
    """Table 0 as it is, then with numbers for which there is no room, then with a gate before the entrance."""
    room, sensor = record.room, int(held.sensor[0])
    speed_m_s = float(np.ceil(8.0 * held.least_m_s) / 8.0)
    pair = {"sensor": sensor, "since_s": 1.0, "reading_m_s": speed_m_s}
    reading = {"passage": 0, "stage": 0, "reading_m_s": 100.0}
    pulse = {"sensor": sensor, "since_s": 1.0, "over_base_s": 0.0, "stage": 0, "transient_ended": 1}
    for number in (held.heard, 0, room["heard"] + 1, held.heard):
        yield believed, pair, (("heard", (), float(number)),)
    for over_base_s in (2.0 * float(LONGEST_WAIT_S), float(held.base_m) / speed_m_s):
        yield at_pulse, {**pulse, "over_base_s": over_base_s}, ()
    for number in (held.passages, room["passages"] + 1, held.passages):
        yield wanted, reading, (("passages", (), float(number)),)
    raised = (("stages", (), 2.0), ("switching_m_s", (0, 0, 0), 3.0))
    yield wanted, reading, raised
    for before, stage in ((0, 0), (1, 0), (1, 1)):
        yield wanted, reading, (("before_entrance", (), float(before)), ("entrance_stage", (), float(stage)))
    yield wanted, reading, (("stages", (), room["stages"] + 1.0),)
