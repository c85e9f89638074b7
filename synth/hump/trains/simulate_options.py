"""Options of the command `hump simulate`."""

from __future__ import annotations

from synth.frame.settings.options import configured, number_option, word_option
from synth.hump.configuration.counted_trains import CountedTrains
from synth.hump.trains.trial_options import TrialOptions


class SimulateOptions(TrialOptions):
    """How many trains, and where they are humped."""

    trains: int | None = configured("--trains", "N", CountedTrains, "number", "Trains")
    workers: int | None = number_option("--workers", "N", None, 1, 1024, "Processes on this machine.")
    scheduler: str | None = word_option(
        "--scheduler", "ADDRESS", None, "Compute on the workers of this Dask scheduler instead."
    )
