"""The block diagram of the regulator with a radar: quantised in time (as figure 4 of zhukovitsky-2012)."""

from __future__ import annotations

import numpy as np

from plant_models import Plant
from synth.kernels.loop import regulator
from synth.kernels.loop.motion import advance
from synth.simulation.closed_loop import ClosedLoop, close_loop
from synth.simulation.control_system import regulated_actuator, stage_by_table
from synth.simulation.controllers import TableController
from synth.simulation.structure.diagram import Diagram
from synth.simulation.structure.part import Block, Number, Part
from synth.simulation.structure.shared_parts import (
    command_parts,
    integrators,
    lock,
    pad_parts,
    pressure_parts,
)


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
