"""An aim configuration with every default filled in: the scene, what is required, and the origin of each number."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from plant_models.errors import require
from plant_models.library import (
    CAR_MIXES,
    POSITIONS,
    TRACKS,
    WEIGHT_CATEGORIES,
    SourcedValue,
    TrackEntry,
    WeightCategories,
    WeightCategory,
    load_track,
    load_weight_categories,
)
from plant_models.library.car_entry import CarMixEntry, load_car_mix
from plant_models.library.data_file import keyed
from plant_models.rolling.random_cuts import CutPopulation
from plant_models.rolling.resistance_law import HumpNormLaw, ResistanceLaw, Tb10062Law
from plant_models.rolling.roll_track import Weather
from synth.aim.configuration.aim_file import AimFile, aim_numbers, members_of, track_with_settings
from synth.aim.configuration.settings import (
    AimAcceptanceSettings,
    AimedSettings,
    AimFileSettings,
)
from synth.aim.configuration.simulation_settings import SimulationSettings
from synth.aim.scene import AimScene, MeasuredStretch
from synth.frame.faults import InputError
from synth.frame.settings.numbers import range_warnings
from synth.frame.settings.section import OutputSettings
from synth.retarder.configuration.config_file import load_config
from synth.retarder.configuration.plant_fault import in_file, require_held
from synth.retarder.forms.tables_at import book_in
from tuning_tables.json_text import canonical_json

BOUNDS_M_S: Final = (0.5, 7.0)
"""Exit speeds that a park position may be told."""

KEY_OF_PLANT_MESSAGE: Final = {
    "track profile: grades_permille": "track.elements: grade_permille",
    "track profile: starts_m": "track.elements: from_m",
    "track: ": "track: ",
    "bend: ": "track.bends: ",
    "position: ": "position.",
    "measured stretch: ": "stretch.",
    "weather: ": "weather.",
    "resistance: ": "resistance.",
    "car mix: ": "cuts.",
    "car mix: no car": "cuts.mix: no car",
    "track: end_m": "track.elements: to_m of the last one",
    "coupling_speed_m_s": "aim.coupling_speed_m_s",
}
"""How the plant's messages begin, and the key path in an aim configuration that this means."""


@dataclass(frozen=True)
class ResolvedAim:
    """Everything that aim tables depend on.

    `position_name`: the park position that is commanded; `members`: the categories that tables are made for;
    `exit_std_m_s`: error of the position, None where `book` says it: the path of its controller tables, and that of the
    configuration that they were tuned with (None: the built-in one).
    `parameters`: every number with unit, range, source and whether it is assumed; `warnings`: sentences about values
    outside their sensible range; `place`: what messages call the file.
    """

    place: str
    title: str
    scene: AimScene
    position_name: str
    categories: WeightCategories
    members: tuple[WeightCategory, ...]
    cars: tuple[int, ...]
    aim: AimedSettings
    exit_std_m_s: float | None
    book: tuple[Path, Path | None] | None
    simulation: SimulationSettings
    acceptance: AimAcceptanceSettings
    output: OutputSettings
    parameters: tuple[SourcedValue, ...]
    notes: tuple[str, ...]
    warnings: tuple[str, ...]
    names: dict[str, Any]

    def __repr__(self) -> str:
        return f"ResolvedAim({self.title}: {len(self.members)} categories)"

    @property
    def canonical_json(self) -> str:
        """What the tables depend on, in one form: the same for the same tables, whatever files are called."""
        numbers = {value.key: value.value for value in self.parameters}
        tree = {**self.names, "numbers": numbers}
        if self.book is not None:
            book, config = self.book
            tree["tables_sha256"] = hashlib.sha256(book.read_bytes()).hexdigest()
            tree["tables_config_sha256"] = load_config(config).sha256
        return canonical_json(tree).decode("utf-8")

    @property
    def sha256(self) -> str:
        """SHA-256 of `canonical_json` in UTF-8, hexadecimal."""
        return hashlib.sha256(self.canonical_json.encode()).hexdigest()


def resolve_aim(file: AimFile, of_hump: TrackEntry | None = None) -> ResolvedAim:
    """Fill in the library's values; `InputError` names file, key and value of whatever does not fit.

    `of_hump`: the track of a hump file, in place of one of the library.
    """
    settings, place = file.settings, file.place
    require_held(f"{place}: track.name", TRACKS, settings.track.name, file.library)
    require_held(f"{place}: cuts.mix", CAR_MIXES, settings.cuts.mix, file.library)
    require_held(f"{place}: weight_categories", WEIGHT_CATEGORIES, settings.weight_categories, file.library)
    with in_file(place, lambda sentence: keyed(sentence, KEY_OF_PLANT_MESSAGE)):
        track = track_with_settings(of_hump or load_track(settings.track.name, file.library), settings)
        mix = settings.cuts.applied_to(load_car_mix(settings.cuts.mix, file.library))
        categories = load_weight_categories(settings.weight_categories, file.library)
        position = settings.position.name or track.position
        require_held(f"{place}: position.name", POSITIONS, position, file.library)
        scene = scene_of(track, mix, categories, settings)
        members = members_of(categories, settings)
        for member in members:
            mix.mix.of(categories, member)
        settings = settings.model_copy(update={"aim": with_fitting_distances(settings, scene)})
        book = book_of(file)
    parameters = tuple(aim_numbers(settings, track, mix, members))
    return ResolvedAim(
        place=place,
        title=settings.title or f"Aim tables of {position}, {track.title}",
        scene=scene,
        position_name=position,
        categories=categories,
        members=members,
        cars=settings.cuts.cars,
        aim=settings.aim,
        exit_std_m_s=settings.aim.exit_std_m_s if book is None else None,
        book=book,
        simulation=settings.simulation,
        acceptance=settings.acceptance,
        output=settings.output,
        parameters=parameters,
        notes=(*track.notes, *mix.notes),
        warnings=tuple(range_warnings(parameters)),
        names={
            "track": track.name,
            "position": position,
            "mix": [car.car.name for car in mix.mix.cars],
            "categories": [[member.number, member.name] for member in members],
            "law": settings.resistance.law,
            "knowledge": list(settings.aim.knowledge),
        },
    )


def scene_of(track: TrackEntry, mix: CarMixEntry, categories: WeightCategories, settings: AimFileSettings) -> AimScene:
    """The scene that track, mix and settings make; `PlantError` if they make none."""
    law: ResistanceLaw = Tb10062Law()
    if settings.resistance.law == "hump-norm":
        law = HumpNormLaw(settings.resistance.erlang_order)
    population = CutPopulation(mix.mix, categories, law, Weather(**settings.weather.model_dump()), track.track.bends)
    stretch = MeasuredStretch(*track.stretch_m, track.bunch_speed_mean_m_s, track.bunch_speed_std_m_s)
    zone, coupling, threads = (
        (track.entrance_m, track.exit_m),
        settings.aim.coupling_speed_m_s,
        settings.simulation.threads,
    )
    return AimScene(population, track.track, *zone, stretch, coupling, threads)


def with_fitting_distances(settings: AimFileSettings, scene: AimScene) -> AimedSettings:
    """What is asked, with the free distances that end before the track does; `PlantError` where the file gives others,
    or none is left."""
    distances = settings.aim.free_distances_m
    most, track = max(settings.cuts.cars), scene.track
    longest = max(car.car.length_m for car in scene.population.mix.cars)
    room = track.end_m - scene.exit_m - most * longest
    fitting = tuple(distance for distance in distances if distance <= room)
    if fitting and "free_distances_m" not in settings.aim.model_fields_set:
        return settings.aim.model_copy(update={"free_distances_m": fitting})
    require(
        distances[-1] <= room,
        f"aim.free_distances_m[{len(distances) - 1}] is {distances[-1]:g}; between a cut of {most} cars that has just "
        f"left the position at {scene.exit_m:g} m and the end of the track at {track.end_m:g} m are "
        f"{max(room, 0.0):.0f} m: shorten the distances or the cuts (cuts.cars)",
    )
    return settings.aim


def book_of(file: AimFile) -> tuple[Path, Path | None] | None:
    """Paths of the book of controller tables and of its configuration, from the folder of this one on."""
    named, config = file.settings.aim.tables, file.settings.aim.tables_config
    if named is None:
        return None
    folder = Path(file.place).parent
    path = book_in(folder / named)
    if not path.is_file():
        raise InputError(
            f"{file.place}: aim.tables names the book {str(path)!r}, which does not exist; 'retarder-synth tune' makes "
            "one"
        )
    return path, None if config is None else folder / config
