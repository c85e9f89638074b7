"""The tracker on sequences of true and of false pulse pairs: what it believes, and what a fault costs."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from synth.kernels.compiled_rules import compiled_rule
from tests.effort import every, sized
from tests.tuning_tables.passages.made_tables import Pulse, TruePass, rolled, table_of, tracking, true_passes
from tuning_tables.passages.rule import held_by
from tuning_tables.programs.held import NONE
from tuning_tables.programs.tracker import begin_cut, believed_passage

COMPILED: Any = compiled_rule(believed_passage)
often = settings(derandomize=True, max_examples=sized(50, 200), deadline=None)


def believed(run: TruePass, pulses: Sequence[Pulse]) -> list[int]:
    """What the tracker takes each of `pulses` for, from the beginning of a cut on."""
    state, last, found = np.zeros(6, np.float32), 0.0, []
    begin_cut(state)
    table = tracking(run.path_m, run.sensor)
    for time, sensor, speed in pulses:
        found.append(int(COMPILED(table, state, sensor, time - last, speed)))
        last = time
    return found


@pytest.mark.requirement("PASS-04")
@given(true_passes())
@often
def test_true_pairs_are_believed_and_taken_for_what_they_are(run: TruePass) -> None:
    assert believed(run, run.pulses) == list(range(len(run.pulses)))


@given(true_passes(), st.data())
@often
def test_dead_sensors_cost_their_own_passages_alone(run: TruePass, data: st.DataObject) -> None:
    alive = data.draw(st.sets(st.integers(0, int(run.sensor.max())), min_size=1))
    kept = [number for number, (_, sensor, _) in enumerate(run.pulses) if sensor in alive]
    assert believed(run, [run.pulses[number] for number in kept]) == kept


@given(true_passes(), st.data())
@often
def test_where_pairs_are_lost_none_is_taken_for_a_later_one(run: TruePass, data: st.DataObject) -> None:
    numbers = range(len(run.pulses))
    kept = sorted(data.draw(st.sets(st.sampled_from(numbers), min_size=1)))
    found = believed(run, [run.pulses[number] for number in kept])
    for number, answer in zip(kept, found, strict=True):
        assert answer <= number
        assert answer == NONE or run.sensor[answer] == run.sensor[number]


@given(true_passes(most_axles=1), st.data())
@often
def test_of_one_axle_a_lost_pair_costs_itself_alone(run: TruePass, data: st.DataObject) -> None:
    kept = sorted(data.draw(st.sets(st.sampled_from(range(len(run.pulses))), min_size=1)))
    assert believed(run, [run.pulses[number] for number in kept]) == kept


@pytest.mark.parametrize("ahead_m", [-0.002, 0.0, 0.002])
def test_pairs_of_two_passages_at_one_place_are_believed_in_either_order(ahead_m: float) -> None:
    """Two sensors as far apart as two axles: one is over the second sensor as the other is over the first."""
    path = np.array([0.0, 8.65, 8.65 + ahead_m, 17.3])
    order = np.argsort(path, kind="stable")
    run = TruePass(path[order].astype(np.float32), np.array([0, 1, 0, 1])[order], ())
    for at in (2, 1):
        pulses = [(path[number] / 4.0, number % 2, 4.0) for number in (0, at, 3 - at, 3)]
        pulses[2] = (max(pulses[1][0], pulses[2][0]), *pulses[2][1:])
        assert [run.sensor[answer] for answer in believed(run, pulses)] == [sensor for _, sensor, _ in pulses]
        assert sorted(believed(run, pulses)) == [0, 1, 2, 3]
        again = believed(run, [*pulses[:3], pulses[2], pulses[3]])
        assert again[4] == 3


def with_one_more(run: TruePass, data: st.DataObject) -> tuple[list[Pulse], int]:
    """The pairs of `run` with a false one, of any sensor, time and speed, and its place."""
    last = run.pulses[-1][0]
    time = data.draw(st.floats(0.0, 1.0)) * last
    place = sum(pulse[0] <= time for pulse in run.pulses) if data.draw(st.booleans()) or last == 0.0 else 0
    time = time if place else 0.0
    near = run.pulses[max(place - 1, 0)][2]
    speed = data.draw(st.just(near) | st.floats(0.2, 16.0))
    sensor = data.draw(st.integers(0, int(run.sensor.max()) + 1))
    return [*run.pulses[:place], (time, sensor, speed), *run.pulses[place:]], place


@given(true_passes(most_axles=1), st.data())
@often
def test_of_one_axle_a_false_pair_costs_at_most_the_next_one(run: TruePass, data: st.DataObject) -> None:
    pulses, place = with_one_more(run, data)
    found = believed(run, pulses)
    true = found[:place] + found[place + 1 :]
    wrong = [number for number, answer in enumerate(true) if answer != number]
    assert wrong in ([], [place])
    assert all(true[number] == NONE for number in wrong)
    if found[place] == NONE:
        assert wrong == []


@given(true_passes(), st.data())
@often
def test_a_pair_that_is_not_believed_costs_nothing(run: TruePass, data: st.DataObject) -> None:
    pulses, place = with_one_more(run, data)
    found = believed(run, pulses)
    true = found[:place] + found[place + 1 :]
    assert true[:place] == list(range(place))
    if found[place] == NONE:
        assert true == list(range(len(true)))


@pytest.mark.parametrize(("same_speed", "most"), every(2, [(True, 0.5), (False, 0.1)]))
def test_what_a_false_pair_costs_with_several_axles(same_speed: bool, most: float) -> None:
    """Passages in the mean, of six sensors and four axles: for any speed, and for the very speed of the cut."""
    rng, costs = np.random.default_rng(7), []
    places, axles = np.array([0.0, 7.0, 13.0, 20.0, 26.0, 35.0]), np.array([0.0, 1.85, 8.65, 10.5])
    for _ in range(1500):
        run = rolled(places, axles, rng, bool(rng.integers(2)))
        time = rng.uniform(0.0, 1.0) * run.pulses[-1][0]
        place = sum(pulse[0] <= time for pulse in run.pulses)
        speed = run.pulses[place - 1][2] if same_speed else float(rng.uniform(0.3, 15.0))
        false = (time, int(rng.integers(0, 6)), speed)
        found = believed(run, [*run.pulses[:place], false, *run.pulses[place:]])
        true = found[:place] + found[place + 1 :]
        costs.append(sum(answer != number for number, answer in enumerate(true)))
    assert 0.0 < np.mean(costs) < most


@pytest.mark.requirement("PASS-05")
@given(
    true_passes(),
    st.lists(
        st.tuples(
            st.sampled_from(["lose", "double", "swap", "add", "late", "speed"]),
            st.floats(0.0, 1.0),
            st.floats(0.0, 1.0),
            st.integers(-1, 7),
            st.floats(),
        ),
        max_size=8,
    ),
)
@often
def test_whatever_is_heard_the_answer_is_a_passage_of_that_sensor_or_none(
    run: TruePass, faults: list[tuple[str, float, float, int, float]]
) -> None:
    pulses = list(run.pulses)
    for kind, at, share, sensor, number in faults:
        place = int(at * max(len(pulses) - 1, 0))
        if kind == "add" or not pulses:
            pulses.insert(place, (share * 60.0, sensor, number))
        elif kind == "lose":
            del pulses[place]
        elif kind == "double":
            pulses.insert(place, pulses[place])
        elif kind == "swap":
            pulses[place] = (pulses[place][0], sensor, pulses[place][2])
        elif kind == "late":
            pulses[place] = (pulses[place][0] + share, *pulses[place][1:])
        else:
            pulses[place] = (*pulses[place][:2], number)
    # Not sorted: times that go back are heard as waiting times below 0.
    for (_, heard, _), answer in zip(pulses, believed(run, pulses), strict=True):
        assert answer == NONE or run.sensor[answer] == heard


def test_axles_that_the_tracker_does_not_know_change_its_mind() -> None:
    """Why the passages heard are those of every axle: in a long section the others' pulses follow from each other."""
    table, speed = table_of(places_m=(-4.0, -1.0, 2.0, 30.0)), 4.0
    met = sorted((place + x, sensor) for sensor, place in enumerate(table.sensors.path_m) for x in (0.0, 8.65))
    pulses = [((path + 4.0) / speed, sensor, speed) for path, sensor in met]
    first_alone = TruePass(table.path_m, table.sensor_of, tuple(pulses))
    every = TruePass(table.heard_path_m, table.heard_sensor, tuple(pulses))
    assert [sensor for _, sensor, _ in pulses] == [0, 1, 2, 0, 1, 2, 3, 3]
    assert believed(first_alone, pulses) == [0, 1, 2, NONE, 1, 2, NONE, 3]
    heard = [int(table.heard_passage[answer]) for answer in believed(every, pulses)]
    assert heard == [0, 1, 2, -1, -1, -1, 3, -1]


@pytest.mark.parametrize("since_s", [float("nan"), -0.1, float("inf"), 1e7])
def test_a_time_that_cannot_be_leaves_everything_as_it_was(since_s: float) -> None:
    table, state = held_by(table_of()), np.zeros(6, np.float32)
    begin_cut(state)
    assert believed_passage(table, state, 0, 1.0, 4.0) == 0
    before = state.copy()
    assert believed_passage(table, state, 1, since_s, 4.0) == NONE
    assert state.tolist() == before.tolist()


def test_the_way_is_bounded_by_both_speeds() -> None:
    """From 4 to 2 m/s in 2 s, gaining 1 and losing 2 m/s² at most: by way of 14/3 m/s at most, of 4/3 at least."""
    limits = np.array([0.3, 15.0, 1.0, 2.0, 0.0, 0.0], np.float32)
    farthest = 0.5 * (4.0 + 14.0 / 3.0) * 2.0 / 3.0 + 0.5 * (14.0 / 3.0 + 2.0) * 4.0 / 3.0
    nearest = 0.5 * (4.0 + 4.0 / 3.0) * 4.0 / 3.0 + 0.5 * (4.0 / 3.0 + 2.0) * 2.0 / 3.0
    for way, answer in ((nearest - 0.01, NONE), (nearest + 0.01, 1), (farthest - 0.01, 1), (farthest + 0.01, NONE)):
        state = np.array([0.0, 4.0, 0.0, NONE, 0.0, 0.0], np.float32)
        table = tracking(np.array([0.0, way]), np.array([0, 1]), limits)
        assert believed_passage(table, state, 1, 2.0, 2.0) == answer
