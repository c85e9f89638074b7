"""Which weight categories a file asks tables for."""

from __future__ import annotations

from plant_models import PlantError
from plant_models.errors import require
from plant_models.library import WeightCategories, WeightCategory
from synth.aim.configuration.settings import AimFileSettings


def members_of(categories: WeightCategories, settings: AimFileSettings) -> tuple[WeightCategory, ...]:
    """The categories that are asked for, all if none is; `PlantError` for unknown ones, and for one named twice."""
    if settings.cuts.categories is None:
        return categories.members
    members: list[WeightCategory] = []
    for place, name in enumerate(settings.cuts.categories):
        try:
            member = categories.named(name)
        except PlantError as fault:
            raise PlantError(f"cuts.categories[{place}]: {fault}") from None
        require(member not in members, f"cuts.categories[{place}] is {name!r}, which is there before; leave it out")
        members.append(member)
    return tuple(members)
