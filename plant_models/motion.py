"""Motion of a cut through a retarder position, reduced to coefficients per path cell.

With e = v²/2 the equation of motion reads, per metre of path,
de/ds = g'(i(s) − w)·1e-3 − ξ(s)·β(s)·p, where p = max(0, P − P0) and
β(s) = Σ over braked axles of K·c(N)/(Q + 0.42 n). Everything the solver and the simulator need of
a cut and a position is i and β, exactly averaged over path cells.
"""

from __future__ import annotations

import numpy as np

from plant_models.cut import Cut
from plant_models.frozen_arrays import Floats, Ints, frozen_arrays
from plant_models.retarder import RetarderPosition
from plant_models.track_profile import TrackProfile


@frozen_arrays
class PathCoefficients:
    """What of a cut and a position acts on the motion, as means over n cells of the path of the first axle.

    Parameters
    ----------
    edges_m
        Edges of the cells, m, (n + 1,).
    gravity_m_s2
        g'·i·1e-3, m/s², (n,).
    brake_m_s2_per_kpa
        β, deceleration by one kPa above the touch pressure, m/s² per kPa, (n,).
    resistance_m_s2_per_n_kn
        g'·1e-3, deceleration by one N/kN of specific resistance, m/s² per N/kN.

    Examples
    --------
    See `path_coefficients`.
    """

    edges_m: Floats
    gravity_m_s2: Floats
    brake_m_s2_per_kpa: Floats
    resistance_m_s2_per_n_kn: float

    def free_m_s2(self, resistance_n_per_kn: float) -> Floats:
        """Acceleration of a cut with the brake released.

        Parameters
        ----------
        resistance_n_per_kn
            Its specific resistance, N/kN.

        Returns
        -------
        ndarray
            m/s², (n,).
        """
        return self.gravity_m_s2 - self.resistance_m_s2_per_n_kn * resistance_n_per_kn


def braked_axles(position: RetarderPosition, cut: Cut, s_m: Floats) -> Ints:
    """N(s): wheel pairs inside any retarder of the position when the first axle stands at `s_m`."""
    axle = np.asarray(s_m)[..., None] - np.asarray(cut.axle_offsets_m)
    inside = np.zeros(axle.shape, dtype=bool)
    for start, end in position.zones_m:
        inside |= (axle >= start) & (axle < end)
    count: Ints = inside.sum(axis=-1)
    return count


def path_breaks_m(position: RetarderPosition, cut: Cut, profile: TrackProfile, start_m: float = 0.0) -> Floats:
    """Sorted positions in [`start_m`, S_exit], both included, where N(s) or the grade under an axle changes."""
    offsets = np.asarray(cut.axle_offsets_m)
    marks = [edge for zone in position.zones_m for edge in zone] + list(profile.starts_m)
    breaks = (np.asarray(marks)[:, None] + offsets).ravel()
    exit_m = position.exit_m(cut)
    inner = breaks[(breaks > start_m + 1e-9) & (breaks < exit_m - 1e-9)]
    return np.unique(np.concatenate([[start_m], np.round(inner, 9), [exit_m]]))


def path_coefficients(position: RetarderPosition, cut: Cut, profile: TrackProfile, edges_m: Floats) -> PathCoefficients:
    """Reduce the motion of a cut through a position to means over cells of the path.

    Parameters
    ----------
    position
        The retarders.
    cut
        The cut.
    profile
        The track.
    edges_m
        Edges of n cells, rising, path of the first axle, m, (n + 1,).

    Returns
    -------
    PathCoefficients
        Exact means of gravity and of the brake coefficient, (n,).

    Notes
    -----
    With e = v²/2 per metre of path: de/ds = g'(i - w)·1e-3 - ξ·β·p, where p = max(0, P - P0).

    Examples
    --------
    >>> import numpy as np
    >>> from plant_models import Cut, path_coefficients
    >>> from plant_models.library import load_position
    >>> at = load_position("knp-5-bunch")
    >>> cut = Cut("С", mass_t=52.0, axle_offsets_m=(0.0, 1.85, 8.65, 10.5), allowed_stage=3)
    >>> cells = path_coefficients(at.position, cut, at.profile, np.array([0.0, 1.0, 20.0]))
    >>> (
    ...     cells.brake_m_s2_per_kpa.shape,
    ...     bool(cells.brake_m_s2_per_kpa[1] > cells.brake_m_s2_per_kpa[0]),
    ... )
    ((2,), True)
    """
    fine = np.unique(np.concatenate([path_breaks_m(position, cut, profile, min(0.0, float(edges_m[0]))), edges_m]))
    middle = 0.5 * (fine[1:] + fine[:-1])
    axles = braked_axles(position, cut, middle)
    slope = np.array([0.0] + [n * position.force.slope_kn_per_kpa(cut, n) for n in range(1, cut.axles + 1)])
    grade = profile.grade_permille(middle[:, None] - np.asarray(cut.axle_offsets_m)).mean(axis=1)
    gravity = cut.reduced_gravity_m_s2 * 1e-3 * grade
    return PathCoefficients(
        edges_m=np.array(edges_m, dtype=np.float64),
        gravity_m_s2=cell_means(fine, gravity, edges_m),
        brake_m_s2_per_kpa=cell_means(fine, slope[axles] / cut.inertia_t, edges_m),
        resistance_m_s2_per_n_kn=cut.reduced_gravity_m_s2 * 1e-3,
    )


def mean_braked_axles(position: RetarderPosition, cut: Cut) -> float:
    """N̄: mean number of braked wheel pairs over the part of the path where any is braked."""
    edges = path_breaks_m(position, cut, TrackProfile.uniform(0.0))
    axles = braked_axles(position, cut, 0.5 * (edges[1:] + edges[:-1]))
    length = np.diff(edges)
    return float((axles * length).sum() / length[axles > 0].sum())


def cell_means(fine_edges: Floats, values: Floats, edges: Floats) -> Floats:
    """Means over coarse cells of a function constant between `fine_edges` (a refinement of `edges`)."""
    integral = np.concatenate([[0.0], np.cumsum(values * np.diff(fine_edges))])
    means: Floats = np.diff(np.interp(edges, fine_edges, integral)) / np.diff(edges)
    return means
