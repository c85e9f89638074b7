"""The block diagrams of both regulators: with a radar, quantised in time, and with point sensors, quantised by path
(zhukovitsky-2012, figure 4).
"""

from __future__ import annotations

import numpy as np

from plant_models import Plant
from plant_models.stage_regulator import stage_locked_actuator
from synth.kernels.loop import passage_loop as kernel
from synth.kernels.loop import passage_pulses, passage_regulator, regulator
from synth.kernels.loop.motion import advance
from synth.simulation.closed_loop import ClosedLoop, close_loop
from synth.simulation.control_system import regulated_actuator, stage_by_table
from synth.simulation.controllers import TableController
from synth.simulation.passage_controller import PassageController
from synth.simulation.passage_loop import PassageLoop
from synth.simulation.structure.diagram import Block, Diagram, Number, Part
from synth.simulation.structure.shared_parts import command_parts, integrators, lock, pad_parts, pressure_parts


def radar_diagram(plant: Plant, controller: TableController, first_sample_s: float) -> Diagram:
    """`plant` under `controller`; `first_sample_s`: when the first sample comes, counted from where the pass begins.

    `ValueError` for a controller with an estimator, which the source does not have.
    """
    if controller.table.estimator is not None:
        raise ValueError("block diagram: a controller with an estimator has parts that are not declared")
    loop = close_loop(plant, controller.stages)
    free = loop.path.gravity_m_s2 - loop.path.drag_m_s2_per_n_kn * plant.resistance.mean_n_per_kn
    return Diagram(
        "radar: quantised in time",
        (
            *sampling_parts(loop, first_sample_s),
            *sampled_decision_parts(loop, controller),
            lock(regulated_actuator(plant, controller), plant.sensor),
            *command_parts(plant, plant.sensor),
            *pressure_parts(plant),
            *pad_parts(plant, loop.path),
            *integrators(plant, advance, (("edges_m", loop.path.edges_m), ("free", free))),
        ),
    )


def sampling_parts(loop: ClosedLoop, first_sample_s: float) -> tuple[Part, ...]:
    """Impulse element and the two relay elements."""
    sensor = loop.sensor
    return (
        Part(
            "impulse element", "ИЭ1", Block.MEASURING, "reads speed and path once every period",
            regulator.impulse_time_s, takes=(("sample", "n"),), gives=("tₙ",),
            given=(("first_s", first_sample_s), ("period_s", sensor.period_s)),
            hands_on=(("V", "V[n]"), ("S", "S[n]")), numbers=(Number("T_c", sensor.period_s, "s"),),
        ),
        Part(
            "relay element of the speed", "РЭ2", Block.MEASURING, "adds noise and rounds the speed to its quantum",
            regulator.measure, takes=(("v", "V[n]"), ("z", "z")), gives=("V*[n]",), given=(("sensor", sensor),),
            numbers=(Number("q", sensor.resolution_m_s, "m/s"), Number("noise", sensor.noise_m_s, "m/s")),
        ),
        Part(
            "relay element of the path", "РЭ3", Block.MEASURING, "rounds the path to the numbers of the rule, float32",
            path_in_float32, takes=(("path_m", "S[n]"),), gives=("S*[n]",),
        ),
    )  # fmt: skip


def sampled_decision_parts(loop: ClosedLoop, controller: TableController) -> tuple[Part, ...]:
    """The digital controller, and the interlock of the entrance."""
    entrance_stage = loop.plant.approach.entrance_stage
    return (
        Part(
            "digital controller", "D(z)", Block.COMPUTER, "compares the speed with the lines of the stage in force",
            stage_by_table, takes=(("stage", "U[n]"), ("s_m", "S*[n]"), ("v_m_s", "V*[n]")), gives=("D[n]",),
            given=(("law", controller.law()),), waits_for=("locked",),
            numbers=(Number("K", controller.stages - 1),),
        ),
        Part(
            "interlock of the entrance", "", Block.COMPUTER,
            "admits no stage before the entrance above the highest there",
            regulator.admitted, takes=(("stage", "U[n]"), ("wanted", "D[n]"), ("s", "S*[n]")), gives=("U[n]",),
            given=(("entrance_stage", entrance_stage),), numbers=(Number("highest ahead", loop.plant.entrance_stage),),
        ),
    )  # fmt: skip


def path_in_float32(path_m: float) -> float:
    """The path as the rule of tables takes it; nothing else quantises it, for a radar counts what it has rolled."""
    return float(np.float32(path_m))


def passage_diagram(loop: PassageLoop, controller: PassageController) -> Diagram:
    """The plant and sensors of `loop` under `controller`, which must have the tracker; else `ValueError`."""
    if not controller.tracks:
        raise ValueError("passage diagram: a regulator that is told its passages has no relay element of the path")
    plant, sensors, path = loop.plant, loop.sensors, loop.radar.path
    free = path.gravity_m_s2 - path.drag_m_s2_per_n_kn * plant.resistance.mean_n_per_kn
    actuator = stage_locked_actuator(plant.position, sensors, controller.stages - 1, 1)
    constants = (("edges_m", path.edges_m), ("free", free))
    return Diagram(
        "point sensors: quantised by path",
        (
            *passage_parts(loop, controller, constants),
            passage_decision_part(loop, controller),
            lock(actuator, sensors),
            *command_parts(plant, sensors),
            *pressure_parts(plant),
            *pad_parts(plant, path),
            *integrators(plant, kernel.roll, (*constants, ("to_m", float("inf")))),
        ),
    )


def passage_parts(
    loop: PassageLoop, controller: PassageController, constants: tuple[tuple[str, object], ...]
) -> tuple[Part, ...]:
    """Functional converter, impulse element, and the two relay elements."""
    sensors, pulses, rule = loop.sensors, loop.pulses_of(controller), controller.rule
    return (
        Part(
            "functional converter", "φ{F⁻¹(S)}", Block.MEASURING,
            "turns functions of time into functions of path: when is a place reached",
            kernel.roll,
            takes=(
                ("overpressure", "p"), ("brake", "B(S)"), ("duration_s", "Δt"), ("cell", "cell"), ("s", "S"),
                ("v", "V"), ("to_m", "coil"),
            ),
            gives=("", "", "", "F⁻¹(S)", "reached"), given=constants, undrawn=("p", "B(S)", "cell", "coil", "reached"),
        ),
        Part(
            "impulse element", "ИЭ1", Block.MEASURING, "lets through where a wheel passes the coils of a sensor",
            passage_pulses.coils_of, takes=(("source", "m"), ("z", "z_b")), gives=("first coil", "second coil"),
            given=(("pulses", pulses),),
            hands_on=(("F⁻¹(S)", "t_V[n]"), ("F⁻¹(S)", "m[n]"), ("F⁻¹(S)", "Δt[n]")), undrawn=("m",),
            numbers=(
                Number("sensors", len(set(pulses.sensor.tolist()))), Number("SB", sensors.base_m, "m"),
                Number("tolerance of SB", sensors.base_tolerance),
            ),
        ),
        Part(
            "relay element of the speed", "РЭ2", Block.MEASURING, "base over the time, which has noise and is rounded",
            passage_pulses.read_speed_m_s, takes=(("true_s", "t_V[n]"), ("z", "z")), gives=("V*[n]",),
            given=(("pulses", pulses),),
            numbers=(
                Number("timer", sensors.timer_resolution_s, "s"), Number("noise", sensors.timer_noise_s, "s"),
            ),
        ),
        Part(
            "relay element of the path", "РЭ3", Block.MEASURING, "tells which passage it was: the number of the place",
            passage_regulator.believed_passage,
            takes=(("sensor", "m[n]"), ("since_s", "Δt[n]"), ("reading_m_s", "V*[n]"), ("tracker", "believed")),
            gives=("S*[n]",),
            given=(("table", rule),),
            undrawn=("believed",), numbers=(Number("passages", len(rule.path_m)),),
        ),
    )  # fmt: skip


def passage_decision_part(loop: PassageLoop, controller: PassageController) -> Part:
    """The digital controller; the interlock of the entrance is part of its rule."""
    return Part(
        "digital controller", "D(z)", Block.COMPUTER,
        "compares the speed with the switching speeds of passage and stage in force",
        passage_regulator.stage_at_passage,
        takes=(("heard", "S*[n]"), ("stage", "U[n]"), ("v_m_s", "V*[n]")), gives=("U[n]",),
        given=(("law", controller.rule),), waits_for=("locked",),
        numbers=(Number("K", controller.stages - 1), Number("highest ahead", loop.plant.entrance_stage)),
    )  # fmt: skip
