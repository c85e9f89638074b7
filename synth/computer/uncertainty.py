"""How uncertain inputs are carried to the results: a section of the file, and options of the command line."""

from __future__ import annotations

from pydantic import model_validator

from synth.frame.settings.options import Options, configured
from synth.frame.settings.section import Section, setting


class UncertaintySettings(Section):
    """How uncertain inputs are carried to the results."""

    draws: int = setting(10_000, "1", 200, 1_000_000, "draws of all uncertain inputs")
    sobol_points: int = setting(256, "1", 16, 65_536, "base points of the Sobol indices, a power of 2")
    seed: int = setting(18, "1", 0, 2**53, "seed of all draws")

    @model_validator(mode="after")
    def _power_of_two(self) -> UncertaintySettings:
        points = self.sobol_points
        if points & (points - 1):
            raise ValueError(f"sobol_points is {points}; it must be a power of 2")
        return self


class ComputerOptions(Options):
    """Options of the command line."""

    draws: int | None = configured("--draws", "N", UncertaintySettings, "draws", "Draws of the uncertain inputs")
    seed: int | None = configured("--seed", "N", UncertaintySettings, "seed", "Of the random numbers")
