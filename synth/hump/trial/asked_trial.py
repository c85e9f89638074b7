"""What a command that humps trains is asked: the configuration with what was typed, and what it was read from; what its
figures do not say. All inputs go into one folder, so that what ran can be told and repeated when the files are gone:

inputs/config.toml               the configuration, with what the command line said
inputs/hump.toml or hump.railml  the hump
inputs/train.csv or train.xlsx   the sorting list, if there was one
inputs/tables/position-N.h5      the book of a position, position-N.toml what it was tuned with
inputs/aim/N/                    aim tables of the last position, for each group of routes
inputs/types/                    the user's own types
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from plant_models.library import Library, TypeFile
from synth.frame.command import Head
from synth.frame.results_directory import ResultsDirectory
from synth.frame.settings.template import toml_text
from synth.frame.settings.toml_file import read_text, toml_tree
from synth.hump.configuration.sections import HumpPositionSettings
from synth.hump.configuration.trial_file import INPUTS, TrialFile
from synth.hump.hump_file import RAILML_SUFFIXES, TABLE_SUFFIXES, hump_text
from synth.hump.hump_forms import tree_toml
from synth.hump.options import TrialOptions
from synth.hump.trial.position_choice import PositionChoice
from synth.hump.trial.resolved_trial import ResolvedTrial, resolve_trial
from synth.retarder.configuration.own_types import with_own_types
from synth.retarder.forms.tables_at import file_stem

MODEL_ONLY: Final = (
    "All figures are those of a model with the parameters listed here, not of a hump. Assumed parameters are guesses."
)
CHANCE_ONLY: Final = "Intervals cover the chance of these trains only, neither the parameters nor the model."
NO_SAFETY: Final = "The tool claims no safety integrity: no figure here proves that a hump is safe."


CONFIG, LIST, TABLES, AIMS, TYPES = "config.toml", "train", "tables", "aim", "types"


def files_read(file: TrialFile, config: ResolvedTrial) -> Iterator[Path]:
    """Every file that `config`, which was resolved from `file`, was read from."""
    yield Path(file.place)
    yield file.hump_source
    yield from (Path(each.place) for each in file.library.own)
    if file.settings.trains.list is not None:
        yield file.folder / file.settings.trains.list
    for choice in config.positions:
        yield from filter(None, (choice.book, choice.tuned_with))
    for aim in config.aims:
        yield from aim.files


def write_inputs(file: TrialFile, config: ResolvedTrial, directory: ResultsDirectory) -> None:
    """Write the inputs of `config`, which was resolved from `file`, into the folder of `directory`."""
    tree: dict[str, Any] = file.settings.model_dump(mode="json", exclude_none=True, exclude_unset=True)
    own: dict[str, TypeFile] = {str(each): each for each in file.library.own}
    contents: dict[str, bytes] = {}
    source = file.hump_source
    tree["hump"] = f"hump{source.suffix if source.suffix in RAILML_SUFFIXES else '.toml'}"
    is_table = source.suffix in TABLE_SUFFIXES
    contents[tree["hump"]] = (tree_toml(file.hump) if is_table else hump_text(source)).encode("utf-8")
    if file.settings.trains.list is not None:
        listed = file.folder / file.settings.trains.list
        name = f"{LIST}{listed.suffix}"
        tree.setdefault("trains", {})["list"] = name
        contents[name] = listed.read_bytes()
    said = {each.number: each for each in file.settings.position}
    told = (position_tree(choice, said.get(choice.number), contents, own) for choice in config.positions)
    tree["position"] = [each for each in told if len(each) > 1]
    if config.aims:
        kept = {key: value for key, value in tree.get("aim", {}).items() if key not in ("tables", "tables_of")}
        tree["aim"] = kept | aim_tree(config, contents)
    if own:
        tree["library"] = [f"{TYPES}/"]
    for type_file in own.values():
        contents[f"{TYPES}/{type_file.kind.folder}/{type_file.name}.toml"] = type_file.text.encode("utf-8")
    contents[CONFIG] = toml_text(tree).encode("utf-8")
    directory.write_all({f"{INPUTS}/{name}": content for name, content in contents.items()})


def position_tree(
    choice: PositionChoice, said: HumpPositionSettings | None, contents: dict[str, bytes], own: dict[str, TypeFile]
) -> dict[str, Any]:
    """A position as [[position]] tells it, where the user has `said` something; its files are added to `contents`, the
    types that they name to `own`."""
    found: dict[str, Any] = {"number": choice.number}
    if said is not None:
        found |= said.model_dump(mode="json", exclude_none=True, exclude_unset=True)
    if choice.book is not None:
        found["tables"] = f"{TABLES}/position-{choice.number}{choice.book.suffix}"
        contents[found["tables"]] = choice.book.read_bytes()
    if choice.tuned_with is not None:
        found["tables_config"] = f"{TABLES}/position-{choice.number}.toml"
        tree, library = with_own_types(
            toml_tree(read_text(choice.tuned_with), str(choice.tuned_with)), str(choice.tuned_with)
        )
        own |= {str(each): each for each in library.own}
        contents[found["tables_config"]] = toml_text(relocated(tree, library)).encode("utf-8")
    return found


def aim_tree(config: ResolvedTrial, contents: dict[str, bytes]) -> dict[str, Any]:
    """The aim tables as [aim] tells them; they are added to `contents`."""
    folders: dict[str, str] = {}
    for number, choice in enumerate(config.aims, start=1):
        for place, (file, table) in enumerate(zip(choice.files, choice.tables.tables, strict=True), start=1):
            contents[f"{AIMS}/{number}/{place}-{file_stem(table)}.json"] = file.read_bytes()
        folders |= {str(retarder): f"{AIMS}/{number}" for retarder in choice.retarders}
    of_all = len(config.aims) == 1 and not config.designed_rows
    return {"tables": f"{AIMS}/1"} if of_all else {"tables_of": folders}


def relocated(tree: dict[str, Any], library: Library) -> dict[str, Any]:
    """The configuration in `tree` as it stands in the folder of tables."""
    return {**tree, "library": [f"../{TYPES}/"]} if library.own else tree


@dataclass(frozen=True)
class AskedTrial:
    """`config` was resolved from `file`."""

    file: TrialFile
    config: ResolvedTrial

    def head(self, title: str, canonical_json: str) -> Head:
        """What is said of it under a `title`; `canonical_json`: what the figures depend on."""
        return Head(
            title=title,
            canonical_json=canonical_json,
            parameters=self.config.parameters,
            output=self.config.settings.output,
            warnings=self.config.warnings,
            reads=tuple(files_read(self.file, self.config)),
        )


def asked_trial(file: TrialFile, options: TrialOptions, trains: int | None = None) -> AskedTrial:
    """The trial of `file` with what was typed; `trains`: how many, None as configured. `InputError`."""
    with_typed = file.with_trains(trains, options.seed, options.sorting_list)
    return AskedTrial(with_typed, resolve_trial(with_typed))
