"""How finely the state space of a problem is quantised: for measured speeds, for estimated ones, and at any time.

An estimate has a smaller error than a measured speed, and so takes a finer grid.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

from plant_models import DopplerSensor, Plant
from plant_models.errors import require, require_between

CHECK_FRICTION_NODES = 13
"""Equally spaced nodes of ξ_cut from −4 to 4 standard deviations, for the prediction of a finished table."""


LEAST_SPEED_STEP_M_S = 1e-3

LONG_PASS_M = 60.0
"""A longer pass has as many quanta of path as one of this length: long cuts brake slowly. With quanta of 1 m instead of
0.5 the predicted rms of cuts of 70 to 165 m changes by at most 4 %, and a design takes a third of the time."""


@dataclass(frozen=True)
class Resolution:
    """How fine the state space is cut.

    Parameters
    ----------
    path_step_m
        ΔS, m, rounded so that whole quanta fill S_exit.
    speed_step_m_s
        ΔV at the reference speed, m/s; the grid is uniform in e = v²/2, so ΔV(v) = Δe/v.
    reference_speed_m_s
        Where ΔV holds, m/s.
    transient_substeps
        Parts of a sampling period in which a transient is integrated.
    friction_nodes
        Scenarios of ξ_cut.
    path_levels
        Levels of the Markov chain for η.
    resistance_nodes
        Scenarios of w.

    Raises
    ------
    PlantError
        A number out of range.

    Examples
    --------
    >>> import synth
    >>> synth.Resolution(path_step_m=1.0, speed_step_m_s=0.05).path_step_m
    1.0
    """

    path_step_m: float = 0.5
    speed_step_m_s: float = 0.03
    reference_speed_m_s: float = 3.0
    transient_substeps: int = 2
    friction_nodes: int = 6
    path_levels: int = 2
    resistance_nodes: int = 3

    def __post_init__(self) -> None:
        require_between("grid: path_step_m", self.path_step_m, 0.01, 5.0)
        require_between("grid: speed_step_m_s", self.speed_step_m_s, LEAST_SPEED_STEP_M_S, 0.5)
        require_between("grid: reference_speed_m_s", self.reference_speed_m_s, 0.3, 20.0)
        for name in ("transient_substeps", "friction_nodes", "path_levels", "resistance_nodes"):
            value = getattr(self, name)
            require(1 <= value <= 64, f"grid: {name} is {value}; it must be a whole number from 1 to 64")

    def for_pass(self, length_m: float) -> Resolution:
        """The same for a pass of this length, from where the regulator acts to S_exit; see `LONG_PASS_M`."""
        return replace(self, path_step_m=self.path_step_m * max(1.0, length_m / LONG_PASS_M))


def finer_for_check(resolution: Resolution) -> Resolution:
    """The resolution at which a table solved on `resolution` is predicted: half of both steps, more scenarios.

    Two levels of path noise suffice: they carry its variance and correlation exactly, and five change no
    predicted rms by more than 1e-5 m/s (docs/explanation/method-validation.md).
    """
    return replace(
        resolution,
        path_step_m=0.5 * resolution.path_step_m,
        speed_step_m_s=0.5 * resolution.speed_step_m_s,
        friction_nodes=CHECK_FRICTION_NODES,
        path_levels=2,
        resistance_nodes=3,
    )


ERROR_SHARE = 0.45
"""The error of the estimate, as a share of that of the measured speed: 0.41 to 0.45 in the default book."""

LEAST_ERROR_M_S = 0.01
"""Lines are designed for no smaller error, which would need too fine a grid: they are a little too far apart then."""

ESTIMATOR_FRICTION_NODES = 4
"""Scenarios of friction of a design for estimated speeds; an odd number with that for any day, so that one is the mean
friction: with six in all, six of 145 random cuts had 1.02 to 1.08 of the rms without estimator. With seven the rms
scatters about the same one. Scenarios of resistance are not saved: with two instead of three, lines for long slow
cuts run between them, with 10 to 20 % more rms in the park."""

ESTIMATOR_STEP_SHARE = 1.0
"""Largest speed step of the grid, in standard deviations of the error. With 0.65 the mean rms is 1 % more. With 1.3 a
tune takes a tenth less, but the cubic interpolation leaves negative probabilities, and some polishes descend into
them: three of 223 random cuts had 1.06 to 1.16 of the rms without estimator."""


def design_error_m_s(sensor: DopplerSensor) -> float:
    """Standard deviation of the estimated speed that lines are designed for, m/s."""
    return max(ERROR_SHARE * sensor.reading_std_m_s, LEAST_ERROR_M_S)


def estimator_resolution(resolution: Resolution, sensor: DopplerSensor, lowest_target_m_s: float) -> Resolution:
    """`resolution` with a speed step for the error of the estimate, and fewer scenarios, for all targets of a plant."""
    # The step is that at the reference speed; below it cells are wider.
    wider = max(1.0, resolution.reference_speed_m_s / lowest_target_m_s)
    step = max(ESTIMATOR_STEP_SHARE * design_error_m_s(sensor) / wider, LEAST_SPEED_STEP_M_S)
    return replace(
        resolution,
        speed_step_m_s=min(resolution.speed_step_m_s, step),
        friction_nodes=ESTIMATOR_FRICTION_NODES,
    )


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


WIDEST_CELL, ADVISED_CELL = 1.0, 0.6
"""Width of a speed cell at the target in standard deviations of the measured speed. From one on, the polish can find
lines that are good on the grid alone: 36 t to 1.5 m/s at CV 0.05, predicted 0.66 of the simulated rms."""


def grid_warnings(resolution: Resolution, sensor: DopplerSensor, targets_m_s: tuple[float, ...]) -> Iterator[str]:
    """A sentence if the cells at the lowest target are too wide; they are even in v²/2, so widest there."""
    lowest = min(targets_m_s)
    std = sensor.reading_std_m_s
    cell = resolution.speed_step_m_s * resolution.reference_speed_m_s / lowest
    if not sensor.exact and cell > WIDEST_CELL * std:
        advised = ADVISED_CELL * std * lowest / resolution.reference_speed_m_s
        yield (
            f"grid.speed_step_m_s is {resolution.speed_step_m_s:g}, which makes cells of {cell:.3f} m/s at the target "
            f"{lowest:g} m/s, wider than the measured speed is uncertain ({std:.3f} m/s): tables for low targets may "
            f"be worse than predicted; {advised:.2g} or less is better"
        )
