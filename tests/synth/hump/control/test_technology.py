"""Rules, routes and log of the hump control, and its page.

Where misrouted cuts go, and the laws of braking.
The next cut over a switch, by the definition: the first behind the last whose route has the switch.
The log: every line of it stands in its CSV, and tells the state.
The example of the page runs, and its tables are those of the code.
"""

from __future__ import annotations

import csv
import io
import os
import re
import subprocess
import sys
from dataclasses import replace
from math import inf, nan
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from plant_models.errors import PlantError
from synth.hump.control.brake_task import (
    LeastInterval,
    ManualBraking,
    Strobe,
    TableBraking,
    UniformBraking,
    ZoneBraking,
)
from synth.hump.control.cut_record import WIDTHS
from synth.hump.control.cut_routes import RouteStore, RouteTable
from synth.hump.control.events import ALARMS, Counters, Event, HumpState, Kind, Why, replayed, to_log_csv
from synth.hump.control.models import Misroute, PracticeRules, RejectionOrCheapest, Resistance, leader_track
from synth.hump.control.sorting_list_file import COLUMNS
from tests.plant_models.hump.random_humps import random_hump
from tests.synth.hump.control.made_trains import record

LOST = Misroute(7, 1, Why.NOT_SEPARATED, 6, (4, 5, 8), 2, 5)


def test_the_follower_goes_to_the_track_of_its_leader() -> None:
    assert leader_track(LOST) == 5
    assert leader_track(replace(LOST, leader_track=1)) == 4
    assert leader_track(replace(LOST, leader=0, leader_track=None, track=8)) == 8


def test_a_rejection_track_comes_first_and_then_the_cheapest() -> None:
    prices = {4: 30.0, 5: 20.0, 8: 20.0}

    def price(track: int, belongs: int) -> float:
        assert belongs == 2
        return prices[track]

    assert RejectionOrCheapest((9, 8), price)(LOST) == 8
    assert RejectionOrCheapest((9,), price)(LOST) == 5


@pytest.mark.parametrize("seed", range(20))
def test_lists_of_the_table_are_those_of_the_routes(seed: int) -> None:
    """By brute force: each route tells the position that its track needs of each of its switches."""
    graph = random_hump(seed)
    table = RouteTable(graph)
    needed: dict[int, dict[int, int]] = {switch.number: {} for switch in graph.switches}
    for lead in graph.leads:
        for route in graph.routes(lead).values():
            for element in route.elements:
                assert route.track in table.behind[element.number]
                if element.position is not None:
                    needed[element.number][route.track] = element.position
    assert table.needed == needed


def test_strobing() -> None:
    strobe = Strobe(0.5, 8.5)
    assert strobe.holds(0.5)
    assert strobe.holds(8.5)
    assert not any(strobe.holds(speed) for speed in (0.49, 8.51, -1.0, nan, inf, -inf))
    assert [strobe.bounded(speed) for speed in (0.1, 3.0, 99.0, inf, -inf, nan)] == [0.5, 3.0, 8.5, 8.5, 0.5, 0.5]
    with pytest.raises(PlantError, match="must be less than"):
        Strobe(2.0, 2.0)


@pytest.mark.parametrize(("speed_m_s", "zone_m"), [(3.0, 24.0), (5.0, 24.0), (2.0, 12.0), (6.0, 30.0)])
def test_uniform_braking_for_the_least_interval_takes_that_much_longer(speed_m_s: float, zone_m: float) -> None:
    """By integration in small steps of path, not by the formula."""
    task = LeastInterval(1.0).task(speed_m_s, zone_m)
    steps, time_s, v2 = 100_000, 0.0, speed_m_s**2
    for _ in range(steps):
        speed = v2**0.5
        v2 -= 2.0 * 9.81e-3 * task.n_per_kn * zone_m / steps
        time_s += 2.0 * zone_m / steps / (speed + v2**0.5)
    assert time_s == pytest.approx(zone_m / speed_m_s + 1.0, abs=1e-6)


def test_a_slow_cut_is_not_stopped() -> None:
    """The strobe holds the exit speed; a cut that is slower anyway is not braked."""
    task = LeastInterval(20.0).task(2.0, 24.0)
    assert 2.0**2 - 2.0 * 9.81e-3 * task.n_per_kn * 24.0 == pytest.approx(0.25)
    assert LeastInterval(20.0).task(0.4, 24.0) == UniformBraking(0.0)


def test_tasks_and_rules_refuse_what_cannot_be() -> None:
    with pytest.raises(PlantError, match="n_per_kn"):
        UniformBraking(-1.0)
    with pytest.raises(PlantError, match="degree"):
        ZoneBraking(0.0, 10.0, 1.1, 50.0)
    with pytest.raises(PlantError, match="braking by hand"):
        ManualBraking(lambda place_m: 1e6).braking(0.0)
    with pytest.raises(PlantError, match="longest_base_m"):
        PracticeRules(longest_base_m=1.0)
    with pytest.raises(PlantError, match="usual_base_m"):
        PracticeRules(usual_base_m=31.0)


def test_a_zone_brakes_from_its_begin_to_its_end() -> None:
    task = ZoneBraking(100.0, 10.0, 0.25, 80.0)
    assert [task.braking(place) for place in (99.9, 100.0, 109.9, 110.0)] == [None, *[Resistance(20.0)] * 2, None]
    assert (ManualBraking.way, UniformBraking.way, ZoneBraking.way, TableBraking.way) == (0, 1, 2, 3)


def has_switch(table: RouteTable, track: int, switch: int) -> bool:
    """Whether the route from the first lead has the switch."""
    return switch in table.graph.route(table.graph.leads[0], track).positions


@pytest.mark.requirement("HUMP-02")
@pytest.mark.parametrize("seed", range(30))
def test_the_next_cut_over_a_switch_is_the_first_whose_route_has_it(seed: int) -> None:
    """Also after cuts got other tracks; and a change names the switches of both routes."""
    table, random = RouteTable(random_hump(seed)), np.random.default_rng(seed)
    tracks = list(table.graph.routes(table.graph.leads[0]))
    cuts = [record(n, int(random.choice(tracks))) for n in range(1, 25)]
    store, goes = RouteStore(table, cuts), {cut.serial: cut.track for cut in cuts}
    for _ in range(15):
        for switch in table.needed:
            for behind in (-1, 0, 7, 23):
                comers = [c for n, c in enumerate(goes) if n > behind and has_switch(table, goes[c], switch)]
                assert store.next_over(switch, behind) == (comers[0] if comers else None)
        cut, track = int(random.integers(1, 25)), int(random.choice(tracks))
        both = [s for s in table.needed if has_switch(table, goes[cut], s) or has_switch(table, track, s)]
        assert sorted(store.change(cut, track)) == sorted(both)
        goes[cut] = track
        assert store.track(cut) == track


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


ROOT = Path(__file__).parents[4]
PAGE = (ROOT / "docs/explanation/hump-control.md").read_text(encoding="utf-8")


def test_the_example_runs(tmp_path: Path) -> None:
    [program] = re.findall(r"```python\n(.*?)```", PAGE, flags=re.DOTALL)
    ran = subprocess.run(
        [sys.executable, "-W", "error", "-c", program],
        cwd=tmp_path, capture_output=True, text=True, timeout=120, env={**os.environ}, check=False,
    )  # fmt: skip
    assert ran.returncode == 0, ran.stderr
    assert re.fullmatch(r"40 cuts, \d{3,} events, \d+ alarms\n", ran.stdout)


def test_the_widths_of_the_page_are_those_of_the_record() -> None:
    table = PAGE.split("| field | bits | step and range |")[1].split("\n\n")[0]
    bits = [int(cells.split("|")[2]) for cells in table.splitlines()[2:]]
    assert bits == list(WIDTHS.values())


def test_columns_and_alarms_of_counters_are_named() -> None:
    assert all(f"`{column}`" in PAGE or f"{column}," in PAGE or f"{column}`" in PAGE for column in COLUMNS)
    named = set(re.findall(r"^\| `([A-Z_]+)` \|", PAGE, flags=re.MULTILINE))
    assert named < {kind.name for kind in ALARMS}
    assert len(named) == 5
