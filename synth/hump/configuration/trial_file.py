"""A hump trial as a file: a commented one to start from, and reading it, TOML → `TrialFile`, with the hump and the
user's own types. A hump by itself, by path or name, stands for the default trial on it.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

from plant_models.library import Library
from plant_models.library.hump_entry import HumpEntry, hump_names, load_hump
from synth.aim.configuration.shared_settings import usual_mix
from synth.frame.faults import InputError
from synth.frame.settings.numbers import Usual
from synth.frame.settings.settings_file import BUILT_IN, settings_in
from synth.frame.settings.template import template, toml_text
from synth.frame.settings.toml_file import read_text, toml_tree
from synth.hump.configuration.settings import DEFAULT_HUMP, HumpTrialSettings
from synth.hump.hump_file import OTHER_SUFFIXES, FileKind, kind_of, read_graph, require_kind
from synth.retarder.configuration.own_types import with_own_types


def default_trial_toml() -> str:
    """The defaults as TOML; it reads back to the same hump trial."""
    notes = load_hump(DEFAULT_HUMP).notes
    return template(HumpTrialSettings(), "Hump trial", "hump simulate", usual_trial(), notes)


def usual_trial() -> Usual:
    """What the built-in mix has for keys that are left out."""
    return usual_mix("cars")


INPUTS = "inputs"
"""Folder of copies of all that a trial was read from, in the directory of its results."""


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
    return parse_trial_file("", BUILT_IN) if source is None else parse_trial_file(trial_text(source), str(source))


def trial_text(source: Path, template: str = "init trial") -> str:
    """The text of the configuration `source`; a hump has that of the default trial on it. `InputError`.

    `template`: the command that prints such a file.
    """
    if str(source) in hump_names() and not source.is_file():
        return toml_text({"hump": str(source)})
    if source.suffix in OTHER_SUFFIXES or not (source.suffix or source.exists()):
        return text_on(source)
    text = read_text(source, template)
    tree = toml_tree(text, str(source))
    if kind_of(tree) is FileKind.HUMP:
        return text_on(source)
    require_kind(tree, str(source), FileKind.TRIAL)
    return text


def text_on(hump: Path) -> str:
    """The default trial on the hump in this file, whose path begins at the folder of the file; no name of the library
    begins so."""
    return toml_text({"hump": f"./{hump.name}"})


def parse_trial_file(text: str, place: str) -> TrialFile:
    """The file with this `text`; paths in it begin at the folder of `place`."""
    tree, library = with_own_types(toml_tree(text, place), place)
    settings = settings_in(HumpTrialSettings, tree, place)
    folder = Path(place).parent
    source = hump_source(settings.hump, folder)
    try:
        hump = read_graph(source).entry
    except InputError as fault:
        said = "" if str(source) == place else f"{place}: hump: "  # a hump by itself has faults of its own
        raise InputError(*(f"{said}{sentence}" for sentence in fault.sentences)) from None
    return TrialFile(settings, library, hump, place, folder, source)


def hump_source(named: str, folder: Path) -> Path:
    """The name of a hump of the library as it is, a path from `folder` on."""
    return Path(named) if named in hump_names() and not Path(named).suffix else folder / named
