"""What is typed behind every command that solves cut classes side by side."""

from __future__ import annotations

from synth.frame.processors import available
from synth.frame.settings.options import Options, number_option


class SolvingOptions(Options):
    """Options of the command line."""

    workers: int | None = number_option(
        "--workers", "N", None, 1, 256, "Cut classes solved at once; by default one a processor."
    )

    def workers_for(self, classes: int) -> int:
        """How many of so many classes are solved at once."""
        return self.workers or min(classes, available())
