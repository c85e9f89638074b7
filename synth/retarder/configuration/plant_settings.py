"""What a configuration file may say of the plant: position, retarders, surroundings and cuts.

Only the keys that a file sets replace the library's values, so everything that the library knows is optional here.
Physical limits are the plant's own (`PlantError`).
"""

from __future__ import annotations

from pydantic import Field

from synth.frame.settings.section import Section, many
from synth.frame.settings.value_forms import Grade, Numbers, Pairs

DEFAULT_POSITION = "knp-5-bunch"


class ForceSettings(Section):
    """Replaces values of the library's force law; the slope's key depends on the law."""

    slope_kn_per_kpa: float | None = None
    slope_kn_per_kpa_per_t: float | None = None
    touch_pressure_kpa: float | None = None
    slope_factor_by_axles: Numbers | None = None


class PneumaticsSettings(Section):
    """Replaces values of the library's pneumatics."""

    supply_pressure_kpa: float | None = None
    exhaust_pressure_kpa: float | None = None
    brake_delay_s: float | None = None
    touch_delay_s: float | None = None
    release_delay_s: float | None = None
    fill_time_constant_s: float | None = None
    exhaust_time_constant_s: float | None = None
    dead_band_kpa: float | None = None
    closing_delay_s: float | None = None
    day_spread: float | None = None


class PositionSettings(Section):
    """The position of the library: a site and what stands there."""

    name: str | None = None


class RetarderSettings(Section):
    """What is different of the retarders; `name` is an older spelling of position.name, `type` another type there."""

    name: str | None = None
    type: str | None = None
    zones_m: Pairs | None = None
    stage_pressures_kpa: Numbers | None = None
    max_entry_speed_m_s: float | None = None
    force: ForceSettings = ForceSettings()
    pneumatics: PneumaticsSettings = PneumaticsSettings()


class TrackSettings(Section):
    """One grade, or pairs (start in m, grade in permille); downhill positive."""

    grade_permille: Grade | None = None


class EntrySettings(Section):
    """Entry speeds: uniform between two limits, normal between them, or a histogram."""

    low_m_s: float | None = None
    high_m_s: float | None = None
    mean_m_s: float | None = None
    std_m_s: float | None = None
    edges_m_s: Numbers | None = None
    shares: Numbers | None = None


class FrictionSettings(Section):
    """Replaces values of the library's friction model."""

    common_cv: float | None = None
    axle_cv: float | None = None
    path_std: float | None = None
    correlation_length_m: float | None = None
    floor: float | None = None
    mean_cv: float | None = None


class SensorSettings(Section):
    """Replaces values of the position's Doppler sensor; `type` another sensor of the library."""

    type: str | None = None
    noise_m_s: float | None = None
    resolution_m_s: float | None = None
    sample_period_s: float | None = None
    computing_delay_s: float | None = None
    missed_share: float | None = None
    missed_burst_s: float | None = None


class TargetSettings(Section):
    """Commanded exit speeds; every cut class is tuned for each."""

    exit_speeds_m_s: Numbers | None = None


class RollingResistanceSettings(Section):
    """Replaces values of the weight category."""

    mean_n_per_kn: float | None = None
    std_n_per_kn: float | None = None


class CarsSettings(Section):
    """Some equal cars within a mixed cut; `mass_per_car_t` where the cut has no mass_t for all of them together."""

    car: str
    cars: int = Field(1, ge=1, le=60)
    mass_per_car_t: float | None = None


class CutSettings(Section):
    """A cut class: `cars` equal cars of the library that together weigh `mass_t`, or a `consist` of several types."""

    label: str | None = Field(None, pattern=r"^[A-Za-z0-9][A-Za-z0-9._-]{0,60}$")
    car: str | None = None
    cars: int = Field(1, ge=1, le=60)
    consist: tuple[CarsSettings, ...] | None = many(None, 1, 60, "tables {car = …, cars = …, mass_per_car_t = …}")
    mass_t: float | None = None
    category: str | None = None
    allowed_stage: int | None = None
    entrance_stage: int | None = None
    rolling_resistance: RollingResistanceSettings = RollingResistanceSettings()
    targets_m_s: Numbers | None = None
    entry: EntrySettings = EntrySettings()


DEFAULT_CUTS = tuple(CutSettings(car="gondola-4", mass_t=mass_t) for mass_t in (22.0, 36.0, 52.0, 66.0, 85.0))
"""One gondola for each weight category."""
