"""What of the trains of a trial is beyond the cars that its hump is for, or has no effect in it."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence

from plant_models.library.hump_cars import ForCars
from plant_models.library.weight_category import WeightCategories, WeightCategory
from synth.hump.configuration.settings import HumpTrialSettings
from synth.hump.control.cut_record import CutRecord
from synth.hump.trains.position_roles import Roles


def car_warnings(asked: ForCars | None, kinds: Mapping[WeightCategory, Collection[int]]) -> Iterator[str]:
    """A sentence where trains have other cars than the hump is for; `kinds`: numbers of cars of the cuts of each weight
    category that trains can have."""
    if asked is None:
        return
    if asked.categories is not None:
        named = set(asked.categories)
        others = [each.label for each in kinds if not named & {each.name, each.latin}]
        if others:
            yield (
                f"the hump is for cars of the weight category {', '.join(asked.categories)}, and trains have "
                f"{', '.join(others)}, too: its brakes may be too weak for them; set trains.category_shares, "
                f"{{ {asked.categories[0]} = 1 }}"
            )
    longest = max(max(cars) for cars in kinds.values())
    if asked.most_cars is not None and longest > asked.most_cars:
        yield (
            f"the hump is for cuts of at most {asked.most_cars} car{'s' * (asked.most_cars > 1)}, and trains can have "
            f"cuts of {longest}: set trains.most_cars, and trains.cars_mean with it"
        )


def list_warnings(cuts: Sequence[CutRecord], categories: WeightCategories) -> Iterator[str]:
    """A sentence where cuts of a sorting list are of another weight category than their mass tells."""
    numbers = {each.number: each for each in categories.members}
    other = [(cut, categories.of(cut.mass_t, cut.axles)) for cut in cuts]
    other = [(cut, by_mass) for cut, by_mass in other if by_mass.number != cut.category]
    if other:
        cut, by_mass = other[0]
        more = f" (and {len(other) - 1} more)" if len(other) > 1 else ""
        yield (
            f"cut {cut.serial} of the sorting list{more} has {cut.mass_t:g} t on {cut.axles} axles, which is the "
            f"weight category {by_mass.label}, and the list says {numbers[cut.category].label}: it rolls and brakes as "
            "the list says; leave the column category out to have that of the mass"
        )


def skates_warnings(settings: HumpTrialSettings, roles: Roles) -> Iterator[str]:
    """A sentence where skates are asked for and no track has some."""
    share = settings.tracks.skates_share
    if share > 0.0 and roles.aims.any(axis=0).all():
        yield (
            f"tracks.skates_share is {share:g}, but a position aims at the standing cars of every track, and skates "
            "lie where none does: take it out, or give the last position another role"
        )


def weather_warnings(settings: HumpTrialSettings) -> Iterator[str]:
    """A sentence where a temperature is asked for that changes nothing that matters."""
    weather = settings.weather
    if "temperature_c" in weather.model_fields_set and settings.resistance.law == "hump-norm":
        yield (
            f"weather.temperature_c is {weather.temperature_c:g}; under resistance.law hump-norm it changes "
            "the density of the air alone, not the resistance of bearings: take tb-10062 for cold cars, and "
            "weather.snow_n_per_kn for snow"
        )
