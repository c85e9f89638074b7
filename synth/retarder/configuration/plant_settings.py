"""What a configuration file may say of the plant: position, retarders, surroundings, cuts and point sensors.

Only the keys that a file sets replace the library's values, so everything that the library knows is optional here.
Physical limits are the plant's own (`PlantError`).
"""

from __future__ import annotations

from typing import Final, Literal

from pydantic import Field

from plant_models.library import CARS, POSITIONS, RETARDERS, SENSORS, WHEEL_SENSORS
from synth.frame.settings.numbers import Grade, Numbers, Pairs
from synth.frame.settings.section import Section, choice, many, of_library, setting
from synth.retarder.configuration.own_types import named_type

DEFAULT_WHEEL_SENSOR: Final = "ds-2"


class PointSensorSettings(Section):
    """Point sensors; they stand in place of [sensor] and [regulator] approach_m."""

    type: str = named_type(DEFAULT_WHEEL_SENSOR, WHEEL_SENSORS, "type of the sensors")
    path_m: Numbers = Field(
        description="from the entrance of the first retarder to the middle of each sensor's base, rising, at least 0.3 "
        "m apart; the first at the entrance or ahead of it, and one behind the exit may log",
        json_schema_extra={"unit": "m", "source": "where you put them"},
    )
    decides_on: Literal["first_axle", "every_axle"] = choice("first_axle", "at whose passages the regulator decides")
    base_m: float | None = of_library("distance of the coils")
    base_tolerance: float | None = of_library("standard deviation of its relative error, lasting for each sensor")
    timer_noise_s: float | None = of_library("standard deviation of a measured time")
    timer_resolution_s: float | None = of_library("times are whole multiples of it; 0: not rounded")
    computing_delay_s: float | None = of_library("from the second pulse to the command on the wires")
    scan_period_s: float | None = of_library("step of the regulator's clock; changes of stage last whole steps")
    missed_share: float | None = of_library("share of the passages that a table counts as not heard")


DEFAULT_POSITION = "knp-5-bunch"


class ForceSettings(Section):
    """How hard the retarders brake; the key of the slope depends on the force law of their type."""

    slope_kn_per_kpa: float | None = of_library("braking force of a wheel pair per kPa above the touch pressure")
    slope_kn_per_kpa_per_t: float | None = of_library(
        "braking force of a wheel pair per kPa above the touch pressure and per t of axle load"
    )
    touch_pressure_kpa: float | None = of_library("pressure at which the pads begin to brake")
    slope_factor_by_axles: Numbers | None = of_library(
        "factors on the slope with 1, 2, … axles inside; the last one holds for more"
    )


class PneumaticsSettings(Section):
    """The pneumatic drive."""

    supply_pressure_kpa: float | None = of_library("pressure of the supply")
    exhaust_pressure_kpa: float | None = of_library("pressure that the released retarder comes to")
    brake_delay_s: float | None = of_library("delay of the supply valve")
    touch_delay_s: float | None = of_library("further dead time while the pads do not touch")
    release_delay_s: float | None = of_library("delay of the exhaust valve")
    fill_time_constant_s: float | None = of_library("time constant of filling")
    exhaust_time_constant_s: float | None = of_library("time constant of exhausting")
    dead_band_kpa: float | None = of_library("half dead band of the stage regulator")
    closing_delay_s: float | None = of_library(
        "for how long a valve stays open after the pressure has reached the band"
    )
    day_spread: float | None = of_library(
        "standard deviation of the logarithm of all delays and time constants from day to day"
    )


class PositionSettings(Section):
    """The position of the library: a site and what stands there."""

    name: str | None = named_type(None, POSITIONS, "the position")


class RetarderSettings(Section):
    """What is different of the retarders."""

    type: str | None = named_type(None, RETARDERS, "another type of retarders in this position")
    zones_m: Pairs | None = of_library("where each retarder begins and ends, from the entrance of the first")
    stage_pressures_kpa: Numbers | None = of_library("of the released stage, then of the braking stages")
    max_entry_speed_m_s: float | None = of_library("fastest at which cuts may enter")
    force: ForceSettings = ForceSettings()
    pneumatics: PneumaticsSettings = PneumaticsSettings()


class TrackSettings(Section):
    """The track through the position."""

    grade_permille: Grade | None = of_library(
        "one grade, or pieces, each (start in m, permille), as [[0.0, 8.0], [12.0, 5.0]]"
    )


class EntrySettings(Section):
    """Entry speeds: uniform between two limits, normal between them, or a histogram."""

    low_m_s: float | None = of_library("lowest speed at the entrance")
    high_m_s: float | None = of_library("highest speed at the entrance")
    mean_m_s: float | None = of_library("mean of the normal law between the two, with std_m_s", 5.75)
    std_m_s: float | None = of_library("its standard deviation", 0.5)
    edges_m_s: Numbers | None = of_library("in place of all these a histogram: ends of its bins", [5.0, 5.5, 6.0])
    shares: Numbers | None = of_library("of the cuts in each bin, which count by their ratio", [0.4, 0.6])


class FrictionSettings(Section):
    """The friction factor of a cut, 1 on average: kept through the pass, and varying along the path."""

    common_cv: float | None = of_library("coefficient of variation from cut to cut")
    axle_cv: float | None = of_library("the same of each braked axle for itself")
    path_std: float | None = of_library("standard deviation of what varies along the path")
    correlation_length_m: float | None = of_library("over which that is correlated")
    floor: float | None = of_library("least factor of a cut")
    mean_cv: float | None = of_library(
        "how far the mean itself may be off on a day, for which lines with an estimator keep a reserve"
    )


class SensorSettings(Section):
    """The Doppler radar of the position."""

    type: str | None = named_type(None, SENSORS, "another radar")
    noise_m_s: float | None = of_library("standard deviation of a reading")
    resolution_m_s: float | None = of_library("readings are whole multiples of it; 0: not quantised")
    sample_period_s: float | None = of_library("time from reading to reading")
    computing_delay_s: float | None = of_library("from the reading to the command on the wires")
    missed_share: float | None = of_library("share of the readings that are lost")
    missed_burst_s: float | None = of_library("for how long they are lost at a time on average")


class TargetSettings(Section):
    """Commanded exit speeds; every cut class is tuned for each."""

    exit_speeds_m_s: Numbers | None = of_library("commanded exit speeds")


class RollingResistanceSettings(Section):
    """Replaces values of the weight category."""

    mean_n_per_kn: float | None = of_library("mean running resistance")
    std_n_per_kn: float | None = of_library("its standard deviation")


class CarsSettings(Section):
    """Some equal cars within a mixed cut; `mass_per_car_t` where the cut has no mass_t for all of them together."""

    car: str = Field(description="their type")
    cars: int = setting(1, "1", 1, 60, "number of such cars coupled")
    mass_per_car_t: float | None = of_library("mass of each, where the cut has no mass_t")


class CutSettings(Section):
    """A cut class: equal cars of one type, or a consist of several; tables are made for each.

    From the mass per axle follow category, stages and resistance; remove the leading # to change one.
    """

    label: str | None = Field(
        None, pattern=r"^[A-Za-z0-9][A-Za-z0-9._-]{0,60}$", description="name of the class, by default of cars and mass"
    )
    car: str | None = named_type(None, CARS, "type of the cars")
    cars: int = setting(1, "1", 1, 60, "number of such cars coupled")
    consist: tuple[CarsSettings, ...] | None = many(
        None,
        1,
        60,
        "tables {car = …, cars = …, mass_per_car_t = …}",
        'cars of several types in place of car and cars: [{ car = "gondola-4", cars = 2 }, { car = "tank-8" }]',
    )
    mass_t: float | None = of_library("mass of the whole cut")
    category: str | None = of_library("weight category, by its name or its Latin one")
    allowed_stage: int | None = of_library("highest stage that it may be given")
    entrance_stage: int | None = of_library("the same while its first axle is before the entrance")
    rolling_resistance: RollingResistanceSettings = choice(RollingResistanceSettings(), "running resistance")
    targets_m_s: Numbers | None = of_library("exit speeds of this class alone, as [3.0]")
    entry: EntrySettings = choice(
        EntrySettings(), "entry speeds of this class alone, as { low_m_s = 5.0, high_m_s = 6.0 }"
    )


DEFAULT_CUTS = tuple(CutSettings(car="gondola-4", mass_t=mass_t) for mass_t in (22.0, 36.0, 52.0, 66.0, 85.0))
"""One gondola for each weight category."""
