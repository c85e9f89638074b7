"""Options of the command `aim`."""

from __future__ import annotations

from synth.aim.configuration.simulation_settings import SimulationSettings
from synth.frame.settings.options import Options, configured


class AimOptions(Options):
    """Options of the command line."""

    passes: int | None = configured(
        "--passes", "N", SimulationSettings, "passes", "Cuts of each number of cars that speeds are chosen on"
    )
    seed: int | None = configured("--seed", "N", SimulationSettings, "seed", "Of the random numbers")
