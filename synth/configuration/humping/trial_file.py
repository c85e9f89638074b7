"""Reading a hump trial configuration: TOML → `TrialFile`, with the hump and the user's own types.

A hump by itself, by path or name, stands for the default trial on it.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

from pydantic import ValidationError

from plant_models.library import BUILT_IN, Library
from plant_models.library.hump_entry import HumpEntry, hump_names
from synth.configuration.hump import RAILML_SUFFIXES, read_graph
from synth.configuration.humping.settings import HumpTrialSettings
from synth.configuration.own_types import with_own_types
from synth.frame.input_error import InputError
from synth.frame.settings.file_fault import faults_in
from synth.frame.settings.toml_file import Tree, read_text, toml_tree

BUILT_IN_TRIAL = "built-in hump trial"
HUMP_FORMAT = "hump"


@dataclass(frozen=True)
class TrialFile:
    """What a file says: `settings`, the `library` with the user's own types, the `hump`; `place`: what messages call
    the file. Paths in `settings` begin at `folder`; `hump_source`: path or name of the hump.
    """

    settings: HumpTrialSettings
    library: Library
    hump: HumpEntry
    place: str
    folder: Path
    hump_source: Path

    def with_trains(self, number: int | None, seed: int | None, sorting_list: Path | None) -> TrialFile:
        """The same with what is given on a command line; None keeps what the file says."""
        given = {"number": number, "seed": seed, "list": None if sorting_list is None else str(sorting_list.absolute())}
        update = {key: value for key, value in given.items() if value is not None}
        trains = self.settings.trains.model_copy(update=update)
        return replace(self, settings=self.settings.model_copy(update={"trains": trains}))


def read_trial_file(source: Path | None) -> TrialFile:
    """The configuration or hump `source`, or the built-in default; `InputError` on any fault of form."""
    if source is None:
        return of_tree({}, BUILT_IN_TRIAL, Path())
    name = str(source)
    if source.suffix in RAILML_SUFFIXES or not (source.suffix or source.exists()):
        return of_hump(source)
    text = read_text(source, "init --hump")
    tree = toml_tree(text, name)
    if tree.get("format") == HUMP_FORMAT:
        return of_hump(source)
    return of_tree(tree, name, source.parent)


def parse_trial_file(text: str, place: str) -> TrialFile:
    """The file with this `text`; paths in it begin at the folder of `place`."""
    return of_tree(toml_tree(text, place), place, Path(place).parent)


def of_hump(source: Path) -> TrialFile:
    """The default trial on the hump `source`."""
    return TrialFile(
        HumpTrialSettings(hump=str(source)), BUILT_IN, read_graph(source).entry, str(source), Path(), source
    )


def of_tree(tree: Tree, place: str, folder: Path) -> TrialFile:
    """The trial that `tree` asks for."""
    named, library = with_own_types(tree, place)
    try:
        settings = HumpTrialSettings.model_validate(named)
    except ValidationError as error:
        raise InputError(*(f"{place}: {sentence}" for sentence in faults_in(error, HumpTrialSettings))) from None
    source = hump_source(settings.hump, folder)
    try:
        hump = read_graph(source).entry
    except InputError as fault:
        raise InputError(*(f"{place}: hump: {sentence}" for sentence in fault.sentences)) from None
    return TrialFile(settings, library, hump, place, folder, source)


def hump_source(named: str, folder: Path) -> Path:
    """The name of a hump of the library as it is, a path from `folder` on."""
    return Path(named) if named in hump_names() and not Path(named).suffix else folder / named
