"""Options of the command `aim`."""

from __future__ import annotations

from pathlib import Path

from synth.aim.configuration.simulation_settings import SimulationSettings
from synth.frame.settings.options import Options, configured, number_option, word_option


class AimOptions(Options):
    """Cuts and random numbers, and the track where a hump file has it."""

    hump: Path | None = word_option("--hump", "FILE|HUMP", None, "A hump, of which --track is aimed at.")
    track: int | None = number_option("--track", "N", None, 1, 199, "Which track of the hump, by its number.")
    passes: int | None = configured(
        "--passes", "N", SimulationSettings, "passes", "Cuts of each number of cars that speeds are chosen on"
    )
    seed: int | None = configured("--seed", "N", SimulationSettings, "seed", "Of the random numbers")
