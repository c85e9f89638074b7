"""Reading an aim configuration: TOML → `AimFileSettings` and the library that has the user's own types."""

from __future__ import annotations

from dataclasses import dataclass, replace

from plant_models.library import Library
from synth.aim.configuration.settings import AimFileSettings
from synth.frame.settings.settings_file import settings_in
from synth.frame.settings.toml_file import toml_tree
from synth.retarder.configuration.own_types import with_own_types


@dataclass(frozen=True)
class AimFile:
    """What a file says: `settings`, the `library` with the user's own types; `place`: what messages call the file."""

    settings: AimFileSettings
    library: Library
    place: str

    def with_simulation(self, passes: int | None, seed: int | None) -> AimFile:
        """The same with other passes or another seed, as given on a command line; None keeps the file's."""
        given = {key: value for key, value in (("passes", passes), ("seed", seed)) if value is not None}
        simulation = self.settings.simulation.model_copy(update=given)
        return replace(self, settings=self.settings.model_copy(update={"simulation": simulation}))


def parse_aim_file(text: str, place: str) -> AimFile:
    """The file with this `text`; paths in it begin at the folder of `place`."""
    tree, library = with_own_types(toml_tree(text, place), place)
    return AimFile(settings_in(AimFileSettings, tree, place), library, place)
