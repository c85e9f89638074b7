"""Predicted limit cycles of the stage pressure regulator: a relay with dead zone and delays around an integrator."""

from __future__ import annotations

import math
from dataclasses import dataclass

from plant_models import Plant, Pneumatics


@dataclass(frozen=True)
class PressureCycle:
    """A stage pressure regulator that hunts: pressure between `bottom_kpa` and `top_kpa` with `period_s`."""

    bottom_kpa: float
    top_kpa: float
    period_s: float


def pressure_limit_cycle(air: Pneumatics, target_kpa: float, touch_kpa: float) -> PressureCycle | None:
    """Limit cycle of the relay around `target_kpa`, or None if the pressure comes to rest. Exact.

    A valve shuts `closing_delay_s` after the pressure has reached the near edge of the dead band; it hunts
    if both overshoots cross the whole band, roughly closing delay · rate > 2ε. Opening delays lengthen the
    period but do not decide: the pressure rests while a valve has not yet opened.
    """
    low, high = target_kpa - air.dead_band_kpa, target_kpa + air.dead_band_kpa
    supply, exhaust, closing = air.supply_pressure_kpa, air.exhaust_pressure_kpa, air.closing_delay_s
    top = supply - (supply - low) * math.exp(-closing / air.fill_time_constant_s)
    bottom = exhaust + (high - exhaust) * math.exp(-closing / air.exhaust_time_constant_s)
    if top <= high or bottom >= low:
        return None
    exhausting = air.exhaust_time_constant_s * math.log((top - exhaust) / (bottom - exhaust))
    filling = air.fill_time_constant_s * math.log((supply - bottom) / (supply - top))
    opening = air.release_delay_s + air.brake_delay_s + (air.touch_delay_s if bottom <= touch_kpa else 0.0)
    return PressureCycle(bottom, top, exhausting + filling + opening)


def harmonic_pressure_cycle(air: Pneumatics, target_kpa: float) -> PressureCycle | None:
    """The same by the describing function of a relay with dead zone, N(A) = 4r/(πA)·sqrt(1 − (ε/A)²).

    Loop: relay ±r outside ±ε, dead time τ = closing delay, integrator; r is the geometric mean of filling
    and exhausting rate. The phase gives ω = π/2τ, and an amplitude exists if rτ > π²ε/4 ≈ 2.47ε: stricter
    than the exact 2ε. Opening delays, during which the pressure rests, are added to the period.
    """
    filling = (air.supply_pressure_kpa - target_kpa) / air.fill_time_constant_s
    exhausting = (target_kpa - air.exhaust_pressure_kpa) / air.exhaust_time_constant_s
    reach = 8.0 * math.sqrt(max(0.0, filling * exhausting)) * air.closing_delay_s / math.pi**2
    if reach <= 2.0 * air.dead_band_kpa:
        return None
    amplitude = math.sqrt(0.5 * reach * (reach + math.sqrt(reach**2 - 4.0 * air.dead_band_kpa**2)))
    period = 4.0 * air.closing_delay_s + air.brake_delay_s + air.release_delay_s
    return PressureCycle(target_kpa - amplitude, target_kpa + amplitude, period)


def pressure_hunting(plant: Plant) -> tuple[tuple[int, PressureCycle], ...]:
    """(stage, limit cycle) of every allowed stage around which the pressure regulator hunts."""
    air, touch = plant.position.pneumatics, plant.position.force.touch_pressure_kpa
    pressures = plant.position.stage_pressures_kpa[: plant.top_stage + 1]
    cycles = [(stage, pressure_limit_cycle(air, pressure, touch)) for stage, pressure in enumerate(pressures)]
    return tuple((stage, cycle) for stage, cycle in cycles if cycle is not None)
