"""Options of the command `tune`."""

from __future__ import annotations

from typing import Final

from synth.frame.processors import available
from synth.frame.settings.options import Options, flag_option, number_option

TUNE: Final = "tune"
"""Name of the command, with a radar and with point sensors."""


class TuneOptions(Options):
    """Options of the command line."""

    workers: int | None = number_option(
        "--workers", "N", None, 1, 256, "Cut classes solved at once; by default one a processor."
    )

    pareto: bool = flag_option("--pareto", "Also tell what less time in the position costs; takes long.")

    def workers_for(self, classes: int) -> int:
        """How many of so many classes are solved at once."""
        return self.workers or min(classes, available())
