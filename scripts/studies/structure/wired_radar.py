"""A nominal pass with a radar, found by running the parts of the diagram one by one as they are wired."""

from __future__ import annotations

import math

import numpy as np

from plant_models import Plant
from scripts.studies.structure.wired_pressure import Signals, WiredPressure
from synth.kernels.loop.motion import MOVING, STALLED
from synth.simulation.closed_loop import SUBSTEP_S
from synth.simulation.control_system import regulated_actuator
from synth.simulation.controllers import TableController
from synth.simulation.impulse_train import resting_train
from synth.simulation.nominal_response import NominalResponse
from synth.simulation.random_passes import PATH_CELLS
from synth.simulation.structure.diagram import Diagram

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
