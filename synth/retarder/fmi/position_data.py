"""The constants of a position as C: what its unit is told once and for all."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from plant_models import Cut, Plant
from plant_models.cut import GRAVITY_M_S2, ROTATING_MASS_PER_AXLE_T
from plant_models.frozen_arrays import Floats
from plant_models.plant import SLOWEST_START_M_S
from plant_models.retarder import ForceLaw
from plant_models.rolling.random_numbers import Purpose
from plant_models.speed_sensor import DopplerSensor
from plant_models.stage_regulator import resting_modes
from synth.retarder.fmi.variables import shown
from synth.simulation.closed_loop import SUBSTEP_S
from synth.simulation.lost_readings import BURSTS_A_TURN
from synth.simulation.path_cells import CELL_M
from synth.simulation.random_passes import BLOCK_PASSES, LOSSES, NOISE_SAMPLES, PATH_CELLS
from tuning_tables.exporter import generated

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
