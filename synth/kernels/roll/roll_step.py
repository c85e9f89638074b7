"""One step of a roll in the energy e = v²/2, sixteen cuts side by side (method: docs/explanation/rolling.md).

What the track gives, and what does not depend on the speed, enters by exact differences along a step. Means of v and v²
are those of an energy that is linear along the step, and to first order of what the track adds to that; so the root of
the energy may even end at 0.
"""

from __future__ import annotations

from synth.kernels.compiling import part_inline
from synth.kernels.vector import packs

SHORT_M = 0.3
"""A step near e = 0 need not be shorter than this."""

REST_M, FINE_M = 0.1, 0.02
"""Steps backwards of a cut that would arrive too fast from rest, and the step in which it no longer does."""

REACH_S2_PER_M = 43.0
"""Longest step over the energy: a change of grade by 10 permille within the step takes less than all of it, so no cut
stops between the two ends of a step unnoticed. The step is SHORT_M where that is more."""

NO_SPEED_M_S = 1e-12
"""Keeps quotients of speeds finite."""


@part_inline
def lost_head(lanes, linear, h, mean_v, mean_v2):
    """Head that air, and resistance linear in the speed, take on `h` metres, from the means of v and v² over them."""
    w = lanes.wind_m_s
    against = mean_v2 + w * (mean_v + mean_v + w)
    against = packs.choose(mean_v + w < 0.0, against * -1.0, against)
    return h * (linear * mean_v + lanes.air * against)


@part_inline
def stepped(lanes, linear, h, steady, more, bend_v2, early_v2, e, v):
    """Energy at the other end of `h` metres on which the head `steady` is won, from energy `e` and speed `v` at this
    end; negative where the cut does not get there. Backwards `h` is negative, and so are the heads that are lost.

    `more`: by how much the mean head on the way is above that of an even gain between both ends; `early_v2`: likewise
    of the heads `bend_v2` that bends take per (m/s)². Both are the same forwards and backwards. Returned, too: the
    energy that belongs to `more`.
    """
    g, v2 = lanes.gravity_m_s2, v * v
    there = packs.greatest(e + g * (steady - lost_head(lanes, linear, h, v, v2) - bend_v2 * v2), 0.0)
    both, half = v + packs.root(there + there) + NO_SPEED_M_S, 0.5 * (e + there)
    more_e = packs.least(packs.greatest(g * (more - 2.0 * early_v2 * half), half * -1.0), half)
    part = 1.0 / both
    mean_v = (2.0 / 3.0) * v + ((4.0 / 3.0) * there + 2.0 * more_e) * part
    mean_v2 = e + there + 2.0 * more_e
    in_bends = bend_v2 * mean_v2 - 2.0 * early_v2 * (there - e)
    later = e + g * (steady - lost_head(lanes, linear, h, mean_v, mean_v2) - in_bends)
    change = packs.greatest(later, 0.0) - there
    mean_v = mean_v + (2.0 / 3.0) * (both + v) * part * part * change
    in_bends = in_bends + (bend_v2 - 2.0 * early_v2) * change
    return e + g * (steady - lost_head(lanes, linear, h, mean_v, mean_v2 + change) - in_bends), more_e


@part_inline
def next_step(longest, left, limit, e):
    """How far lanes go at the energy `e`; `left`: to the station."""
    near = packs.choose(e == 0.0, REST_M, packs.greatest(e * REACH_S2_PER_M, SHORT_M))
    return packs.least(packs.least(longest, near), packs.least(left, limit))


@part_inline
def even_steps(gap, step_m):
    """Length of the steps into which `gap` is divided, `step_m` at most."""
    return gap / packs.fraction(packs.whole(packs.greatest(gap * (1.0 / step_m) + (1.0 - 1e-9), 1.0)))
