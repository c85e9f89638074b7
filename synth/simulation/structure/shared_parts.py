"""The parts that a regulator with radar and one with point sensors share: from the command to the motion of the cut."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from plant_models import Plant, pressure_regulator
from plant_models.pressure_regulator import overpressure_kpa
from plant_models.stage_regulator import Actuator, RegulatorClock, reaches_valves_s
from plant_models.valve_drive import wait_after_command
from synth.kernels.loop.motion import Path
from synth.simulation.closed_loop import pad_slopes
from synth.simulation.control_system import held, with_command
from synth.simulation.structure.diagram import Block, Number, Part


def lock(actuator: Actuator, clock: RegulatorClock) -> Part:
    """Part of the computer: it decides only after the transient has ended."""
    return Part(
        "lock", "", Block.COMPUTER, "keeps the controller from deciding until the transient has ended",
        actuator.change, takes=(("mode", "mode"), ("stage", "U[n]")), gives=("mode", "locked"),
        numbers=(Number("T_c", clock.sample_period_s, "s"),),
    )  # fmt: skip


def command_parts(plant: Plant, clock: RegulatorClock) -> tuple[Part, ...]:
    """Computing delay, ideal impulse element, zero-order hold."""
    return (
        Part(
            "computing delay", "", Block.COMPUTER, "hands each command on when it has been computed",
            reaches_valves_s, takes=(("decided_s", "tₙ"),), gives=("tₙ + τ_c",),
            given=(("computing_delay_s", clock.computing_delay_s),), hands_on=(("U[n]", "U_τ[n]"),),
            undrawn=("tₙ + τ_c",), numbers=(Number("τ_c", clock.computing_delay_s, "s"),),
        ),
        Part(
            "ideal impulse element", "ИЭ3", Block.COMPUTER,
            "makes an impulse of each command, of the area of the stage's signal",
            with_command, takes=(("train", "U*[n]"), ("instant_s", "tₙ + τ_c"), ("stage", "U_τ[n]")),
            gives=("U*[n]",), given=(("stage_pressures_kpa", plant.position.stage_pressures_kpa),),
            undrawn=("tₙ + τ_c",),
            numbers=tuple(Number(f"U_{k}", p, "kPa") for k, p in enumerate(plant.position.stage_pressures_kpa)),
        ),
        Part(
            "zero-order hold", "", Block.COMPUTER, "holds the signal of the stage from one impulse to the next",
            held, takes=(("train", "U*[n]"), ("time_s", "t")), gives=("U_k",),
        ),
    )  # fmt: skip


def pressure_parts(plant: Plant) -> tuple[Part, ...]:
    """The pressure regulator and the drive."""
    air, valves = plant.position.pneumatics, plant.position.pneumatics.valves(plant.position.force.touch_pressure_kpa)
    return (
        Part(
            "converter", "K4", Block.PRESSURE, "turns the pressure into a signal like that of a stage",
            pressure_regulator.converted_kpa, takes=(("pressure_kpa", "P"),), gives=("U_P",),
            numbers=(Number("K4", pressure_regulator.CONVERTER_FACTOR),),
        ),
        Part(
            "comparison", "", Block.PRESSURE, "tells how much pressure is missing",
            pressure_regulator.mismatch_kpa, takes=(("stage_kpa", "U_k"), ("shown_kpa", "U_P")), gives=("ε_U",),
        ),
        Part(
            "relay element of the pressure", "РЭ1", Block.PRESSURE, "tells the sign, 0 in the dead zone",
            pressure_regulator.relay, takes=(("error_kpa", "ε_U"),), gives=("sgn ε_U",),
            given=(("band_kpa", air.dead_band_kpa),), numbers=(Number("ε", air.dead_band_kpa, "kPa"),),
        ),
        Part(
            "block of changing structure", "БИС, КЭ", Block.PRESSURE,
            "connects the drive to supply or exhaust, or closes it on itself",
            pressure_regulator.connected, takes=(("sign", "sgn ε_U"), ("pressure_kpa", "P")), gives=("P_in, T",),
            given=(("drive", valves),),
            numbers=(
                Number("P_max", air.supply_pressure_kpa, "kPa"), Number("P_min", air.exhaust_pressure_kpa, "kPa"),
            ),
        ),
        Part(
            "valve delay", "ЭПК", Block.PRESSURE, "opens the valve after its delay",
            wait_after_command,
            takes=(("pressure_kpa", "P"), ("old_kpa", "P"), ("new_kpa", "U_k")), gives=("τ(P)",),
            given=(("wait_s", 0.0), ("drive", valves)), hands_on=(("P_in, T", "P_v, T"),),
            numbers=(
                Number("tZ2", air.brake_delay_s, "s"), Number("t00", air.touch_delay_s, "s"),
                Number("tZ0", air.release_delay_s, "s"),
            ),
        ),
        Part(
            "pneumatic link", "T = f(sign ε_U)", Block.PRESSURE,
            "follows what it is connected to; closed on itself it keeps its pressure",
            pressure_regulator.flowed_kpa,
            takes=(("pressure_kpa", "P"), ("connection", "P_v, T"), ("time_s", "Δt")), gives=("P",),
            numbers=(
                Number("T_fill", air.fill_time_constant_s, "s"), Number("T_exh", air.exhaust_time_constant_s, "s"),
            ),
        ),
    )  # fmt: skip


def pad_parts(plant: Plant, path: Path) -> tuple[Part, ...]:
    """Dead zone of the pads, and their slope."""
    touch = plant.position.force.touch_pressure_kpa
    return (
        Part(
            "dead zone of the pads", "", Block.PADS, "brakes only with the pressure above the touch of the pads",
            overpressure_kpa, takes=(("pressure_kpa", "P"),), gives=("p",), given=(("touch_kpa", touch),),
            numbers=(Number("P0", touch, "kPa"),),
        ),
        Part(
            "slope of the pads", "", Block.PADS,
            "random slope; its mean goes with the number N of braked wheel pairs",
            pad_slopes, takes=(("factor", "ξ_cut"), ("path_z", "η")), gives=("B(S)",), given=(("path", path),),
            numbers=(Number("CV of ξ_cut", round(plant.friction_cv, 6)), Number("σ_η", plant.friction.path_std)),
        ),
    )  # fmt: skip


def integrators(plant: Plant, law: Callable[..., Any], given: tuple[tuple[str, Any], ...]) -> tuple[Part, ...]:
    """The two integrators of the cut; `law` is the closed form that computes both, `given` its constants."""
    moved = (("overpressure", "p"), ("brake", "B(S)"), ("duration_s", "Δt"), ("cell", "cell"), ("s", "S"), ("v", "V"))
    return (
        Part(
            "integrator of the speed", "", Block.CUT, "sums grade, resistance and brake up to the speed",
            law, takes=moved, gives=("", "", "V", "", ""), given=given, undrawn=("cell",),
            numbers=(Number("Q", plant.cut.mass_t, "t"), Number("n", plant.cut.axles)),
        ),
        Part(
            "integrator of the path", "", Block.CUT, "sums the speed up to the path",
            law, takes=moved, gives=("cell", "S", "", "used", "status"), given=given,
            undrawn=("p", "B(S)", "cell", "used", "status"),
        ),
    )  # fmt: skip
