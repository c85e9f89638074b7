"""The cars of a cut: how many of which types, what they weigh, and the origin of their numbers."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

from plant_models.cut import Car
from plant_models.library import CARS, CarEntry, Library, SourcedValue, load_car
from synth.frame.faults import InputError
from synth.frame.settings.numbers import sourced
from synth.retarder.configuration.plant_fault import in_file, require_held
from synth.retarder.configuration.plant_settings import CutSettings


@dataclass(frozen=True)
class EqualCars:
    """`count` cars of one type in a cut, next to each other; `mass_per_car_t`: of each, None where only all is known.

    `key`: where the configuration has them.
    """

    key: str
    entry: CarEntry
    count: int
    mass_per_car_t: float | None

    @property
    def cars(self) -> tuple[Car, ...]:
        """The cars, front to rear."""
        return (self.entry.car,) * self.count

    @property
    def limits_t(self) -> tuple[float, float]:
        """Lightest and heaviest together."""
        return self.count * self.entry.car.tare_t, self.count * self.entry.car.gross_t

    @property
    def words(self) -> str:
        """What messages call them."""
        return f"{self.count} × {self.entry.name}"


@dataclass(frozen=True)
class Consist:
    """What a cut is made of, front to rear, and its mass."""

    parts: tuple[EqualCars, ...]
    mass_t: float

    @property
    def cars(self) -> tuple[Car, ...]:
        """All cars, front to rear."""
        return tuple(car for part in self.parts for car in part.cars)

    @property
    def limits_t(self) -> tuple[float, float]:
        """Lightest and heaviest."""
        return sum(part.limits_t[0] for part in self.parts), sum(part.limits_t[1] for part in self.parts)

    @property
    def label(self) -> str:
        """What the class is called where the file does not say."""
        names = [f"{part.entry.name}x{part.count}" if part.count > 1 else part.entry.name for part in self.parts]
        return f"{'_'.join(names)}-{self.mass_t:g}t"


def resolve_consist(settings: CutSettings, key: str, library: Library, file: str) -> Consist:
    """The cars of one [[cut]] table; `InputError` for what they are not or cannot weigh."""
    parts = tuple(parts_of(settings, key, library, file))
    mixed = settings.consist is not None
    consist = Consist(parts, mass_of_parts(settings, parts, key, file) if mixed else shared_mass(settings, key, file))
    lightest, heaviest = consist.limits_t
    if not lightest <= consist.mass_t <= heaviest:
        raise InputError(
            f"{file}: {key}.mass_t is {consist.mass_t!r}; {' + '.join(part.words for part in parts)} weigh together "
            f"from {lightest:g} t (tare) to {heaviest:g} t (gross)"
        )
    return consist


def parts_of(settings: CutSettings, key: str, library: Library, file: str) -> Iterator[EqualCars]:
    """The equal cars of a cut, and of each group of a mixed one."""
    if settings.consist is None:
        if settings.car is None:
            raise InputError(f"{file}: {key}.car is missing; add it to {key}, or a consist of several types")
        yield EqualCars(key, car_entry(settings.car, f"{key}.car", library, file), settings.cars, None)
        return
    for name, given in (("car", settings.car is not None), ("cars", settings.cars != 1)):
        if given:
            raise InputError(
                f"{file}: {key}.{name} cannot stand beside {key}.consist, which names all cars; leave it out"
            )
    for place, group in enumerate(settings.consist):
        where = f"{key}.consist[{place}]"
        entry = car_entry(group.car, f"{where}.car", library, file)
        yield EqualCars(where, entry, group.cars, group.mass_per_car_t)


def car_entry(name: str, where: str, library: Library, file: str) -> CarEntry:
    """The car type `name`."""
    require_held(f"{file}: {where}", CARS, name, library)
    with in_file(file):
        return load_car(name, library)


def shared_mass(settings: CutSettings, key: str, file: str) -> float:
    """The mass of all cars together."""
    if settings.mass_t is None:
        raise InputError(f"{file}: {key}.mass_t is missing; add it to {key}")
    return settings.mass_t


def mass_of_parts(settings: CutSettings, parts: tuple[EqualCars, ...], key: str, file: str) -> float:
    """The mass of a mixed cut: stated for all together, or the sum of its cars."""
    stated = [part for part in parts if part.mass_per_car_t is not None]
    if settings.mass_t is not None and stated:
        raise InputError(
            f"{file}: {key}.mass_t is {settings.mass_t!r}, but {stated[0].key}.mass_per_car_t is given, too; keep one "
            "of the two: the mass of all together, or that of each car"
        )
    if not stated:
        return shared_mass(settings, key, file)
    mass = 0.0
    for part in parts:
        if part.mass_per_car_t is None:
            raise InputError(
                f"{file}: {part.key}.mass_per_car_t is missing; give it for all groups of the cut or for none"
            )
        low, high = part.entry.car.tare_t, part.entry.car.gross_t
        if not low <= part.mass_per_car_t <= high:
            raise InputError(
                f"{file}: {part.key}.mass_per_car_t is {part.mass_per_car_t!r}; a car {part.entry.name} weighs from "
                f"{low:g} t (tare) to {high:g} t (gross)"
            )
        mass += part.count * part.mass_per_car_t
    return round(mass, 9)


def consist_values(consist: Consist, key: str, source: str) -> Iterator[SourcedValue]:
    """The numbers of the cars with their origin; `source`: that of masses and counts."""
    yield SourcedValue(f"{key}.mass_t", consist.mass_t, "t", consist.limits_t, source, "")
    for part in consist.parts:
        yield replace(sourced(f"{part.key}.cars", part.count, CutSettings.model_fields["cars"]), source=source)
        if part.mass_per_car_t is not None:
            limits = (part.entry.car.tare_t, part.entry.car.gross_t)
            yield SourcedValue(f"{part.key}.mass_per_car_t", part.mass_per_car_t, "t", limits, source, "")
        for value in part.entry.drawing:
            yield replace(value, key=f"{part.key}.car.{value.key}")
