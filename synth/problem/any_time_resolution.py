"""The grid to design surfaces for commands at any time on."""

from __future__ import annotations

from plant_models import Plant
from plant_models.errors import require
from synth.problem.resolution import LEAST_SPEED_STEP_M_S, Resolution

SPEED_STEP_M_S = 0.02
"""At the target speed, at most."""

SURFACE_STEP_SHARE = 0.45
"""Largest speed step, in standard deviations of the speed that the regulator knows. With 0.7 the polish found surfaces
that cost next to nothing on the grid; in 20 000 passes of 66 t to 4 m/s and 52 t to 3 m/s their rms was 1.4 and 1.9
times that of surfaces found with 0.45."""

SURFACE_FRICTION_NODES = 5
"""Six and eight give the same within 1 % in the mean over six cases of the default book, four half a per cent more."""

LARGE_SPREAD_M_S = 0.08
"""Where the spread of the running resistance moves the exit speed by more, a design takes two values of it. With one,
surfaces for 22 t to 2 m/s (0.11 m/s) came out a quarter worse; for 66 t to 3 m/s (0.05) they did not change."""


def design_resolution(
    plant: Plant, target_m_s: float, coarser: float = 1.0, error_m_s: float | None = None
) -> Resolution:
    """The grid on which surfaces for a target are designed: two quanta of path a period at the target speed.

    `coarser`: times both steps; `error_m_s`: standard deviation of the speed that the regulator knows, by default that
    of the sensor's readings. Halving all steps changes predicted rms by at most 2 % (tests). Raises `PlantError` where
    the error is too small for a grid.
    """
    path_step_m = 0.5 * coarser * plant.sensor.sample_period_s * target_m_s
    braked = plant.cut.reduced_gravity_m_s2 * 1e-3 * plant.resistance.std_n_per_kn * plant.exit_m
    resistances = 2 if braked / target_m_s > LARGE_SPREAD_M_S else 1
    step = SURFACE_STEP_SHARE * (plant.sensor.reading_std_m_s if error_m_s is None else error_m_s)
    require(
        step >= LEAST_SPEED_STEP_M_S,
        f"sensor: noise_m_s is {plant.sensor.noise_m_s:g} and resolution_m_s is {plant.sensor.resolution_m_s:g}; "
        'regulator.commands = "any_time" would need too fine a grid for so small an error: set the noise that the '
        'sensor has, or commands = "at_rest"',
    )
    return Resolution(
        path_step_m,
        coarser * min(SPEED_STEP_M_S, step),
        target_m_s,
        friction_nodes=SURFACE_FRICTION_NODES,
        resistance_nodes=resistances,
    )
