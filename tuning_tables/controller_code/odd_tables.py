"""Questions to tables that no book has: one in which every condition of a rule counts, and damaged ones; with
lines, for aiming, and for point sensors.

Questions to a table that no book has: one in which every condition of `decide` counts, and damaged ones. The self-test
makes it of a copy of table 0, change by change, whatever the tables of the book are. So it reaches what these do not:
gates before the entrance, commands at every sample, sizes out of range, an answer that leaves the table.

Questions to an aim table that no set has: one in which every condition of `exit_speed` counts, and damaged ones. The
self-test makes it of a copy of table 0, change by change, as far as the set has room for it.

Questions to a table for point sensors that no book has: one in which every condition counts, and damaged ones. The
self-test makes it of a copy of table 0, change by change, as far as the book has room for it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from tuning_tables.controller_code.code import OddQuestion, Place, Rule, Values
from tuning_tables.language.records import SizedRecord
from tuning_tables.programs.aim_speed import AimGrid
from tuning_tables.programs.held import ESTIMATE, LOWER, UPPER, HeldPassages, LineTable
from tuning_tables.programs.tracker import LONGEST_WAIT_S, TRACKER, begin_cut


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


def odd_aims(record: SizedRecord, first: Values, exit_speed: Rule) -> Iterator[OddQuestion]:
    """The questions to copies of table 0, `first`."""
    held = {name: np.array(value) for name, value in first.items()}
    for changes, given in (*placed(record), *damaged(record)):
        for name, place, number in changes:
            held[name][place] = number
        table = AimGrid(**{name: as_held(value) for name, value in held.items()})
        yield OddQuestion(changes, exit_speed, given, float(exit_speed.function(table, *given.values())))


def placed(record: SizedRecord) -> Iterator[Asked]:
    """Two listed numbers of cars, three distances and two resistances, or as many as there is room for."""
    sizes = {name: min(most, record.room[name]) for name, most in (("listed", 2), ("distances", 3), ("resistances", 2))}
    axes = {"cars": (2.0, 4.0), "distance_m": (10.0, 20.0, 30.0), "resistance_n_per_kn": (1.0, 2.0)}
    numbers = {"is_measured": 1.0, "lowest_m_s": 0.5, "highest_m_s": 9.0, **sizes}
    base: list[tuple[str, Place, float]] = [*((name, (), float(number)) for name, number in numbers.items())]
    for (name, values), size in zip(axes.items(), sizes.values(), strict=True):
        base += [(name, (place,), value) for place, value in enumerate(values[:size])]
    nodes = list(np.ndindex(*sizes.values()))
    # Less speed for more cars; more for a longer way.
    base += [("speed_m_s", node, 3.0 - node[0] + 0.5 * node[1] - 0.25 * node[2]) for node in nodes]
    yield tuple(base), for_exit_speed(2, 10.0, 1.0)
    for cars in (1, 3, 4, 5):
        yield (), for_exit_speed(cars, 15.0, 1.5)
    for distance_m in (5.0, 20.0, 25.0, 30.0, 35.0):
        yield (), for_exit_speed(2, distance_m, 0.5)
    for resistance in (2.0, 3.0, np.nan, np.inf, -np.inf):
        yield (), for_exit_speed(2, 15.0, resistance)
    # More speed for more cars, so that the first row is the lesser.
    yield tuple(("speed_m_s", node, 2.0 + node[0]) for node in nodes), for_exit_speed(3, 15.0, 1.0)
    last = sizes["distances"] - 1
    for node in ((0, 0, 0), (0, last, 0)):
        # No speed at the node below, then at the one above, or the last; a last speed that is less than the one before.
        yield (("speed_m_s", node, -1.0),), for_exit_speed(2, 15.0 if last else 10.0, 1.0)
        yield (), for_exit_speed(2, 35.0, 1.0)
        yield (("speed_m_s", node, 1.0),), for_exit_speed(2, 35.0, 1.0)
    if last > 0:
        for speed_m_s in (-1.0, 2.5):
            yield (("speed_m_s", (0, last - 1, 0), speed_m_s),), for_exit_speed(2, 35.0, 1.0)
            yield (), for_exit_speed(2, 15.0, 1.0)
        yield from rounded_beyond()
    yield (("is_measured", (), 0.0),), for_exit_speed(2, 10.0, 1.0)


def rounded_beyond() -> Iterator[Asked]:
    """Just before a node, where the part of the way is rounded to 1: low + (high - low) is beyond high, up and down."""
    before = float(np.nextafter(np.float32(1.5), np.float32(0.0)))
    axis = (("distance_m", (0,), -3.0), ("distance_m", (1,), 1.5))
    for below, above in (("0x1.b9f87p-3", "0x1.6b4c86p+1"), ("0x1.862136p+2", "0x1.1f0c22p-1")):
        speeds = (("speed_m_s", (0, 0, 0), float.fromhex(below)), ("speed_m_s", (0, 1, 0), float.fromhex(above)))
        yield (*axis, *speeds, ("lowest_m_s", (), 0.0)), for_exit_speed(2, before, 1.0)


def damaged(record: SizedRecord) -> Iterator[Asked]:
    """Sizes for which there is no room, and bounds that no speed of the table keeps."""
    asked, measured = for_exit_speed(2, 10.0, 1.0), (("is_measured", (), 1.0), ("distance_m", (0,), 10.0))
    for name in ("listed", "distances", "resistances"):
        for number in (0.0, record.room[name] + 1.0):
            yield ((name, (), number), *measured), asked
        yield ((name, (), 1.0), *measured), asked
        # Beyond a distance before which there is none.
        yield (), for_exit_speed(2, 35.0, 1.0)
    yield (("highest_m_s", (), 0.0),), asked
    yield (("highest_m_s", (), 9.0), ("lowest_m_s", (), 9.0)), asked


def for_exit_speed(cars: int, free_distance_m: float, resistance_n_per_kn: float) -> Mapping[str, float]:
    """The numbers that `exit_speed` takes."""
    return {"cars": cars, "free_distance_m": free_distance_m, "resistance_n_per_kn": resistance_n_per_kn}


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
