"""The retarder position as a unit: drive, pads, motion of a cut and radar, the constants that it is told once and for
all, the variables that are connected; of the position that tables were made for, of the configuration that they were
made of.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Final

import numpy as np

from plant_models import Cut, Plant, PlantError
from plant_models.cut import GRAVITY_M_S2, ROTATING_MASS_PER_AXLE_T
from plant_models.friction import MOST_CV
from plant_models.frozen_arrays import Floats
from plant_models.plant import SLOWEST_START_M_S
from plant_models.retarder import ForceLaw
from plant_models.rolling.random_numbers import Purpose
from plant_models.speed_sensor import MOST_MISSED, DopplerSensor
from plant_models.stage_regulator import resting_modes
from synth.frame.faults import InputError
from synth.retarder.configured import configuration_for
from synth.retarder.fmi.description import Interface
from synth.retarder.fmi.unit import Unit, c_part, compiler, platform
from synth.retarder.fmi.variables import Causality, Kind, Value, Variable, shown
from synth.retarder.forms.table_forms import Files
from synth.retarder.served_class import plant_for
from synth.simulation.closed_loop import SUBSTEP_S
from synth.simulation.path_and_drive import CELL_M
from synth.simulation.random_passes import BLOCK_PASSES, BURSTS_A_TURN, LOSSES, NOISE_SAMPLES, PATH_CELLS
from tuning_tables.document import AnyTable, StageTable
from tuning_tables.export_names import ExportPrefix, generated

Array = Sequence[float] | Sequence[Sequence[float]]


def position_data_h(plant: Plant, axle_room: int) -> str:
    """The text of position_data.h for cuts of `axle_room` axles at most; the cut of `plant` does not count.

    `PlantError` where the drive cannot be commanded at any moment.
    """
    arrays = dict(arrays_of(plant, axle_room))
    numbers = {**numbers_of(plant), **rooms_of(plant, axle_room), **chance_of(plant.sensor)}
    return "\n".join(
        [
            f"/* The constants of the position. {generated()} SI and kPa gauge. */",
            "#ifndef POSITION_DATA_H",
            "#define POSITION_DATA_H",
            "",
            *(f"#define {name} {number}" for name, number in numbers.items()),
            "",
            *(c_array(name, values) for name, values in arrays.items()),
            "",
            "#endif",
            "",
        ]
    )


def c_array(name: str, values: Array) -> str:
    """The definition of an array of numbers, or of pairs of them."""
    rows = [f"{{{', '.join(map(shown, row))}}}" if isinstance(row, Sequence) else shown(float(row)) for row in values]
    pairs = "[2]" if isinstance(values[0], Sequence) else ""
    return f"static const double {name}[{len(values)}]{pairs} = {{{', '.join(rows)}}};"


def arrays_of(plant: Plant, axle_room: int) -> Iterator[tuple[str, Array]]:
    """The arrays by name."""
    position, profile = plant.position, plant.profile
    modes = resting_modes(position, position.top_stage)
    resting = [next(kpa for stage, kpa in modes if stage == k) for k in range(position.top_stage + 1)]
    constant, of_load = slopes(position.force, axle_room)
    yield "ZONES_M", [list(map(float, zone)) for zone in position.zones_m]
    yield "GRADE_STARTS_M", profile.starts_m
    yield "GRADES_PERMILLE", profile.grades_permille
    yield "STAGE_KPA", position.stage_pressures_kpa
    yield "RESTING_KPA", [float(kpa) for kpa in resting]
    yield "SLOPE_KN_PER_KPA", constant.tolist()
    yield "SLOPE_KN_PER_KPA_PER_T", of_load.tolist()


def slopes(force: ForceLaw, axle_room: int) -> tuple[Floats, Floats]:
    """Slope of the pads for 1, 2, … braked axles, (n,): constant part, and part for each tonne of axle load.

    Force laws are constant or linear in the mass, as `brake_power` takes them. What the last entry holds, further axles
    have too.
    """
    light, heavy = (Cut("", load_t, (0.0,), 1) for load_t in (1.0, 2.0))
    axles = range(1, axle_room + 1)
    at_one, at_two = (np.array([force.slope_kn_per_kpa(cut, n) for n in axles]) for cut in (light, heavy))
    of_load = at_two - at_one
    changes = np.flatnonzero(np.diff(at_one))
    count = int(changes[-1]) + 2 if changes.size else 1
    return (at_one - of_load)[:count], of_load[:count]


def numbers_of(plant: Plant) -> Mapping[str, str]:
    """The numbers of drive, path and clock by name."""
    valves, sensor, start_m = plant.drive_at_any_time(), plant.sensor, plant.start_m
    found = {
        "SUPPLY_KPA": valves.supply_kpa,
        "EXHAUST_KPA": valves.exhaust_kpa,
        "BRAKE_DELAY_S": valves.brake_delay_s,
        "TOUCH_DELAY_S": valves.touch_delay_s,
        "RELEASE_DELAY_S": valves.release_delay_s,
        "FILL_S": valves.fill_s,
        "EXHAUST_S": valves.exhaust_s,
        "DEAD_BAND_KPA": valves.band_kpa,
        "TOUCH_KPA": valves.touch_kpa,
        "PERIOD_S": sensor.sample_period_s,
        "COMPUTING_DELAY_S": sensor.computing_delay_s,
        "START_M": start_m,
        "SLOWEST_START_M_S": SLOWEST_START_M_S,
        "GRAVITY_M_S2": GRAVITY_M_S2,
        "ROTATING_MASS_PER_AXLE_T": ROTATING_MASS_PER_AXLE_T,
        "CORRELATION_LENGTH_M": plant.friction.correlation_length_m,
        "CELL_M": min(CELL_M, plant.friction.correlation_length_m / 4.0),
    }
    return {name: f"({shown(float(number))})" for name, number in found.items()}


def rooms_of(plant: Plant, axle_room: int) -> Mapping[str, int]:
    """The lengths of arrays by name."""
    zones, grades = len(plant.position.zones_m), len(plant.profile.starts_m)
    breaks = (2 * zones + grades) * axle_room + 2
    return {
        "ZONES": zones,
        "GRADES": grades,
        "STAGES": plant.position.top_stage + 1,
        "SLOPES": len(slopes(plant.position.force, axle_room)[0]),
        "BREAK_ROOM": breaks,
        "PATH_CELLS": PATH_CELLS,
        "CELL_ROOM": PATH_CELLS + breaks,
        "PARTS": math.ceil(plant.sensor.sample_period_s / SUBSTEP_S),
    }


def chance_of(sensor: DopplerSensor) -> Mapping[str, str]:
    """What the random numbers of a pass depend on, as `random_passes` and `lost_readings` have it."""
    turns = max(1, math.ceil(BURSTS_A_TURN * sensor.missed_readings / NOISE_SAMPLES))
    first = np.random.SeedSequence(0, spawn_key=(int(Purpose.LOST_READING),)).generate_state(1, np.uint64)
    return {
        "BLOCK_PASSES": f"{BLOCK_PASSES}u",
        "NOISE_SAMPLES": str(NOISE_SAMPLES),
        "LOSS_STREAM": f"{LOSSES}u",
        "LOST_SAMPLES": str(turns * NOISE_SAMPLES),
        "LOST_FIRST_WORD": f"{int(first[0]):#x}u",
        "MISSED_READINGS": shown(max(1.0, float(sensor.missed_readings))),
    }


MEANING: Final = (
    "Retarder position with the cut in it: pneumatic drive with its delays, pads, motion, radar. One step is one "
    "sampling period; the stage of a step is commanded at its beginning, and the outputs are those of the next sample."
)

PARTS: Final = ("position.h", "position.c", "position_path.c", "position_drive.c", "position_chance.c")
LARGEST_INT32: Final = 2**31 - 1
LEAST_ROOM: Final = 64
"""Axles that a cut may have at least: some sixteen cars."""


def position_unit(plants: Sequence[Plant], prefix: ExportPrefix) -> Unit:
    """The unit of the position that all `plants` share; it begins with the cut of the first.

    `PlantError` where valves have a closing delay or commands wait longer than a sample, which is not modelled here.
    """
    first = plants[0]
    room = max(LEAST_ROOM, *(plant.cut.axles for plant in plants))
    return Unit(
        identifier=prefix.renamed("retarder_position"),
        name=f"{prefix.renamed('retarder_position')} {first.position.name}",
        meaning=MEANING,
        own=(*inputs(first), *cut_parameters(first, room), *chance_parameters(first), *OUTPUTS),
        c={
            **{name: c_part(name) for name in PARTS},
            "memory.h": c_part("position_memory.h"),
            "position_data.h": position_data_h(first, room),
        },
        period_s=first.sensor.sample_period_s,
    )


Limits = tuple[float, float]


def parameter(name: str, meaning: str, start: float, limits: Limits, unit: str | None = None) -> Variable:
    """A number that is given before a pass."""
    return Variable(name, Kind.FLOAT64, Causality.PARAMETER, meaning, (float(start),), unit, *limits)


def whole(name: str, meaning: str, start: int, limits: tuple[int, int]) -> Variable:
    """A whole number that is given before a pass."""
    return Variable(name, Kind.INT32, Causality.PARAMETER, meaning, (start,), None, *limits)


def inputs(plant: Plant) -> Iterator[Variable]:
    """What is commanded."""
    top = plant.position.top_stage
    start: tuple[Value, ...] = (plant.approach.initial_stage,)
    yield Variable("stage", Kind.INT32, Causality.INPUT, "commanded stage", start, low=0, high=top)


def cut_parameters(plant: Plant, room: int) -> Iterator[Variable]:
    """The cut, and how it comes."""
    cut, position = plant.cut, plant.position
    offsets = (*map(float, cut.axle_offsets_m), *(0.0,) * (room - cut.axles))
    yield parameter("mass_t", "mass of the cut", cut.mass_t, (1.0, 20_000.0), "t")
    yield whole("axles", "axles of the cut", cut.axles, (1, room))
    yield Variable("axle_offsets_m", Kind.FLOAT64, Causality.PARAMETER,
                   "distances of the axles behind the first, whose own is 0; beyond the last axle they do not count",
                   offsets, "m", 0.0, 2000.0)  # fmt: skip
    entry_m_s = float(plant.entry.speed_m_s(np.array([0.5]))[0])
    yield parameter("entry_speed_m_s", "speed at the entrance, with the brake released before it", entry_m_s,
                    (SLOWEST_START_M_S, position.max_entry_speed_m_s), "m/s")  # fmt: skip
    yield parameter("resistance_n_per_kn", "specific rolling resistance", plant.resistance.mean_n_per_kn, (0.0, 100.0),
                    "N/kN")  # fmt: skip
    yield whole("initial_stage", "stage in which the brake rests when the cut comes", plant.approach.initial_stage,
                (0, position.top_stage))  # fmt: skip


def chance_parameters(plant: Plant) -> Iterator[Variable]:
    """Friction and radar of a pass."""
    sensor = plant.sensor
    yield parameter("friction_factor", "friction of the pads on this cut; 1 is the mean of all cuts", 1.0, (0.0, 10.0))
    yield parameter("path_std", "standard deviation of the friction along the path; 0: the same everywhere",
                    plant.friction.path_std, (0.0, MOST_CV))  # fmt: skip
    yield parameter("noise_m_s", "standard deviation of a reading of the radar", sensor.noise_m_s, (0.0, 1.0), "m/s")
    yield parameter("resolution_m_s", "what readings are rounded to; 0: not rounded", sensor.resolution_m_s,
                    (0.0, 1.0), "m/s")  # fmt: skip
    yield parameter("missed_share", "share of readings that are lost", sensor.missed_share, (0.0, MOST_MISSED))
    yield parameter("first_sample_s", "time from the begin of the path to the first sample, which is time 0", 0.0,
                    (0.0, sensor.sample_period_s), "s")  # fmt: skip
    yield whole("seed", "of the random numbers, as in retarder-synth", 1, (0, LARGEST_INT32))
    yield whole("pass_number", "number of the pass in the row of this seed", 0, (0, LARGEST_INT32))


OUTPUTS: Final = (
    Variable("path_m", Kind.FLOAT64, Causality.OUTPUT,
             "path of the first axle from the entrance of the first retarder, negative before it", unit="m"),
    Variable("measured_m_s", Kind.FLOAT64, Causality.OUTPUT, "speed that the radar shows; -1 for a missing reading",
             unit="m/s"),
    Variable("mean_overpressure_kpa", Kind.FLOAT64, Causality.OUTPUT,
             "mean since the last sample of the pressure above that at which the pads touch", unit="kPa"),
    Variable("pressure_kpa", Kind.FLOAT64, Causality.OUTPUT, "pressure in the drive, gauge", unit="kPa"),
    Variable("at_rest", Kind.BOOLEAN, Causality.OUTPUT, "whether the pressure of the commanded stage is reached"),
    Variable("reached_stage", Kind.INT32, Causality.OUTPUT, "stage whose pressure is reached; -1 during a change"),
    Variable("speed_m_s", Kind.FLOAT64, Causality.OUTPUT, "true speed", unit="m/s"),
    Variable("end", Kind.INT32, Causality.OUTPUT, "0: the cut is inside, 1: its last axle has left, 2: it stands"),
    Variable("exit_speed_m_s", Kind.FLOAT64, Causality.OUTPUT, "speed when the last axle left; 0 before that",
             unit="m/s"),
    Variable("pass_s", Kind.FLOAT64, Causality.OUTPUT, "time from the begin of the path to the end of the pass",
             unit="s"),
)  # fmt: skip


def position_files(
    source: Path, tables: Sequence[AnyTable], interface: Interface, prefix: ExportPrefix, warn: Callable[[str], None]
) -> Files:
    """The unit of the position, by the name of its file; `warn` is told in a sentence what is missing, and why.

    `tables`: those at `source`, with lines or for point sensors.
    """
    if compiler() is None or platform() not in interface.folders:
        warn("warning: no library is made without a C compiler, or on this system: the units hold sources alone")
    try:
        plants = plants_of(source, [table for table in tables if isinstance(table, StageTable)])
        unit = position_unit(plants, prefix)
    except (InputError, PlantError) as fault:
        warn(f"warning: the position is not exported: {fault}")
        return {}
    return {f"{unit.identifier}.fmu": unit.archive(interface)}


def plants_of(source: Path, tables: Sequence[StageTable]) -> list[Plant]:
    """The plants of the configuration, that of the first table first; `InputError` unless the tables are made of it."""
    config, place = configuration_for(None, source, tables)
    if config.sha256 not in {table.generator.config_sha256 for table in tables}:
        raise InputError(
            f"{source}: {place} is not the configuration that the tables were made of; give the directory of a tune by "
            "this version"
        )
    first = plant_for(tables[0], config, place)[1]
    return [first, *(plant for _, plant in config.plants())]
