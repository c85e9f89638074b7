"""Service on demand: tasks, formulas and simulation.

Tasks to test with: of every law, with more than one of a priority.
Mean waits on demand: known figures, limits, laws of conservation, growth with the load.
The simulation: each request against a server that ticks, the means against the formulas.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from plant_models.errors import PlantError
from synth.computer.sizing.queue_simulation import Requests, drawn_requests, sampled_mean, simulated, simulated_waits
from synth.computer.sizing.service import Discipline, MeanWait, mean_waits, residual
from synth.computer.sizing.task import (
    Constant,
    Erlang,
    Exponential,
    Hyperexponential,
    Stream,
    Task,
    TaskMix,
    total_load,
)
from synth.computer.sizing.waiting_tail import sojourn_tail, start_tail

EXPONENTIAL = (
    Stream("a", 0.3, Exponential(0.5), 1),
    Stream("b", 0.3, Exponential(0.8), 2),
    Stream("c", 0.2, Exponential(1.0), 3),
)
"""The three classes of yard-facts §11.E."""
MIXED = (
    Stream("constant", 0.4, Constant(0.5), 1),
    Stream("erlang", 0.3, Erlang(0.8, 3), 2),
    Stream("hyper", 0.2, Hyperexponential(1.0, 3.0), 3),
    Stream("also second", 0.1, Exponential(0.5), 2),
)
LAWS = st.one_of(
    st.builds(Constant, st.floats(0.01, 1.0)),
    st.builds(Exponential, st.floats(0.01, 1.0)),
    st.builds(Erlang, st.floats(0.01, 1.0), st.integers(1, 9)),
    st.builds(Hyperexponential, st.floats(0.01, 1.0), st.floats(1.1, 20.0)),
)


@st.composite
def mixes(draw: st.DrawFn) -> tuple[Stream, ...]:
    """One to five streams with a load below 1 in all, some of equal priority."""
    laws = draw(st.lists(LAWS, min_size=1, max_size=5))
    shares = [draw(st.floats(0.01, 0.19)) for _ in laws]
    priorities = [draw(st.integers(1, 3)) for _ in laws]
    return tuple(
        Stream(str(i), share / law.mean, law, priority)
        for i, (law, share, priority) in enumerate(zip(laws, shares, priorities, strict=True))
    )


def test_the_figures_of_the_published_check() -> None:
    relative = mean_waits(EXPONENTIAL, Discipline.RELATIVE)
    absolute = mean_waits(EXPONENTIAL, Discipline.ABSOLUTE)
    assert [wait.start_s for wait in relative] == pytest.approx([0.549, 0.901, 1.867], abs=5e-4)
    assert [wait.sojourn_s for wait in absolute] == pytest.approx([0.588, 1.456, 3.507], abs=5e-4)


def conserved_work(streams: tuple[Stream, ...], waits: tuple[MeanWait, ...]) -> float:
    """Σ ρ_i W_i, s: the same for every order of service that neither idles nor interrupts, ρ W₀/(1 − ρ)."""
    return math.fsum(stream.load * wait.start_s for stream, wait in zip(streams, waits, strict=True))


@given(mixes())
def test_order_of_service_conserves_work(streams: tuple[Stream, ...]) -> None:
    # Kleinrock: any laws, any priorities; nobody is interrupted
    load = total_load(streams)
    right = load * residual(streams) / (1.0 - load)
    for discipline in (Discipline.FIRST_COME, Discipline.RELATIVE):
        assert conserved_work(streams, mean_waits(streams, discipline)) == pytest.approx(right, rel=1e-12)


def test_the_answers_keep_the_order_of_the_streams() -> None:
    for discipline in Discipline:
        assert [wait.task for wait in mean_waits(MIXED, discipline)] == [stream.name for stream in MIXED]


@pytest.mark.parametrize(("rate", "words"), [(2.0, "0 % more"), (2.5, "25 % more"), (20.0, "900 % more")])
def test_an_overloaded_computer_says_by_how_much(rate: float, words: str) -> None:
    streams = TaskMix((Task("all", rate, Constant(50.0)),)).streams(100.0)
    for discipline in Discipline:
        with pytest.raises(PlantError, match=words):
            mean_waits(streams, discipline)


def test_a_name_is_not_given_twice() -> None:
    task = Task("a", 1.0, Constant(1.0))
    with pytest.raises(PlantError, match="a is given twice"):
        TaskMix((task, task))


REQUESTS = 20_000


def lindley_waits(arrival_s: np.ndarray, service_s: np.ndarray) -> np.ndarray:
    """W_1 = 0, W_{n+1} = max(0, W_n + S_n − (A_{n+1} − A_n)): a walk above its running minimum. (n,) → (n,)."""
    walk = np.concatenate(([0.0], np.cumsum(service_s[:-1] - np.diff(arrival_s))))
    return np.asarray(walk - np.minimum.accumulate(walk))


def ticked(requests: Requests, priorities: list[int], interrupts: bool) -> tuple[list[int], list[int]]:
    """Begins and ends of requests with whole times, by a server that looks at its queue at every tick."""
    count = len(requests.arrival_s)
    rest, begin, end = [int(s) for s in requests.service_s], [-1] * count, [-1] * count
    running, now = None, 0
    while min(end) < 0:
        waiting = [i for i in range(count) if requests.arrival_s[i] <= now and rest[i] > 0]
        if waiting and (running is None or interrupts):
            running = min(waiting, key=lambda i: (priorities[i], i))
        if running is not None:
            begin[running] = now if begin[running] < 0 else begin[running]
            rest[running] -= 1
            if rest[running] == 0:
                end[running], running = now + 1, None
        now += 1
    return begin, end


@pytest.mark.parametrize("discipline", list(Discipline))
@pytest.mark.parametrize("seed", range(6))
def test_every_request_is_served_as_by_a_server_that_ticks(discipline: Discipline, seed: int) -> None:
    rng = np.random.default_rng(seed)
    arrival = np.sort(rng.choice(900, 120, replace=False)).astype(np.float64)  # never two at one tick
    stream = rng.integers(0, 3, 120).astype(np.intp)
    requests = Requests(arrival, stream, rng.integers(1, 12, 120).astype(np.float64))
    priorities = [0] * 120 if discipline is Discipline.FIRST_COME else [EXPONENTIAL[i].priority for i in stream]
    begin, end = ticked(requests, priorities, discipline is Discipline.ABSOLUTE)
    # at the tick in which a service ends, one that comes is just ahead of it, or, where it would interrupt, just behind
    little = 1e-6 * np.arange(120) * (1.0 if discipline is Discipline.ABSOLUTE else -1.0)
    served = simulated(Requests(arrival + little, stream, requests.service_s), EXPONENTIAL, discipline)
    assert np.allclose(served.end_s, end, atol=1e-3)
    if discipline is not Discipline.ABSOLUTE:  # there another may begin in between, for a millionth of a tick
        assert np.allclose(served.begin_s, begin, atol=1e-3)


@pytest.mark.parametrize("streams", [EXPONENTIAL, MIXED], ids=["exponential", "mixed"])
@pytest.mark.parametrize("discipline", list(Discipline))
def test_formulas_hold_within_the_intervals(streams: tuple[Stream, ...], discipline: Discipline) -> None:
    # 95 % intervals of half width h: 2.2 h are about 4.4 standard errors, for some 40 comparisons
    simulated_tasks = simulated_waits(streams, discipline, REQUESTS, 20261122, 3.0)
    for told, found in zip(mean_waits(streams, discipline), simulated_tasks, strict=True):
        tail = start_tail(streams, discipline, told.task, 3.0).value
        late = sojourn_tail(streams, discipline, told.task, 3.0).value
        assert abs(found.start_s.value - told.start_s) <= 2.2 * found.start_s.half_width
        assert abs(found.wait_s.value - told.wait_s) <= 2.2 * found.wait_s.half_width
        assert abs(found.sojourn_s.value - told.sojourn_s) <= 2.2 * found.sojourn_s.half_width
        assert abs(found.long_share.value - tail) <= 2.2 * found.long_share.half_width + 1e-3
        assert abs(found.late_share.value - late) <= 2.2 * found.late_share.half_width + 1e-3


def test_the_same_seed_gives_the_same_waits() -> None:
    one, other = (simulated_waits(MIXED, Discipline.ABSOLUTE, 3000, 4, 1.0) for _ in range(2))
    assert one == other
    assert one != simulated_waits(MIXED, Discipline.ABSOLUTE, 3000, 5, 1.0)


def test_draws_have_the_rates_and_loads_of_the_streams() -> None:
    requests = drawn_requests(MIXED, 200_000, np.random.default_rng(1))
    span_s = requests.arrival_s[-1]
    for index, stream in enumerate(MIXED):
        mine = requests.stream == index
        assert mine.sum() / span_s == pytest.approx(stream.rate_per_s, rel=4.0 / np.sqrt(mine.sum()) + 0.01)
    assert requests.service_s.sum() / span_s == pytest.approx(total_load(MIXED), rel=0.03)


@pytest.mark.parametrize("load", [0.3, 0.8])
def test_the_interval_covers_the_mean_wait_of_mm1(load: float) -> None:
    """300 runs without their first tenth: a coverage of 0.95 is seen as 0.913 at least with probability 0.998."""
    rng, requests, held = np.random.default_rng(7), 50_000, 0
    for _ in range(300):
        arrival_s = np.cumsum(rng.exponential(1.0 / load, requests))
        found = sampled_mean(lindley_waits(arrival_s, rng.exponential(1.0, requests))[requests // 10 :])
        held += abs(found.value - load / (1.0 - load)) <= found.half_width
    assert 0.91 <= held / 300 <= 0.985


def test_bad_questions_are_refused() -> None:
    with pytest.raises(PlantError, match="overloaded"):
        simulated_waits((Stream("a", 1.0, Constant(1.0), 1),), Discipline.FIRST_COME, 1000, 1, 1.0)
    with pytest.raises(PlantError, match="simulate more"):
        simulated_waits((Stream("a", 0.5, Exponential(1.0), 1),), Discipline.FIRST_COME, 50, 1, 1.0)
