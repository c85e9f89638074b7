"""The control is far faster than the hump, and its work grows no faster than cuts and axles do."""

from __future__ import annotations

import time

import numpy as np

from synth.hump.control.cut_record import CutRecord
from synth.hump.control.route_table import RouteTable
from tests.synth.hump.control.cut_motion import MovingCut
from tests.synth.hump.control.full_humps import full_hump
from tests.synth.hump.control.made_trains import axle_places, humped, record

LEAST_TIMES = 2000.0


def dense_train(table: RouteTable, cuts: int) -> tuple[list[CutRecord], list[MovingCut]]:
    """Cuts of two cars that follow each other as densely as 2.7 m/s over the crest gives, 5 m/s behind it."""
    random = np.random.default_rng(1)
    train = [record(n, int(random.choice(table.graph.tracks)), 2) for n in range(1, cuts + 1)]
    axles, places = axle_places(2), np.array([0.0, 1000.0])
    starts = [cut.serial * cut.length_m / 2.7 for cut in train]
    return train, [
        MovingCut(cut.serial, axles.copy(), np.array([start, start + 200.0]), places.copy())
        for cut, start in zip(train, starts, strict=True)
    ]


def test_it_is_2000_times_faster_than_the_hump() -> None:
    """32 tracks, 40 cuts, ticks of 0.1 s; the track of the tests is in the time."""
    table = RouteTable(full_hump(5))
    train, objects = dense_train(table, 40)
    best = float("inf")
    for _ in range(3):
        begin = time.process_time()
        control, _ = humped(table, train, objects)
        best = min(best, time.process_time() - begin)
    assert len(control.state.arrived) == 40
    assert control.events[-1].time_s / best > LEAST_TIMES


def test_the_log_grows_with_the_cuts_and_the_switches_of_a_route() -> None:
    """The log, which is what the control does, grows with the cuts; tracks add a switch a doubling."""

    def lines(levels: int, cuts: int) -> int:
        table = RouteTable(full_hump(levels))
        return len(humped(table, *dense_train(table, cuts))[0].events)

    assert lines(5, 80) <= 4.1 * lines(5, 20)
    assert lines(6, 40) <= 1.3 * lines(5, 40)
