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


def pressure_hunting(plant: Plant) -> tuple[tuple[int, PressureCycle], ...]:
    """(stage, limit cycle) of every allowed stage around which the pressure regulator hunts."""
    air, touch = plant.position.pneumatics, plant.position.force.touch_pressure_kpa
    pressures = plant.position.stage_pressures_kpa[: plant.top_stage + 1]
    cycles = [(stage, pressure_limit_cycle(air, pressure, touch)) for stage, pressure in enumerate(pressures)]
    return tuple((stage, cycle) for stage, cycle in cycles if cycle is not None)
