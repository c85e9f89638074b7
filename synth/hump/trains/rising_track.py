"""Whether cuts can come over the track behind the crest at all: a rise there is mostly a grade of the wrong sign."""

from __future__ import annotations

import numpy as np

from plant_models.cut import GRAVITY_M_S2
from plant_models.errors import require
from synth.hump.configuration.settings import HumpTrialSettings
from synth.hump.trains.hump_routes import HumpRoutes

SPARE = 2.0
"""Cuts come up so many times what their speed is worth at most: wheels turn, long cuts are pushed on, wind helps."""


def require_falling(routes: HumpRoutes, settings: HumpTrialSettings) -> None:
    """`PlantError` where the track up to the last element of a route rises so far above the crest that a cut pushed at
    the highest hump speed of `settings` stands before it gets there."""
    speed = settings.hump_speed
    fastest_m_s = speed.constant_m_s or min(speed.highest_m_s, speed.uncoupling_m_s)
    comes_up_m = 0.5 * fastest_m_s**2 / GRAVITY_M_S2
    for route, ends_m in zip(routes.routes, routes.ends_m, strict=True):
        places = np.minimum(route.roll_track.breaks_m, ends_m)
        rises = -route.roll_track.fall_m(places)
        worst = int(np.argmax(rises))
        require(
            rises[worst] <= SPARE * comes_up_m,
            f"hump: on the way to track {routes.graph.track_called(route.track)}, {places[worst]:g} m behind the "
            f"crest, the track lies {rises[worst]:.2f} m above the crest; at {fastest_m_s:g} m/s cuts come up "
            f"{comes_up_m:.2f} m, so they stand before it; a grade is positive where the track falls: correct "
            "grade_permille",
        )
