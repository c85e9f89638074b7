"""The rules of the published model and of S0, one by one, on the small hump.

Signal 201, switch 1 (points at 40 m, section 34 to 52 m), left track 1, right retarder 401 (section 98 to 128 m) and
switch 2 (points at 160 m, section 154 to 172 m) before tracks 2 and 3. A throw takes 0.8 s.
"""

from __future__ import annotations

import pytest

from plant_models.errors import PlantError
from synth.hump.control.brake_task import ManualBraking, TableBraking, UniformBraking, ZoneBraking
from synth.hump.control.cut_record import Mark, SortingList
from synth.hump.control.cut_routes import RouteStore
from synth.hump.control.events import Aspect, Block, Kind, Why
from synth.hump.control.hump_control import HumpControl, Operation
from synth.hump.control.models import PUBLISHED_MODEL, ExitSpeed, Misroute, Resistance
from tests.synth.hump.control.made_trains import TABLE, axle_places, close_pair, commands, humped, record, rolling, told
from tests.synth.hump.control.reference_sections import moving_cut
from tests.synth.hump.control.reference_track import ReferenceTrack


@pytest.mark.requirement("HUMP-02")
def test_a_switch_is_set_for_the_next_cut_over_it_as_soon_as_it_is_free() -> None:
    """Cuts to tracks 1, 3, 1, 2: switch 2 is set for cut 2 at once, and for cut 4 when cut 2 has left it."""
    cuts = [record(1, 1), record(2, 3), record(3, 1), record(4, 2)]
    control, track = humped(TABLE, cuts, [rolling(n, 12.0 * n) for n in range(1, 5)])
    assert commands(control) == [(1, 1, 0), (2, 2, 1), (1, 2, 1), (1, 3, 0), (1, 4, 1), (2, 4, 0)]
    freed = [event for event in told(control, Kind.FREED, Kind.COMMANDED) if event.element == 2]
    assert [(event.kind, event.cut) for event in freed] == [
        (Kind.COMMANDED, 2), (Kind.FREED, 2), (Kind.COMMANDED, 4), (Kind.FREED, 4),
    ]  # fmt: skip
    assert freed[1].time_s == freed[2].time_s
    # Cut 2 passes the exit joint at 172 m with its last axle, 10.5 m behind the first, at 24 + 182.5/5 s.
    assert freed[1].time_s == pytest.approx(24.0 + 182.5 / 5.0, abs=0.1)
    assert control.state.arrived == {1: [1], 2: [3], 3: [1], 4: [2]}
    assert not control.state.alarms
    assert track.truth.ends == {0: 601, 1: 603, 2: 601, 3: 602}


def test_cuts_that_are_not_to_be_humped_are_left_out() -> None:
    cuts = [record(1, 1), record(2, 2, marks=frozenset({Mark.DO_NOT_HUMP})), record(3, 3)]
    control, _ = humped(TABLE, cuts, [rolling(1, 0.0), rolling(3, 12.0)])
    assert [cut.serial for cut in control.store.cuts] == [1, 3]
    assert control.state.arrived == {1: [1], 3: [3]}


def test_the_signal_shows_hump_until_the_last_cut_is_on_the_first_section() -> None:
    control, track = humped(TABLE, [record(1, 1), record(2, 2)], [rolling(1, 0.0), rolling(2, 12.0)])
    first, second = told(control, Kind.SIGNAL)
    assert (first.time_s, first.value) == (0.0, Aspect.HUMP)
    # The first section begins at 34 m.
    assert second.time_s == pytest.approx(12.0 + 34.0 / 5.0, abs=0.1)
    assert second.value == Aspect.STOP
    assert track.aspects == {201: Aspect.STOP}


@pytest.mark.requirement("HUMP-03")
def test_a_cut_on_an_occupied_switch_follows_its_leader_and_the_switch_stays() -> None:
    control = close_pair(Operation(rules=PUBLISHED_MODEL))
    assert next((e.element, e.cut, e.value) for e in told(control, Kind.NOT_SEPARATED)) == (1, 2, 1)
    assert (1, 2, 0) not in commands(control)
    assert [(e.element, e.cut, e.value) for e in told(control, Kind.RE_ROUTED)] == [(1, 2, 2)]
    assert [(e.element, e.cut, e.value) for e in told(control, Kind.MISROUTED)] == [(1, 2, Why.NOT_SEPARATED)]
    assert control.state.arrived == {1: [2], 2: [2]}


@pytest.mark.requirement("HUMP-03")
def test_a_follower_is_braked_on_the_next_retarder_for_the_least_interval() -> None:
    """Uniform braking from 2.5 m/s over 24 m, 2 s longer: v₂ = 48/(9.6 + 2) − 2.5 m/s, w = (v² − v₂²)/(2·g·24)."""
    control = close_pair()
    task = control.retarders.task(401, 2)
    assert isinstance(task, UniformBraking)
    assert task.n_per_kn == pytest.approx((2.5**2 - (48.0 / 11.6 - 2.5) ** 2) * 1e3 / (2.0 * 9.81 * 24.0))
    braked = told(control, Kind.BRAKED, Kind.RELEASED)
    assert [(e.element, e.cut, e.value) for e in braked if e.kind is Kind.BRAKED] == [(401, 2, task.n_per_kn)]


class LastInReach:
    """A trainer's own rule."""

    def __init__(self) -> None:
        self.asked: list[Misroute] = []

    def __call__(self, misroute: Misroute) -> int:
        """The last track that can be reached."""
        self.asked.append(misroute)
        return misroute.reachable[-1]


def test_another_technology_may_decide_where_a_follower_goes() -> None:
    technology = LastInReach()
    control = close_pair(Operation(technology))
    assert technology.asked[0] == Misroute(2, 1, Why.NOT_SEPARATED, 1, (2, 3), 1, 2)
    assert [(e.element, e.cut, e.value) for e in told(control, Kind.RE_ROUTED)][:1] == [(1, 2, 3)]


def test_a_technology_that_names_a_track_out_of_reach_is_refused() -> None:
    with pytest.raises(PlantError, match="track 1 for cut 2 cannot be reached from element 1; it must be one of 2, 3"):
        close_pair(Operation(lambda misroute: 1))


def test_a_switch_by_hand_stays_until_it_is_thrown_by_hand() -> None:
    track = ReferenceTrack(TABLE, [rolling(1, 0.0), rolling(2, 30.0)])
    control = HumpControl(TABLE, SortingList((record(1, 1), record(2, 2))), track)
    control.switches.set_automatic(1, False)
    for tick in range(200):
        control.tick(0.1 * tick)
    blocked = [(e.cut, e.value) for e in told(control, Kind.BLOCKED) if e.element == 1]
    assert blocked == [(1, Block.BY_HAND), (2, Block.BY_HAND)]
    assert control.switches.throw_by_hand(1, 1)
    for tick in range(200, 900):
        control.tick(0.1 * tick)
        if control.state.occupant(1):
            assert not control.switches.throw_by_hand(1, 0)
    control.switches.set_automatic(1, True)
    assert not control.switches.throw_by_hand(1, 1)
    assert control.state.arrived == {1: [1], 2: [2]}


@pytest.mark.parametrize(
    ("task", "told_n"),
    [
        (UniformBraking(30.0), Resistance(30.0)),
        (ZoneBraking(100.0, 24.0, 0.5, 80.0), Resistance(40.0)),
        (TableBraking(2.5), ExitSpeed(2.5)),
        (ManualBraking(lambda place_m: 12.0 if place_m > 110.0 else None), Resistance(12.0)),
    ],
)
def test_a_retarder_brakes_as_its_task_says(task: UniformBraking, told_n: Resistance | ExitSpeed) -> None:
    control, track = humped(TABLE, [record(1, 2)], [rolling(1, 0.0)], (), Operation(tasks={(401, 1): task}))
    braked = told(control, Kind.BRAKED, Kind.RELEASED)
    assert [e.value for e in braked if e.kind is Kind.BRAKED] == [told_n[0]]
    assert track.braking == {401: None}
    # On the section from 98 m with the first axle to 128 m with the last, 10.5 m behind.
    begins, ends = {0: (110.0, 138.5), 1: (98.0, 138.5), 2: (100.0, 124.0), 3: (98.0, 138.5)}[task.way]
    at = [e.time_s for e in braked if e.kind is Kind.BRAKED or e.time_s > 10.0]
    assert at == [pytest.approx(begins / 5.0, abs=0.11), pytest.approx(ends / 5.0, abs=0.11)]


@pytest.mark.requirement("HUMP-05")
@pytest.mark.parametrize(("computed", "commanded"), [(9.5, 8.5), (0.1, 0.5), (float("inf"), 8.5), (3.0, 3.0)])
def test_an_exit_speed_that_cannot_be_is_strobed(computed: float, commanded: float) -> None:
    tasks = {(401, 1): TableBraking(computed)}
    control, track = humped(TABLE, [record(1, 2)], [rolling(1, 0.0)], (), Operation(tasks=tasks))
    assert [e.value for e in told(control, Kind.BRAKED)] == [commanded]
    strobed = [(e.element, e.cut, e.value) for e in told(control, Kind.STROBED)]
    assert strobed == [(401, 1, computed)] * (computed != commanded)
    assert track.braking == {401: None}


def test_two_cuts_on_a_retarder_are_braked_as_the_first_one_is() -> None:
    tasks = {(401, 1): UniformBraking(10.0), (401, 2): UniformBraking(20.0)}
    control, _ = humped(
        TABLE, [record(1, 2), record(2, 2)], [rolling(1, 0.0), rolling(2, 6.5)], (),
        Operation(rules=PUBLISHED_MODEL, tasks=tasks),
    )  # fmt: skip
    braked = [(e.cut, e.value) for e in told(control, Kind.BRAKED)]
    assert braked == [(1, 10.0), (2, 20.0)]
    second = next(e for e in told(control, Kind.BRAKED) if e.cut == 2)
    # Cut 2 is on it from 6.5 + 98/5 s on, but cut 1 rules until its last axle has left, at 138.5/5 s.
    assert second.time_s == pytest.approx(138.5 / 5.0, abs=0.1)
    assert second.time_s > 6.5 + 98.0 / 5.0 + 1.0


def test_a_cut_that_nobody_found_is_recorded_at_the_end() -> None:
    control, _ = humped(TABLE, [record(1, 2)], [moving_cut(1, axle_places(1).tolist(), 0.0, [(130.0, 5.0)])])
    assert [(e.element, e.cut, e.value) for e in told(control, Kind.MISROUTED)] == [(401, 1, Why.NOT_SEEN)]
    assert [(e.element, e.value) for e in told(control, Kind.COUNTERS_LEFT)] == [(401, 2.0)]


def test_a_track_that_no_route_leads_to_is_refused() -> None:
    for cut, words in ((record(1, 9), "track 9"), (record(1, 1, lead=1), "lead is 1; the hump has 1 lead, from 0 on")):
        with pytest.raises(PlantError, match=words):
            HumpControl(TABLE, SortingList((cut,)), ReferenceTrack(TABLE, []))
    with pytest.raises(PlantError, match="same number"):
        RouteStore(TABLE, [record(1, 1), record(1, 1)])
