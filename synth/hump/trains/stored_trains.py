"""What `hump simulate` has left in a directory: the configuration that it ran with, and the outcomes of its trains."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Final

from synth.frame.input_error import InputError
from synth.hump.configuration.trial_file import INPUTS
from synth.hump.trains.outcome_file import TRAINS, from_npz, trains_of
from synth.hump.trains.outcomes import TrainOutcomes
from synth.hump.trains.resolved_trial import ResolvedTrial, load_trial

CONFIG: Final = f"{INPUTS}/config.toml"


@dataclass(frozen=True)
class StoredTrains:
    """Trains, their configuration, and the bytes of their file."""

    config: ResolvedTrial
    found: TrainOutcomes
    content: bytes


def stored_trains(directory: Path, said: str) -> StoredTrains:
    """The trains in `directory`, which messages call `said`; `InputError` for a file that is not there, or a
    configuration that does not fit, `DamagedTable` for trains that are damaged or of another trial."""
    for name in (CONFIG, TRAINS):
        if not (directory / name).is_file():
            raise InputError(f"{said}: there is no {name} in it; give what 'hump simulate' left")
    config = load_trial(directory / CONFIG)
    content = (directory / TRAINS).read_bytes()
    found = from_npz(content, str(directory / TRAINS), trains_of(config), config.settings.trains.number)
    return StoredTrains(config, found, content)
