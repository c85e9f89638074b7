"""What is typed behind every command that humps trains, and behind `hump simulate` and `hump speed`."""

from __future__ import annotations

from pathlib import Path

from synth.frame.settings.options import BY_PLACE, Options, configured, number_option, word_option
from synth.frame.workers.engine_options import EngineOptions
from synth.hump.configuration.counted_trains import CountedTrains


class TrialOptions(Options):
    """Which trains over which hump."""

    config: Path | None = word_option(
        BY_PLACE, "CONFIG.toml|HUMP", None, "A hump trial, or a hump for the built-in trial."
    )
    sorting_list: Path | None = word_option("--list", "CSV", None, "A sorting list, that of every train.")
    seed: int | None = configured("--seed", "N", CountedTrains, "seed", "Of the random numbers")


class SimulateOptions(TrialOptions, EngineOptions):
    """How many trains, and where they are humped."""

    trains: int | None = configured("--trains", "N", CountedTrains, "number", "Trains")


class SpeedOptions(TrialOptions):
    """One of these trains."""

    train: int = number_option("--train", "K", 1, 1, 10_000_000, "Which train of the trial.")
