"""Options of the command `hump simulate`."""

from __future__ import annotations

from synth.frame.settings.options import configured
from synth.frame.workers.engine_options import EngineOptions
from synth.hump.configuration.counted_trains import CountedTrains
from synth.hump.trains.trial_options import TrialOptions


class SimulateOptions(TrialOptions, EngineOptions):
    """How many trains, and where they are humped."""

    trains: int | None = configured("--trains", "N", CountedTrains, "number", "Trains")
