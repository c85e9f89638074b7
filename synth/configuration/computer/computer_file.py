"""Reading the configuration of a control computer: TOML → `ComputerFile`, with its hump."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

from pydantic import ValidationError

from plant_models.library.hump_entry import HumpEntry
from synth.configuration.computer.settings import ComputerSettings
from synth.configuration.file_fault import faults_in
from synth.configuration.hump import read_graph
from synth.configuration.humping.trial_file import hump_source
from synth.configuration.toml_file import read_text, toml_tree
from synth.frame.input_error import InputError

BUILT_IN_COMPUTER = "built-in computer configuration"


@dataclass(frozen=True)
class ComputerFile:
    """What a file says, with its `hump`; `place`: what messages call the file; paths in it begin at `folder`."""

    settings: ComputerSettings
    hump: HumpEntry
    place: str
    folder: Path

    def with_uncertainty(self, draws: int | None, seed: int | None) -> ComputerFile:
        """The same with what is given on a command line; None keeps what the file says."""
        given = {key: value for key, value in (("draws", draws), ("seed", seed)) if value is not None}
        uncertainty = self.settings.uncertainty.model_copy(update=given)
        return replace(self, settings=self.settings.model_copy(update={"uncertainty": uncertainty}))


def read_computer_file(path: Path | None) -> ComputerFile:
    """The file at `path`, or the built-in default; `InputError` on any fault of form."""
    if path is None:
        return parse_computer_file("", BUILT_IN_COMPUTER)
    return parse_computer_file(read_text(path, "init --computer"), str(path))


def parse_computer_file(text: str, place: str) -> ComputerFile:
    """The file with this `text`; paths in it begin at the folder of `place`."""
    try:
        settings = ComputerSettings.model_validate(toml_tree(text, place))
    except ValidationError as error:
        raise InputError(*(f"{place}: {sentence}" for sentence in faults_in(error, ComputerSettings))) from None
    folder = Path(place).parent
    try:
        hump = read_graph(hump_source(settings.hump, folder)).entry
    except InputError as fault:
        raise InputError(*(f"{place}: hump: {sentence}" for sentence in fault.sentences)) from None
    return ComputerFile(settings, hump, place, folder)
