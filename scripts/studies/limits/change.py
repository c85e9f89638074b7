"""Plants that lack one source of error or of delay each."""

from __future__ import annotations

from dataclasses import dataclass, replace

from plant_models import Plant

QUIET_M_S, STEP_SHARE = 0.02, 0.65
"""Noise of the quiet sensor, and how much of it the speed grid's step may be."""

FREE_DEGREE = 9
FASTER = 4.0
NO_SPREAD_CV = 0.01


@dataclass(frozen=True)
class Change:
    """A plant that lacks one source; `degree` of its lines; the speed step that a quieter sensor needs."""

    name: str
    plant: Plant
    degree: int
    speed_step_m_s: float | None = None


def changes(plant: Plant, degree: int) -> tuple[Change, ...]:
    """What is switched off or changed, one at a time, the plant as it is first."""
    sensor, drive = plant.sensor, plant.position.pneumatics
    names = ("brake_delay_s", "touch_delay_s", "release_delay_s", "fill_time_constant_s", "exhaust_time_constant_s")
    fast = replace(drive, **{name: getattr(drive, name) / FASTER for name in names})
    even = replace(plant.friction, common_cv=NO_SPREAD_CV)
    smooth = replace(plant.friction, path_std=0.0)
    quiet = replace(sensor, noise_m_s=QUIET_M_S, resolution_m_s=0.0)
    often = replace(sensor, sample_period_s=sensor.sample_period_s / 2)
    prompt = replace(sensor, computing_delay_s=0.0)
    rolling = replace(plant.resistance, std_n_per_kn=0.0)
    return (
        Change("as it is", plant, degree),
        Change(f"lines of degree {FREE_DEGREE}", plant, FREE_DEGREE),
        Change("no spread of friction between cuts", replace(plant, friction=even), degree),
        Change("no friction noise along the path", replace(plant, friction=smooth), degree),
        Change("no spread of rolling resistance", replace(plant, resistance=rolling), degree),
        Change("sampled twice as often", replace(plant, sensor=often), degree),
        Change("no computing delay", replace(plant, sensor=prompt), degree),
        Change(f"measured speed with {QUIET_M_S:g} m/s of noise", replace(plant, sensor=quiet), degree,
               STEP_SHARE * QUIET_M_S),
        Change("valves four times as fast", replace(plant, position=replace(plant.position, pneumatics=fast)), degree),
    )  # fmt: skip
