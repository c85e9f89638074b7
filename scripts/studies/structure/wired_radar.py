"""A nominal pass with a radar, found by running the parts of the diagram one by one as they are wired, those of
the pressure regulator among them.

The pressure over time, found by running the parts of the pressure regulator as they are wired. Nothing here knows the
law of the drive: when the relay lets go is found by halving, what the pads feel by quadrature.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from plant_models import Plant
from synth.kernels.loop.motion import MOVING, STALLED
from synth.simulation.closed_loop import SUBSTEP_S
from synth.simulation.control_system import regulated_actuator, resting_train
from synth.simulation.controllers import TableController
from synth.simulation.nominal_response import NominalResponse
from synth.simulation.random_passes import PATH_CELLS
from synth.simulation.structure.diagram import Diagram

Signals = dict[str, Any]

HALVINGS = 60
"""Of a stretch of time, down to the last bit."""

NODES, WEIGHTS = np.polynomial.legendre.leggauss(10)


class WiredPressure:
    """The part of a run that is in the pressure regulator: which connection waits for its valve, and until when."""

    def __init__(self, diagram: Diagram, signals: Signals) -> None:
        self._diagram, self._signals = diagram, signals
        self._opens_s = math.inf

    def mean_overpressure_kpa(self, start_s: float, end_s: float) -> float:
        """Mean of p from `start_s` to `end_s`; afterwards the signals P, U_k, … are those of `end_s`."""
        signals, total, now = self._signals, 0.0, start_s
        while now < end_s:
            lasts_s = min([instant - now for instant, _ in signals["U*[n]"] if instant > now] + [end_s - now])
            signals["t"] = now
            for name in ("zero-order hold", "converter", "comparison", "relay element of the pressure"):
                self._run(name)
            self._run("block of changing structure")
            if signals["sgn ε_U"] == 0:
                self._opens_s = math.inf
            elif self._opens_s == math.inf:
                self._run("valve delay")
                self._opens_s = now + signals["τ(P)"]
            if now < self._opens_s:  # nothing is connected yet: the drive is closed on itself
                lasts_s = min(lasts_s, self._opens_s - now)
                on_itself = self._diagram["block of changing structure"].run({**signals, "sgn ε_U": 0})
                signals["P_v, T"] = on_itself["P_in, T"]
            else:
                signals["P_v, T"] = signals["P_in, T"]
                lasts_s = first_time(lambda x: self._sign_after(x) == 0, lasts_s)
            total += self._integral(lasts_s)
            signals["P"] = self._pressure_after(lasts_s)
            now += lasts_s
        return total / (end_s - start_s)

    def _run(self, name: str) -> None:
        self._signals.update(self._diagram[name].run(self._signals))

    def _pressure_after(self, time_s: float) -> float:
        return float(self._diagram["pneumatic link"].run({**self._signals, "Δt": time_s})["P"])

    def _sign_after(self, time_s: float) -> int:
        then: Signals = {**self._signals, "P": self._pressure_after(time_s)}
        for name in ("converter", "comparison", "relay element of the pressure"):
            then.update(self._diagram[name].run(then))
        return int(then["sgn ε_U"])

    def _felt_after(self, time_s: float) -> float:
        then = {**self._signals, "P": self._pressure_after(time_s)}
        return float(self._diagram["dead zone of the pads"].run(then)["p"])

    def _integral(self, time_s: float) -> float:
        """∫p dt over the next `time_s`; where the pads touch or let go, the stretch is cut in two."""
        touching = self._felt_after(0.0) > 0.0
        cut_s = first_time(lambda x: (self._felt_after(x) > 0.0) != touching, time_s)
        total = 0.0
        for start, end in ((0.0, cut_s), (cut_s, time_s)):
            times = start + 0.5 * (end - start) * (NODES + 1.0)
            total += 0.5 * (end - start) * float(WEIGHTS @ [self._felt_after(time) for time in times])
        return total


def first_time(reached: Callable[[float], bool], longest_s: float) -> float:
    """The first time at which `reached`, which then stays, is true; `longest_s` if it is not true before."""
    if not reached(longest_s):
        return longest_s
    low, high = 0.0, longest_s
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if reached(middle) else (middle, high)
    return high


INTEGRATORS = ("integrator of the speed", "integrator of the path")


def wired_radar_pass(diagram: Diagram, plant: Plant, controller: TableController, speed_m_s: float) -> NominalResponse:
    """The pass of a cut that enters with `speed_m_s`; steps of time are those of the simulator."""
    actuator, period = regulated_actuator(plant, controller), plant.sensor.sample_period_s
    stage = plant.approach.initial_stage
    signals = begin(diagram, plant, stage, actuator.mode_of(stage), float(actuator.mode_pressure_kpa[0]), speed_m_s)
    run, pressure = Runner(diagram, signals), WiredPressure(diagram, signals)
    points = [point(signals)]
    substeps = math.ceil(period / SUBSTEP_S)
    first = dict(diagram["impulse element"].given)["first_s"]
    move(run, pressure, signals, 0.0, first)
    points.append(point(signals))
    while signals["status"] == MOVING:
        run("impulse element")
        signals.update({"V[n]": signals["V"], "S[n]": signals["S"]})
        run("relay element of the speed")
        run("relay element of the path")
        if signals["locked"] == 0:
            before = signals["U[n]"]
            run("digital controller")
            run("interlock of the entrance")
            if signals["U[n]"] != before:
                run("lock")
        signals["locked"] = max(0, signals["locked"] - 1)
        send(run, signals)
        for i in range(substeps):
            start = signals["tₙ"] + i * period / substeps
            points.append(point({**signals, "t": start}))
            move(run, pressure, signals, start, start + period / substeps)
            if signals["status"] != MOVING:
                break
        signals["n"] += 1
    points.append(point(signals))
    return response_of(points, signals["status"] == STALLED)


class Runner:
    """Runs a part on the signals of a pass and writes down what it gives."""

    def __init__(self, diagram: Diagram, signals: Signals) -> None:
        self._diagram, self._signals = diagram, signals

    def __call__(self, *names: str, **other: float) -> None:
        """Run these parts at the same moment: each sees what was there before. `other`: see `Part.run`."""
        found = [self._diagram[name].run(self._signals, **other) for name in names]
        for each in found:
            self._signals.update(each)


def begin(
    diagram: Diagram, plant: Plant, stage: int, mode: int, pressure_kpa: float, entry_speed_m_s: float
) -> Signals:
    """The signals where the pass begins: at rest, mean friction, no noise."""
    speed = plant.start_speed_m_s(np.array(entry_speed_m_s), plant.resistance.mean_n_per_kn)
    slopes = {"ξ_cut": np.ones(1), "η": np.zeros((1, PATH_CELLS), dtype=np.float32)}
    return {
        "t": 0.0, "n": 0, "S": plant.start_m, "V": float(speed), "cell": 0, "status": MOVING, "used": 0.0,
        "P": pressure_kpa, "mode": mode, "U[n]": stage, "locked": 0, "z": 0.0,
        "U*[n]": resting_train(plant.position.stage_pressures_kpa[stage]),
        "B(S)": diagram["slope of the pads"].run(slopes)["B(S)"][0],
    }  # fmt: skip


def send(run: Runner, signals: Signals) -> None:
    """Hand the command of this moment on to the hold."""
    run("computing delay")
    signals["U_τ[n]"] = signals["U[n]"]
    run("ideal impulse element")


def move(run: Runner, pressure: WiredPressure, signals: Signals, start_s: float, end_s: float) -> None:
    """Let the pressure act and the cut move from `start_s` to `end_s`, or to the exit, or to where it stops."""
    if end_s <= start_s:
        return
    signals["p"] = pressure.mean_overpressure_kpa(start_s, end_s)
    signals["Δt"] = end_s - start_s
    run(*INTEGRATORS)
    signals["t"] = start_s + signals["used"]


def point(signals: Signals) -> tuple[float, ...]:
    """Time, path, speed, pressure, stage."""
    return signals["t"], signals["S"], signals["V"], signals["P"], signals["U[n]"]


def response_of(points: list[tuple[float, ...]], stalled: bool) -> NominalResponse:
    """The points as a response."""
    time, path, speed, pressure, stage = np.array(points).T.copy()
    return NominalResponse(time, path, speed, pressure, stage.astype(np.int64), stalled)
