"""The log: every line of it stands in its CSV, and tells the state."""

from __future__ import annotations

import csv
import io

from hypothesis import given
from hypothesis import strategies as st

from synth.hump.control.event import Event, Kind
from synth.hump.control.event_log import to_log_csv
from synth.hump.control.hump_state import Counters, HumpState, replayed

EVENTS = st.builds(
    Event,
    st.floats(0.0, 1e5),
    st.integers(0, 799),
    st.integers(0, 999),
    st.sampled_from(Kind),
    st.floats(-1e6, 1e6),
)


@given(st.lists(EVENTS, max_size=8))
def test_every_line_of_a_log_stands_in_its_csv(events: list[Event]) -> None:
    head, *rows = csv.reader(io.StringIO(to_log_csv(events), newline=""), strict=True)
    assert head == ["time_s", "element", "cut", "event", "data"]
    read = [
        Event(float(time), int(element), int(cut), Kind[name.upper().replace("-", "_")], float(data))
        for time, element, cut, name, data in rows
    ]
    assert read == events


def test_a_state_worked_out_by_hand() -> None:
    """The vectors of switch 1, retarder 401, signal 201 and of cut 5 after ten events."""
    lines = [
        (201, 5, Kind.STORED, 3), (201, 0, Kind.SIGNAL, 1), (1, 5, Kind.COMMANDED, 1), (1, 0, Kind.POSITION, -1),
        (1, 0, Kind.POSITION, 1), (1, 0, Kind.MODE, 0), (1, 5, Kind.OCCUPIED, 0), (1, 5, Kind.ENTRY_COUNTER, 3),
        (1, 5, Kind.EXIT_COUNTER, 4), (401, 5, Kind.BRAKED, 42.5),
    ]  # fmt: skip
    state = replayed(Event(float(n), *line[:2], line[2], float(line[3])) for n, line in enumerate(lines))
    assert (state.position(1), state.is_automatic(1), state.occupant(1)) == (1, False, 5)
    assert (state.counters[1], state.aspects[201], state.tracks[5]) == (Counters(3, 4), 1, 3)
    assert (state.braking[401], state.occupant(401)) == (42.5, 0)
    state.apply(Event(11.0, 1, 5, Kind.FREED))
    state.apply(Event(11.0, 1, 0, Kind.MODE, 1.0))
    state.apply(Event(11.0, 401, 0, Kind.RELEASED))
    state.apply(Event(12.0, 2, 5, Kind.MISROUTED, 2.0))
    assert (state.occupant(1), state.is_automatic(1), state.braking[401]) == (0, True, 0.0)
    assert state.misrouted == {5}
    assert [alarm.kind for alarm in state.alarms] == [Kind.MISROUTED]


def test_every_kind_changes_the_state_or_is_an_alarm_or_a_remark() -> None:
    before = HumpState(by_hand={1})
    changes = {kind for kind in Kind if replayed([Event(1.0, 1, 1, kind, 1.0)]) != HumpState()}
    before.apply(Event(1.0, 1, 1, Kind.MODE, 1.0))
    assert before == HumpState()
    assert set(Kind) - changes == {Kind.BLOCKED, Kind.MODE}
