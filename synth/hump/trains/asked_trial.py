"""What a command that humps trains is asked: the configuration with what was typed, and what it was read from."""

from __future__ import annotations

from dataclasses import dataclass

from synth.frame.command import Head
from synth.hump.configuration.trial_file import TrialFile
from synth.hump.trains.resolved_trial import ResolvedTrial, resolve_trial
from synth.hump.trains.trial_inputs import files_read
from synth.hump.trains.trial_options import TrialOptions


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
