"""How finely the state space of a problem is quantised."""

from __future__ import annotations

from dataclasses import dataclass, replace

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
