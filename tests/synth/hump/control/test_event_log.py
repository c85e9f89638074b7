"""The log: only added to, the same from both kinds of file, and damaged files told in a sentence."""

from __future__ import annotations

import csv
import io
from collections.abc import Callable
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from synth.frame.input_error import InputError
from synth.hump.control.event import ALARMS, Event, Kind
from synth.hump.control.event_file import read_events, write_events
from synth.hump.control.event_log import EventLog, to_log_csv
from synth.hump.control.hump_state import CHANGES, Counters, HumpState, replayed
from tests.synth.hump.control.judged_trains import Scene, random_humping
from tests.tuning_tables.forged_book import reseal

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


def test_a_log_reads_back_from_hdf5_and_equal_logs_give_equal_bytes(tmp_path: Path) -> None:
    events = random_humping(6, Scene(faults=3)).control.log.events
    write_events(events, tmp_path / "a.h5")
    write_events(events, tmp_path / "b.h5")
    assert read_events(tmp_path / "a.h5") == events
    assert (tmp_path / "a.h5").read_bytes() == (tmp_path / "b.h5").read_bytes()
    with h5py.File(tmp_path / "a.h5") as file:
        assert file["time_s"].attrs["units"] == "s"
        assert np.array_equal(file["element"][()], [event.element for event in events])
        assert "13 braked" in file.attrs["kinds"]
    write_events((), tmp_path / "none.h5")
    assert read_events(tmp_path / "none.h5") == ()


def claims(shape: tuple[int, ...], **storage: Any) -> Callable[[h5py.File], None]:
    def edit(file: h5py.File) -> None:
        file.create_dataset("data", shape=shape, dtype="<f8", **storage)

    return edit


def lies_elsewhere(file: h5py.File) -> None:
    file["data"] = h5py.ExternalLink("other.h5", "/data")


@pytest.mark.parametrize(
    "edit",
    [
        lies_elsewhere,
        claims((2**26,), chunks=(2**20,), fillvalue=1.0),
        claims((2**40,)),
        claims((2**26,), chunks=(2**20,), compression="gzip"),
        claims((2, 2)),
    ],
)
def test_a_column_that_does_not_lie_in_the_file_is_refused_before_it_takes_memory(
    tmp_path: Path, edit: Callable[[h5py.File], None]
) -> None:
    path = tmp_path / "log.h5"
    write_events(random_humping(6, Scene()).control.log.events, path)
    with h5py.File(path, "r+") as file:
        del file["data"]
        edit(file)
    reseal(path)
    with pytest.raises(InputError, match=r"log\.h5: data is "):
        read_events(path)


def test_lines_of_a_log_stay_as_they_are() -> None:
    log = EventLog()
    log.append(Event(1.0, 1, 1, Kind.OCCUPIED))
    before = log.events
    log.append(Event(2.0, 1, 1, Kind.FREED))
    assert before == (Event(1.0, 1, 1, Kind.OCCUPIED),)
    assert len(log) == 2


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
    assert set(Kind) - set(CHANGES) - ALARMS == {Kind.BLOCKED}
    assert HumpState() == replayed([Event(1.0, 1, 1, Kind.BLOCKED, 2.0)])
