"""What an aim shares with a hump trial: the highest coupling speed, and the mix of cars that cuts are drawn from."""

from __future__ import annotations

from typing import Final

from plant_models.library import CAR_MIXES
from plant_models.library.car_entry import CarMixEntry, load_car_mix
from synth.frame.settings.numbers import Usual, library_values, told_numbers
from synth.frame.settings.section import Section, of_library
from synth.retarder.configuration.own_types import named_type

COUPLING_SPEED_M_S: Final = 5.0 / 3.6
"""5 km/h, the highest speed at which cars may couple ([braking-position])."""


DEFAULT_MIX = "usual"


class MixSettings(Section):
    """The mix of cars."""

    mix: str = named_type(DEFAULT_MIX, CAR_MIXES, "the mix of cars")
    following_share: float | None = of_library("part of its air resistance that a car has behind another one")
    underload_mean_t: float | None = of_library("mean of what cars of the heaviest category lack to their gross mass")

    def applied_to(self, entry: CarMixEntry) -> CarMixEntry:
        """The mix with the values that the file sets; `PlantError` if they make no mix."""
        return entry.with_values(dict(library_values(self)))


def usual_mix(section: str) -> Usual:
    """What the built-in mix has for the keys of `section`."""
    return {f"{section}.{key}": told for key, told in told_numbers(load_car_mix(DEFAULT_MIX).provenance).items()}
