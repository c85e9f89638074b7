"""The same queue request by request: a discrete-event simulation with simpy, as a second opinion on the formulas."""

from __future__ import annotations

import math
from collections.abc import Generator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from plant_models.errors import require
from plant_models.frozen_arrays import Floats, frozen_arrays
from synth.computer.sizing.service import Discipline
from synth.computer.sizing.task import Stream, require_not_overloaded
from synth.frame.interval import Interval

if TYPE_CHECKING:
    import simpy

CUT_SHARE = 0.05
"""Of the requests, at the begin (the queue starts empty) and at the end (it runs empty)."""

MOST_REQUESTS = 1 << 40

BATCHES = 30
CONFIDENCE = 0.95


@frozen_arrays
class Requests:
    """Requests in the order in which they come: times in s, which stream, and the service that each needs, (n,)."""

    arrival_s: Floats
    stream: NDArray[np.intp]
    service_s: Floats


@frozen_arrays
class Served:
    """What became of `requests`: when the service of each began, and when it was done, (n,)."""

    requests: Requests
    begin_s: Floats
    end_s: Floats

    @property
    def start_s(self) -> Floats:
        """From request to begin of service, (n,)."""
        return self.begin_s - self.requests.arrival_s

    @property
    def wait_s(self) -> Floats:
        """All the time without service, (n,)."""
        return self.sojourn_s - self.requests.service_s

    @property
    def sojourn_s(self) -> Floats:
        """From request to end, (n,)."""
        return self.end_s - self.requests.arrival_s


@dataclass(frozen=True)
class SimulatedWait:
    """Of one task: means in s with their 95 % intervals, and the shares of requests that are not begun (`long_share`)
    and not done (`late_share`) within `long_s`."""

    task: str
    start_s: Interval
    wait_s: Interval
    sojourn_s: Interval
    long_s: float
    long_share: Interval
    late_share: Interval


def simulated_waits(
    streams: tuple[Stream, ...], discipline: Discipline, requests: int, seed: int, long_s: float
) -> tuple[SimulatedWait, ...]:
    """Each stream's waits among so many `requests` of all, by stream; the first and last 5 % of them are cut away.

    Raises `PlantError` if ρ ≥ 1, or where a task has too few requests for an interval.
    """
    require_not_overloaded(streams)
    served = simulated(drawn_requests(streams, requests, np.random.default_rng(seed)), streams, discipline)
    kept = np.zeros(requests, dtype=np.bool_)
    cut = int(CUT_SHARE * requests)
    kept[cut : requests - cut] = True
    found = []
    for index, stream in enumerate(streams):
        mine = kept & (served.requests.stream == index)
        start_s, sojourn_s = served.start_s[mine], served.sojourn_s[mine]
        found.append(
            SimulatedWait(
                task=stream.name,
                start_s=sampled_mean(start_s),
                wait_s=sampled_mean(served.wait_s[mine]),
                sojourn_s=sampled_mean(sojourn_s),
                long_s=long_s,
                long_share=sampled_mean((start_s > long_s).astype(np.float64)),
                late_share=sampled_mean((sojourn_s > long_s).astype(np.float64)),
            )
        )
    return tuple(found)


def drawn_requests(streams: tuple[Stream, ...], count: int, rng: np.random.Generator) -> Requests:
    """`count` requests of all streams: one Poisson stream of the total rate, divided among the tasks by chance."""
    rates = np.array([stream.rate_per_s for stream in streams])
    arrival_s = np.cumsum(rng.exponential(1.0 / rates.sum(), count))
    which = rng.choice(len(streams), count, p=rates / rates.sum())
    service_s = np.empty(count)
    for index, stream in enumerate(streams):
        mine = which == index
        service_s[mine] = stream.service.draw(rng, int(mine.sum()))
    return Requests(arrival_s, which, service_s)


def simulated(requests: Requests, streams: tuple[Stream, ...], discipline: Discipline) -> Served:
    """Serve `requests` by one processor until all are done."""
    import simpy

    count = len(requests.arrival_s)
    ranks = _ranks(requests, streams, discipline)
    begin_s, end_s = np.empty(count), np.empty(count)
    world = simpy.Environment()
    processor = simpy.PreemptiveResource(world)
    interrupts = discipline is Discipline.ABSOLUTE

    def request(index: int, rest_s: float) -> Generator[simpy.Event, Any, None]:
        begun = False
        while True:
            with processor.request(priority=ranks[index], preempt=interrupts) as turn:
                yield turn
                since_s = world.now
                if not begun:
                    begin_s[index], begun = since_s, True
                try:
                    yield world.timeout(rest_s)
                except simpy.Interrupt:
                    # the rounding of the clock must not make a negative rest
                    rest_s = max(0.0, rest_s - (world.now - since_s))
                else:
                    end_s[index] = world.now
                    return

    def source() -> Generator[simpy.Event, Any, None]:
        for index, (time_s, service_s) in enumerate(zip(requests.arrival_s, requests.service_s, strict=True)):
            yield world.timeout(max(0.0, float(time_s) - world.now))
            world.process(request(index, float(service_s)))

    world.process(source())
    world.run()
    return Served(requests, begin_s, end_s)


def _ranks(requests: Requests, streams: tuple[Stream, ...], discipline: Discipline) -> list[int]:
    """One number for priority and turn: simpy ranks an interrupted request by the time at which it asks again, which
    would put it behind its equals; with its turn in the number it stays ahead of them."""
    turns = np.arange(len(requests.arrival_s))
    if discipline is Discipline.FIRST_COME:
        return [int(turn) for turn in turns]
    priorities = np.array([stream.priority for stream in streams])[requests.stream]
    return [int(priority) * MOST_REQUESTS + int(turn) for priority, turn in zip(priorities, turns, strict=True)]


def sampled_mean(values: Floats, batches: int = BATCHES) -> Interval:
    """The mean of a stationary sequence (n,), in the order of time; n at least 2 · `batches`.

    The sequence is cut into `batches` of equal length. Means of batches that are much longer than the values depend on
    each other are nearly independent and normal, so Student's interval of them holds. With short batches it is too
    narrow. Of 2 000 runs of M/M/1 with 50 000 requests each it held the true mean wait in 95.9, 95.4, 93.4
    and 89.7 % (± 0.9 to 1.3) at ρ = 0.3, 0.5, 0.8 and 0.9: the busier the queue, the longer a run must be.
    """
    require(
        len(values) >= 2 * batches,
        f"{len(values)} values were simulated; {batches} batches need at least {2 * batches}: simulate more",
    )
    length = len(values) // batches
    means = values[: length * batches].reshape(batches, length).mean(axis=1)
    half_width = student_quantile(batches - 1) * float(np.std(means, ddof=1)) / math.sqrt(batches)
    mean = float(np.mean(means))
    return Interval(mean, mean - half_width, mean + half_width, length * batches)


def student_quantile(freedom: int) -> float:
    """Of the two-sided 95 % interval."""
    from scipy.stats import t

    return float(t.ppf(0.5 + 0.5 * CONFIDENCE, freedom))
