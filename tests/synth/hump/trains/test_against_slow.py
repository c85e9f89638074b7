"""Random small trains by the layered simulator and by the slow one: event by event, and when and where cuts pass."""

from __future__ import annotations

import numpy as np
import pytest

from plant_models.library.hump_entry import load_hump
from plant_models.rolling.resistance_law import HumpNormLaw, ResistanceLaw, Tb10062Law
from plant_models.rolling.roll_track import Weather
from synth.hump.rolling.hump_routes import Mark
from synth.hump.rolling.train_memory import TrainMemory
from synth.hump.trains.train_trace import body_of
from tests.effort import every, sized
from tests.plant_models.rolling.populations import MIX, population
from tests.synth.hump.trains.agreement import agreement, judged
from tests.synth.hump.trains.fast_and_slow import HARD, ORDINARY, BothTrains, Hardness, both_trains
from tests.synth.hump.trains.slow_humping import STEP_S, SlowHumping, humped_slowly
from tests.synth.hump.trains.slow_train import Kind

TRACKS = (1, 2, 3, 9, 17)
TRAINS, CUTS = sized(10, 15), 6
NEAR_S = 0.03
NEAR_M, NEAR_M_S = 0.2, 0.01
PUSHED = sized(3, 12)
"""Trains with cuts that push one another, which are compared."""

"""A decision that is nearer to its limit may be another with the steps of the layered simulator."""


@pytest.mark.parametrize(
    ("law", "weather", "seed"),
    every(2, [(HumpNormLaw(), Weather(), 0), (Tb10062Law(), Weather(temperature_c=20.0, snow_n_per_kn=0.1), 1)]),
    ids=["hump-norm", "tb-10062"],
)
def test_both_simulators_tell_the_same_of_small_trains(law: ResistanceLaw, weather: Weather, seed: int) -> None:
    """Same events; times at joints to 30 ms, places where cuts stand to 0.15 m, coupling speeds to 10 mm/s."""
    both = both_trains(load_hump("large").graph, population(MIX, law, weather), TRACKS, seed, TRAINS, CUTS)
    memory = both.fast()
    kinds: set[Kind] = set()
    compared = 0
    for train in range(TRAINS):
        run = humped_slowly(both.graph, both.slow(train))
        np.testing.assert_allclose([cut.crest_s for cut in both.slow(train).cuts], memory.crest_s[train], atol=1e-9)
        if run.closest_s < NEAR_S:
            continue
        found = agreement(both, memory, run, train)
        assert not found.differing, train
        assert not found.tracks, train
        assert found.times_s < 0.03, train
        assert found.heads_m < 0.15, train
        assert found.couplings_m_s < 0.01, train
        kinds |= {event.kind for event in run.events}
        compared += len(judged(run))
    assert kinds >= {Kind.NOT_SEPARATED, Kind.MISROUTED, Kind.CONTACT, Kind.TRACK_CONTACT, Kind.COUPLED, Kind.GAP}
    assert compared > 0.7 * TRAINS * CUTS


def many_trains(seed: int, hardness: Hardness) -> tuple[BothTrains, TrainMemory]:
    """Trains among which to look for what is rare, and what the layered simulator says of them."""
    people = population(MIX, HumpNormLaw(), Weather())
    both = both_trains(load_hump("large").graph, people, TRACKS, seed, 3000, CUTS, hardness)
    return both, both.fast()


@pytest.mark.long
def test_both_simulators_see_the_same_cuts_foul() -> None:
    """Cuts that stop short of a fouling point are rare, so the layered simulator looks for them first."""
    both, memory = many_trains(5, HARD)
    fouling = np.flatnonzero(memory.foul.any(axis=(1, 2))).tolist()
    assert len(fouling) >= 3
    for train in fouling[:3]:
        run = humped_slowly(both.graph, both.slow(train))
        assert run.of(Kind.FOULED), train
        assert run.of(Kind.STOPPED), train
        assert not agreement(both, memory, run, train).differing, train


def compared_trains(both: BothTrains, memory: TrainMemory, trains: list[int]) -> int:
    """How many of `trains` could be compared; they must agree."""
    compared = 0
    for train in trains:
        run = humped_slowly(both.graph, both.slow(train))
        if run.closest_s < NEAR_S:
            continue
        found = agreement(both, memory, run, train)
        assert not found.differing, train
        assert found.times_s < NEAR_S, train
        assert found.heads_m < NEAR_M, train
        assert found.couplings_m_s < NEAR_M_S, train
        compared += 1
    return compared


@pytest.mark.long
def test_both_simulators_tell_the_same_of_cuts_behind_cuts_in_contact() -> None:
    """A third cut meets the tail of one that follows the tail of the first since it met it at the end of a section."""
    both, memory = many_trains(6, HARD)
    at = np.minimum(memory.contact_at, both.routes.elements - 1)
    came = np.take_along_axis(memory.time_s[..., Mark.FIRST_IN], at[:, :, None], axis=2)[..., 0]
    at_end = (memory.behind >= 0) & (memory.since_s > came)
    meets = memory.unseparated[:, 1:].any(axis=2) & at_end[:, :-1]
    assert compared_trains(both, memory, np.flatnonzero(meets.any(axis=1)).tolist()[:8]) >= 4


@pytest.mark.long
def test_a_position_stays_as_it_is_through_a_cut_in_contact() -> None:
    """A cut comes on the position where one rolls in contact with another: the mode of the first of them rules."""
    both, memory = many_trains(7, HARD)
    column = both.routes.retarder[memory.route]
    shared = np.take_along_axis(memory.unseparated, column, axis=2)
    passes, led = np.isfinite(memory.begin_s), memory.behind >= 0
    same = memory.route[:, 1:] == memory.route[:, :-1]
    between = (passes & shared)[:, 1:] & (led[:, :-1, None] & ~passes[:, :-1]) & same[:, :, None]
    found = np.argwhere(between).tolist()
    assert len(found) >= 8
    for train, ahead, position in found[:8]:
        slow, cut = SlowHumping(both.graph, both.slow(train)), ahead + 1
        slow.run(STEP_S)
        element = both.routes.numbers[both.routes.vertex[memory.route[train, cut], column[train, cut, position]]]
        assert memory.command_m_s[train, cut, position] == slow.commands[cut, element]


def test_cuts_that_touch_on_their_track_roll_on_as_one() -> None:
    """Both roll on as one: they stand, and couple, alike; some bodies of two, and of three."""
    both, memory = many_trains(8, ORDINARY)
    bodies = [(lane, body_of(memory, lane, cut)) for lane, cut in np.argwhere(memory.caught_on_track).tolist()]
    trains = [lane for lane, body in bodies if len(body) == 2][:PUSHED] + [
        lane for lane, body in bodies if len(body) > 2
    ]
    assert compared_trains(both, memory, trains[: PUSHED + 2]) >= PUSHED - 1
