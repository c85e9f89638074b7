"""Cuts that met on their track and rolled on as one: what the memory of their trains keeps of it."""

from __future__ import annotations

from plant_models.frozen_arrays import Floats, Ints, frozen_arrays
from synth.hump.trains.coupling_on_track import Contact
from synth.hump.trains.train_cuts import TrainCuts
from synth.hump.trains.train_memory import TrainMemory


@frozen_arrays
class RolledOn:
    """Cuts that coupled to the one ahead on their tracks and rolled on with it: `which` (m,) of those that were added,
    on the tracks of the routes `route` of the trains `lanes`; `members` (m, k) of each body, rows of cuts from its head
    to its tail, −1 behind the last one. `contact`; then the head of the body is at `head_m` with `speed_m_s`, and comes
    to its end at `end_m` with `end_m_s`, at `still_s`.
    `marks_s` (m, j): when the head of the last cut is at its marks from there on, NaN for those not on the way."""

    which: Ints
    lanes: Ints
    route: Ints
    members: Ints
    contact: Contact
    head_m: Floats
    speed_m_s: Floats
    end_m: Floats
    end_m_s: Floats
    still_s: Floats
    marks_s: Floats


def remember(memory: TrainMemory, trains: TrainCuts, cut: int, found: RolledOn, coupled_m_s: Floats) -> None:
    """What becomes of all cuts of each body, of which cut number `cut` came last; the first one couples with
    `coupled_m_s` (m,)."""
    head = found.end_m.copy()
    for place in range(found.members.shape[1]):
        there = found.members[:, place] >= 0
        rows = found.members[there, place]
        own = found.lanes[there], rows % trains.cuts
        memory.end_m[own], memory.end_time_s[own] = head[there], found.still_s[there]
        memory.tail_m[own], memory.still_s[own] = head[there] - trains.last_axle_m[rows], found.still_s[there]
        if place == 0:
            memory.end_speed_m_s[own] = coupled_m_s
        head[there] -= trains.length_m[rows]
    at = found.lanes, cut
    memory.caught_on_track[at], memory.end_speed_m_s[at] = True, found.contact.closing_m_s
    memory.touch_s[at], memory.touch_m[at] = found.contact.time_s, found.contact.head_m
    memory.together_m_s[at] = found.speed_m_s
