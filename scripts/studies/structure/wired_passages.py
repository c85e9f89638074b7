"""A nominal pass with point sensors, found by running the parts of the diagram one by one as they are wired."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from plant_models.stage_regulator import stage_locked_actuator
from scripts.studies.structure.wired_radar import (
    INTEGRATORS,
    Runner,
    Signals,
    WiredPressure,
    begin,
    point,
    response_of,
    send,
)
from synth.kernels.loop.motion import MOVING, STALLED
from synth.kernels.loop.passage_loop import ON_COIL, WATCHED_FROM_S
from synth.kernels.loop.passage_regulator import DECIDED, outcome_of
from synth.simulation.closed_loop import SUBSTEP_S
from synth.simulation.nominal_response import NominalResponse
from synth.simulation.passage_controller import PassageController
from synth.simulation.passage_loop import PassageLoop
from synth.simulation.structure.diagram import Diagram
from tuning_tables.programs.tracker import begin_cut


class Coil(NamedTuple):
    """Where the first axle is when a coil tells a wheel; `second`: which of the two; `source`: the pulses."""

    path_m: float
    second: bool
    source: int


def wired_passage_pass(
    diagram: Diagram, loop: PassageLoop, controller: PassageController, speed_m_s: float
) -> NominalResponse:
    """The pass of a cut that enters with `speed_m_s`; parts of a transient are those of the simulator."""
    plant, sensors = loop.plant, loop.sensors
    actuator, stage = stage_locked_actuator(plant.position, sensors, controller.stages - 1, 1), loop.drive.initial_stage
    rest_kpa = float(actuator.mode_pressure_kpa[loop.drive.initial_mode])
    signals = begin(diagram, plant, stage, loop.drive.initial_mode, rest_kpa, speed_m_s)
    signals.update(
        {"locked": -math.inf, "z_b": 0.0, "believed": np.zeros(6, dtype=np.float32), "heard": WATCHED_FROM_S}
    )
    begin_cut(signals["believed"])
    run, pressure = Runner(diagram, signals), WiredPressure(diagram, signals)
    coils = coils_of(diagram, len(loop.pulses_of(controller).path_m))
    first_s = pulses_before(coils, plant.start_m, signals["V"], dict(diagram[INTEGRATORS[0]].given)["free"][0])
    coils = coils[len(first_s) :]
    part_s = sensors.scan_period_s / math.ceil(sensors.scan_period_s / SUBSTEP_S - 1e-9)
    begun_s, played, points = 0.0, 0, [point(signals)]
    while signals["status"] == MOVING:
        end_s = begun_s + (played + 1) * part_s
        signals["p"] = pressure.mean_overpressure_kpa(begun_s + played * part_s, end_s)
        played += 1
        now = points[-1][0]
        while signals["status"] == MOVING and now < end_s:
            signals.update({"Δt": end_s - now, "coil": coils[0].path_m if coils else math.inf})
            to_coil = {"to_m": signals["coil"]}
            run("functional converter", *INTEGRATORS, **to_coil)
            now = end_s if signals["status"] == MOVING else now + signals["F⁻¹(S)"]
            signals["t"] = now
            if signals["status"] == ON_COIL:
                signals["status"] = MOVING
                coil, *coils = coils
                if not coil.second:
                    first_s[coil.source] = now
                elif heard(run, signals, loop, controller, coil.source, now - first_s[coil.source]):
                    begun_s, played = now, 0
                    signals["locked"] = now + signals["locked"] * sensors.scan_period_s
                    end_s = now
            points.append(point(signals))
    return response_of(points, signals["status"] == STALLED)


def coils_of(diagram: Diagram, sources: int) -> list[Coil]:
    """All coils in the order of the path."""
    element, found = diagram["impulse element"], []
    for source in range(sources):
        places = element.run({"m": source, "z_b": 0.0})
        found += [Coil(places["first coil"], False, source), Coil(places["second coil"], True, source)]
    return sorted(found)


def pulses_before(coils: list[Coil], start_m: float, speed_m_s: float, free_m_s2: float) -> dict[int, float]:
    """Times of the first pulses of the passages whose first coil lies before `start_m`, which is reached at time 0."""
    found = {}
    for coil in coils:
        if coil.path_m < start_m:
            way = start_m - coil.path_m
            found[coil.source] = -2.0 * way / (speed_m_s + math.sqrt(speed_m_s**2 - 2.0 * free_m_s2 * way))
    return found


def heard(
    run: Runner, signals: Signals, loop: PassageLoop, controller: PassageController, source: int, over_base_s: float
) -> bool:
    """Let the regulator hear the second pulse of `source`; whether it commands a change of stage."""
    now, pulses = signals["t"], loop.pulses_of(controller)
    signals.update({"m": source, "m[n]": int(pulses.sensor[source]), "t_V[n]": over_base_s, "tₙ": now})
    signals["Δt[n]"], signals["heard"] = now - signals["heard"], now
    run("relay element of the speed")
    run("relay element of the path")
    before = signals["U[n]"]
    if outcome_of(controller.rule, signals["S*[n]"], now - 0.5 * over_base_s >= signals["locked"]) == DECIDED:
        run("digital controller")
    if signals["U[n]"] == before:
        return False
    run("lock")
    send(run, signals)
    return True
