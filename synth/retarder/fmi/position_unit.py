"""The retarder position as a unit: drive, pads, motion of a cut and radar, and the variables that are connected."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Final

import numpy as np

from plant_models import Plant
from plant_models.friction import MOST_CV
from plant_models.plant import SLOWEST_START_M_S
from plant_models.speed_sensor import MOST_MISSED
from synth.retarder.fmi.position_data import position_data_h
from synth.retarder.fmi.unit import Unit, c_part
from synth.retarder.fmi.variables import Causality, Kind, Value, Variable
from tuning_tables.export_prefix import ExportPrefix

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
