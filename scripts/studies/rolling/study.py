"""How fast and how exactly cuts roll: the kernel beside numpy and scipy, errors by the step, time by the work."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from plant_models.frozen_arrays import Floats
from scripts.studies.rolling.beside import LOOSE, TIGHT, Accuracy, Motion, NumpyRoll, acceleration, solved
from scripts.studies.rolling.cases import CASES, COUPLING_M_S, PARK_EXIT_M, RollCase
from scripts.studies.rolling.findings import SLOW_M_S, RollingFindings, StepError, Way
from scripts.studies.study import Method, Tell, option
from scripts.studies.timing import Call, in_turns, this_machine
from synth.simulation.free_roll import STEP_M, RollingCuts, arrays_of, way_of

REFERENCE_STEP_M, REFERENCE_NODE_M = 0.1, 0.02
AS_EXACT_M = 2.0
"""Step by which Heun's rule in numpy is about as exact as the kernel."""

STATIONS = 5
"""Where speeds are compared: evenly spread over the way."""


@dataclass(frozen=True)
class Options:
    """How much is rolled."""

    cuts: int = option(20_000, "cuts of the comparison of speed", (16, 10**6))
    rounds: int = option(3, "rounds of the comparison", (1, 100))
    scipy_cuts: int = option(5, "cuts of each case that scipy rolls", (1, 1000))
    steps_m: tuple[float, ...] = option((20.0, 10.0, 6.0, 5.0, 2.5), "longest steps of single cars, m", (0.2, 100.0))
    error_cuts: int = option(10_000, "cuts of each row of errors", (16, 10**6))
    cars: tuple[int, ...] = option((1, 3, 8, 15), "cars of a cut", (1, 60))
    counts: tuple[int, ...] = option((1_000, 10_000, 100_000), "numbers of cuts", (16, 10**6))
    seed: int = option(1, "of the draws", (0, 2**31))


def run(options: Options, tell: Tell) -> RollingFindings:
    """Time, compare, scale."""
    machine, case = this_machine(), CASES[0]
    ways = timed_ways(case, options)
    tell(f"the kernel rolls {ways[0].per_s:.2e} cuts a second forwards")
    apart = [reference_errors(each, options) for each in CASES]
    tell("the reference stands beside scipy")
    errors: list[StepError] = []
    for each in CASES:
        for cars in (1, max(options.cars)):
            errors += step_errors(each, cars, options)
        tell(f"{each.name}: errors of {len(options.steps_m)} steps")
    by_cuts = [way for count in options.counts for way in kernel_ways(case, 1, count, options, f"{count} cuts")]
    by_cars = [way for cars in options.cars for way in kernel_ways(case, cars, options.cuts, options, f"{cars} cars")]
    speed_error, stop_error = (max(column) for column in zip(*apart, strict=True))
    return RollingFindings(
        machine, options.seed, STEP_M, case.length_m, options.error_cuts, REFERENCE_STEP_M, REFERENCE_NODE_M,
        options.scipy_cuts, speed_error, stop_error, tuple(ways), tuple(errors), tuple(by_cuts), tuple(by_cars),
    )  # fmt: skip


def timed_ways(case: RollCase, options: Options) -> list[Way]:
    """The kernel, numpy by the same steps and by steps that make it as exact, and scipy, in turns."""
    n, cuts = options.cuts, options.scipy_cuts
    made, other = case.rolling(1, options.seed, n), numpy_roll(case, options.seed, n)
    start, speed = case.starts_m(made), case.speeds_m_s(n)
    end = start + case.length_m
    on: dict[str, Callable[[], Floats]] = {
        "kernel, all cores": lambda: made.roll_on(start, speed, end[:, None]).speed_m_s[:, 0],
        numpy_name(STEP_M): lambda: other.on(start, speed, end, STEP_M)[0],
        numpy_name(AS_EXACT_M): lambda: other.on(start, speed, end, AS_EXACT_M)[0],
        "scipy solve_ivp": lambda: speeds_of(by_scipy(case, made, cuts, end[:, None], LOOSE)),
    }
    back: dict[str, Callable[[], Floats]] = {
        "kernel, all cores": lambda: made.roll_back(end, COUPLING_M_S, start),
        numpy_name(STEP_M): lambda: other.back(end, COUPLING_M_S, start, STEP_M),
        numpy_name(AS_EXACT_M): lambda: other.back(end, COUPLING_M_S, start, AS_EXACT_M),
    }
    fine = finely(case, 1, options.seed, n)
    truth = {
        "forwards": fine.roll_on(start, speed, end[:, None], REFERENCE_STEP_M).speed_m_s[:, 0],
        "backwards": fine.roll_back(end, COUPLING_M_S, start, REFERENCE_STEP_M),
    }
    calls = {
        (name, way): call for way, all_of in (("forwards", on), ("backwards", back)) for name, call in all_of.items()
    }
    times = in_turns({f"{way}: {name}": call for (name, way), call in calls.items()}, options.rounds)
    ways = []
    for (name, way), call in calls.items():
        found = call()
        true = truth[way][: len(found)]
        ways.append(Way(name, way, len(found), times[f"{way}: {name}"], largest(found - true, true)))
    return ways


def numpy_name(step_m: float) -> str:
    """Of numpy by some steps."""
    return f"numpy, steps of {step_m:g} m"


def speeds_of(motions: Sequence[Motion]) -> Floats:
    """At the last station, (n,)."""
    return np.array([each.speed_m_s[-1] for each in motions])


def largest(error: Floats, true: Floats) -> float:
    """Largest error where the true speed counts."""
    return float(np.abs(error)[true > SLOW_M_S].max(initial=0.0))


def numpy_roll(case: RollCase, seed: int, count: int) -> NumpyRoll:
    """The same single cars for numpy."""
    return NumpyRoll(case.population, case.track, PARK_EXIT_M, case.drawn(1, seed, count))


def by_scipy(case: RollCase, made: RollingCuts, count: int, stations_m: Floats, accuracy: Accuracy) -> list[Motion]:
    """The first `count` cuts of `made` by scipy."""
    start, speed = case.starts_m(made), case.speeds_m_s(len(made))
    found = []
    for i in range(min(count, len(made))):
        a = acceleration(made.cuts, i, case.track, case.law.linear_n_per_kn, case.extra_n_per_kn)
        found.append(solved(a, float(start[i]), float(speed[i]), stations_m[i], accuracy))
    return found


def finely(case: RollCase, cars: int, seed: int, count: int) -> RollingCuts:
    """Cuts on the track by fine nodes."""
    people, drawn = case.population, case.drawn(cars, seed, count)
    way, first_m = way_of(people, case.track, PARK_EXIT_M, drawn.mix, REFERENCE_NODE_M)
    return RollingCuts(drawn, way, arrays_of(people, case.track.bends, drawn, way, first_m))


def stations_of(case: RollCase, start_m: Floats) -> Floats:
    """Evenly spread over the way of each cut, (n, STATIONS)."""
    return np.asarray(start_m[:, None] + case.length_m * np.arange(1, STATIONS + 1) / STATIONS)


def reference_errors(case: RollCase, options: Options) -> tuple[float, float]:
    """Largest differences between the reference and scipy: speeds, stops."""
    fine = finely(case, 2, options.seed, options.scipy_cuts)
    start, speed = case.starts_m(fine), case.speeds_m_s(len(fine))
    stations = stations_of(case, start)
    rolled = fine.roll_on(start, speed, stations, REFERENCE_STEP_M)
    true = by_scipy(case, fine, len(fine), stations, TIGHT)
    speeds, stops = np.array([each.speed_m_s for each in true]), np.array([each.stop_m for each in true])
    stopped = np.isfinite(stops) & np.isfinite(rolled.stop_m)
    return largest(rolled.speed_m_s - speeds, speeds), float(
        np.abs(rolled.stop_m[stopped] - stops[stopped]).max(initial=0.0)
    )


def step_errors(case: RollCase, cars: int, options: Options) -> list[StepError]:
    """A row a step."""
    n = options.error_cuts
    fine, made = finely(case, cars, options.seed, n), case.rolling(cars, options.seed, n)
    start, speed = case.starts_m(made), case.speeds_m_s(n)
    stations = stations_of(case, start)
    finest = REFERENCE_STEP_M / longest_step_m(made, 1.0)
    true, back = (
        fine.roll_on(start, speed, stations, finest),
        fine.roll_back(stations[:, -1], COUPLING_M_S, start, finest),
    )
    fast = true.speed_m_s > SLOW_M_S
    rows = []
    for step in options.steps_m:
        rolled = made.roll_on(start, speed, stations, step)
        error = (rolled.speed_m_s - true.speed_m_s)[fast]
        stopped = np.isfinite(true.stop_m) & np.isfinite(rolled.stop_m)
        stops = rolled.stop_m[stopped] - true.stop_m[stopped]
        both = fast & (rolled.speed_m_s > 0.0)
        other = made.roll_back(stations[:, -1], COUPLING_M_S, start, step) - back
        rows.append(
            StepError(
                case.name, cars, step, longest_step_m(made, step), float(np.sqrt(np.mean(error**2))),
                float(np.abs(error).max()), float(np.sqrt(np.mean(stops**2))) if len(stops) else None,
                float(np.abs(stops).max()) if len(stops) else None,
                float(np.abs(rolled.time_s[both] / true.time_s[both] - 1.0).max()),
                largest(other, back) if np.any(back > SLOW_M_S) else None,
            )
        )  # fmt: skip
    return rows


def kernel_ways(case: RollCase, cars: int, count: int, options: Options, name: str) -> list[Way]:
    """The kernel alone, both directions."""
    made = case.rolling(cars, options.seed, count)
    start, speed = case.starts_m(made), case.speeds_m_s(count)
    end = start + case.length_m
    calls: dict[str, Call] = {
        "forwards": partial(made.roll_on, start, speed, end[:, None]),
        "backwards": partial(made.roll_back, end, COUPLING_M_S, start),
    }
    return [Way(name, way, count, times) for way, times in in_turns(calls, options.rounds).items()]


SMALLEST = Options(cuts=64, rounds=1, scipy_cuts=1, steps_m=(STEP_M, 20.0), error_cuts=64, cars=(1, 2), counts=(32, 64))
METHOD = Method(Options, SMALLEST, RollingFindings, run)


def longest_step_m(cuts: RollingCuts, of_a_car_m: float) -> float:
    """The longest step of these cuts, where that of a single car is `of_a_car_m`."""
    return of_a_car_m * float(cuts.arrays.long_steps.max())
